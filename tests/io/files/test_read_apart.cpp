/// Whatever becomes of the process that reads a file, the one that asked is told.

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <new>
#include <stdexcept>
#include <vector>

#include "io/files/file_error.hpp"
#include "io/files/read_apart.hpp"
#include "tests/io/results/result_scene.hpp"

namespace brio {
namespace {

std::string fault_apart(const std::function<std::string()>& work) {
  try {
    read_apart("a.vtkhdf", work);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReadApart, ReturnsWhatWasRead) {
  EXPECT_EQ(read_apart("a", [] { return std::string("text\0with zero", 14); }),
            std::string("text\0with zero", 14));
  EXPECT_EQ(read_apart("a", [] { return std::string(); }), "");
  const std::string large(10'000'000, 'x');
  EXPECT_EQ(read_apart("a", [&] { return large; }), large);
}

TEST(ReadApart, PassesFaultsOn) {
  EXPECT_EQ(fault_apart([]() -> std::string { throw FileError("other", "no space"); }), "other: no space");
  EXPECT_EQ(fault_apart([]() -> std::string { throw std::out_of_range("row"); }), "a.vtkhdf: is broken: row");
  EXPECT_EQ(fault_apart([]() -> std::string { throw std::bad_alloc(); }),
            "a.vtkhdf: is broken: it claims more data than memory can hold");
}

TEST(ReadApart, TellsOfACrash) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGKILL}) {
    const std::string fault = fault_apart([signal] {
      raise(signal);
      return std::string();
    });
    EXPECT_EQ(fault.find("a.vtkhdf: is broken: reading it "), 0u) << fault;
  }
}

TEST(ReadApart, OfANullPointerIsACrash) {
  const std::string fault = fault_apart([] {
    volatile int* volatile nothing = nullptr;
    return std::to_string(*nothing);
  });
  EXPECT_EQ(fault.find("a.vtkhdf: is broken: reading it "), 0u) << fault;
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(ReadApart, TakesNoMoreMemoryThanAFileCanNeed) {
  EXPECT_EQ(fault_apart([] { return std::string(std::size_t{4} << 30, 'x'); }),
            "a.vtkhdf: is broken: it claims more data than memory can hold");
}
#endif

TEST(ReadApartSlow, EndsALoop) {
  EXPECT_EQ(fault_apart([] {
              std::atomic<unsigned> turns{0};
              while (turns.load() < 2) turns = 1;
              return std::string();
            }),
            "a.vtkhdf: is broken: reading it comes to no end");
}

}  // namespace
}  // namespace brio
