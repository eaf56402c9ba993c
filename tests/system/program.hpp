#pragma once
/// The program as a script sees it.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
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

  // The last row of a history.
  std::map<std::string, double> last_row(const fs::path& history) const {
    std::istringstream text(read(history));
    std::string names, line, last;
    std::getline(text, names);
    while (std::getline(text, line)) last = line;
    std::istringstream columns(names), values(last);
    std::map<std::string, double> row;
    for (std::string name, value; std::getline(columns, name, ',') && std::getline(values, value, ',');)
      row[name] = std::stod(value);
    return row;
  }
  // Of momenta against what supports and walls have given.
  void expect_momentum_kept(const fs::path& history) const {
    const auto row = last_row(history);
    EXPECT_LT(row.at("linear_imbalance"), 1e-12);
    EXPECT_LT(row.at("angular_imbalance"), 1e-12);
  }

  fs::path folder_;
};

}  // namespace brio::test
