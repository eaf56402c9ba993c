#pragma once
/// The program as a script sees it.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace brio::test {

namespace fs = std::filesystem;

// A folder of its own for each test; its name has a space in it.
class Program : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("brio program " + std::to_string(getpid()) + " " +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  struct Ending {
    int exit_code;
    std::string output, faults;
  };
  // Runs `brio ARGUMENTS` in the folder.
  Ending brio(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + folder_.string() + "' && " + before + "'" BRIO_PROGRAM "' " +
                                arguments + " > output.txt 2> faults.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("output.txt"), read("faults.txt")};
  }
  std::string read(const fs::path& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  nlohmann::json summary(const std::string& name) const {
    return nlohmann::json::parse(read(fs::path(name + ".results") / (name + ".summary.json")));
  }

  fs::path folder_;
};

}  // namespace brio::test
