#include "tests/io/files/faults.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>

namespace brio::test {
namespace {

Fault planned = Fault::none;
int strikes_at = 0;
int operations = 0;
int syncs = 0;

/// The system looks for a signal that kills between the pages of a write.
constexpr off_t page = 4096;

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
  if (brio::test::planned != brio::test::Fault::kill)
    return syscall(SYS_pwrite64, descriptor, bytes, size, offset);
  const auto* const begin = static_cast<const char*>(bytes);
  size_t done = 0;
  while (true) {
    const off_t at = offset + static_cast<off_t>(done);
    const size_t left_of_page = static_cast<size_t>(brio::test::page - at % brio::test::page);
    const ssize_t written =
        syscall(SYS_pwrite64, descriptor, begin + done, std::min(size - done, left_of_page), at);
    if (written < 0) return written;
    done += static_cast<size_t>(written);
    if (done == size) return static_cast<ssize_t>(size);
    brio::test::struck();
  }
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
