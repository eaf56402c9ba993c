// Memory that there is.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "src/forecast/memory.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;

class System : public testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() / ("brio memory " + std::to_string(getpid()));
    fs::remove_all(root_);
    write("proc/meminfo", "MemTotal: 16777216 kB\nMemAvailable: 8388608 kB\nSwapFree: 1048576 kB\n");
  }
  void TearDown() override { fs::remove_all(root_); }
  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  fs::path root_;
};

TEST_F(System, LeavesWhatIsAvailableAndSwap) { EXPECT_EQ(available_memory_mb(root_), 8192 + 1024); }

TEST_F(System, ControlGroupsLimitWhatIsAvailable) {
  write("proc/self/cgroup", "0::/batch/job\n");
  write("sys/fs/cgroup/batch/job/memory.max", "max\n");
  EXPECT_EQ(available_memory_mb(root_), 9216);
  write("sys/fs/cgroup/batch/memory.max", "4294967296\n");  // of the group around it
  write("sys/fs/cgroup/batch/memory.current", "1073741824\n");
  EXPECT_EQ(available_memory_mb(root_), 3072);
  write("sys/fs/cgroup/batch/memory.stat", "anon 5\ninactive_file 536870912\n");
  EXPECT_EQ(available_memory_mb(root_), 3584);
  write("sys/fs/cgroup/batch/job/memory.max", "104857600\n");
  write("sys/fs/cgroup/batch/job/memory.current", "209715200\n");
  EXPECT_EQ(available_memory_mb(root_), 0);
}

TEST_F(System, ControlGroupsOfVersionOneLimitAsWell) {
  write("proc/self/cgroup", "12:cpu:/\n11:memory:/docker/1\n");
  write("sys/fs/cgroup/memory/docker/1/memory.limit_in_bytes", "2147483648\n");
  write("sys/fs/cgroup/memory/docker/1/memory.usage_in_bytes", "1073741824\n");
  EXPECT_EQ(available_memory_mb(root_), 1024);
}

TEST_F(System, ThatSaysNothingSetsNoLimit) {
  fs::remove_all(root_);
  EXPECT_EQ(available_memory_mb(root_), HUGE_VAL);
}

}  // namespace
}  // namespace brio
