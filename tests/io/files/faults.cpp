#include "tests/io/files/faults.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>

namespace brio::test {
namespace {

Fault planned = Fault::none;
int strikes_at = 0;
int operations = 0;
int syncs = 0;

/// \return whether a write must fail for want of space.
bool struck() {
  const bool now = operations++ >= strikes_at;
  if (now && planned == Fault::kill) raise(SIGKILL);
  return now && planned == Fault::no_space;
}

}  // namespace

void plan_fault(Fault fault, int at) {
  planned = fault;
  strikes_at = at;
  operations = 0;
  syncs = 0;
}

int operations_since_plan() { return operations; }
int syncs_since_plan() { return syncs; }

}  // namespace brio::test

extern "C" {

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t offset) {
  if (brio::test::struck()) {
    errno = ENOSPC;
    return -1;
  }
  return syscall(SYS_pwrite64, descriptor, bytes, size, offset);
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (brio::test::struck()) {
    errno = ENOSPC;
    return -1;
  }
  return syscall(SYS_write, descriptor, bytes, size);
}

int ftruncate(int descriptor, off_t length) noexcept {
  brio::test::struck();
  return static_cast<int>(syscall(SYS_ftruncate, descriptor, length));
}

int fsync(int descriptor) {
  ++brio::test::syncs;
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

int fdatasync(int descriptor) {
  ++brio::test::syncs;
  return static_cast<int>(syscall(SYS_fdatasync, descriptor));
}

int rename(const char* from, const char* to) noexcept {
  brio::test::struck();
  return static_cast<int>(syscall(SYS_rename, from, to));
}
}
