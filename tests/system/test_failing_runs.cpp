// What a run that breaks down says and leaves: the place, a likely cause, what to try, and results that end
// with the last state that was good.

#include <cmath>

#include "tests/system/program.hpp"

namespace brio {
namespace {

using namespace test;

class FailingRuns : public Program {
 protected:
  /// The deck of a cube of 4 x 4 x 4 elements and a floor, with what is put in.
  void write_deck(const std::string& velocity, const std::string& more,
                  const std::string& end = "0.02") const {
    write("cube.yaml",
          "title: A cube\nmaterials:\n"
          "  rubber: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0.3}\nparts:\n"
          "  cube: {mesh: {box: {size: [1, 1, 1], elements: [4, 4, 4]}}, element: hex8, material: rubber}\n"
          "initial_conditions: [{part: cube, velocity: " +
              velocity + "}]\ntime: {end: " + end + "}\n" + more);
  }

  /// Exit code 3 with a message that has all of these; summary and history hold numbers only.
  std::string expect_failure(const std::string& options, const std::vector<std::string>& says) const {
    const Ending ending = brio("run cube.yaml --quiet " + options);
    EXPECT_EQ(ending.exit_code, 3) << ending.faults;
    for (const std::string& word : says)
      EXPECT_NE(ending.faults.find(word), std::string::npos) << word << " is not in: " << ending.faults;
    const std::string history = read("cube.results/cube.history.csv");
    const std::string rows = history.substr(history.find('\n') + 1);
    EXPECT_EQ(rows.find("nan"), std::string::npos);
    EXPECT_EQ(rows.find("inf"), std::string::npos);
    const nlohmann::json end = summary("cube");
    EXPECT_EQ(end["status"], "failed");
    EXPECT_EQ(end["exit_code"], 3);
    EXPECT_EQ(end.dump().find("null"), std::string::npos) << end.dump();
    if (end["steps"] > 0) {
      EXPECT_LT(std::abs(end["energy"]["error_relative"].get<double>()), 0.1);
      EXPECT_GE(std::stod(rows.substr(rows.rfind('\n', rows.size() - 2) + 1)), end["time"].get<double>());
    }
    const Ending info = brio("info cube.results");
    const bool has_dump = fs::exists(folder_ / "cube.results/cube.xdmf2");
    EXPECT_EQ(info.exit_code, has_dump ? 0 : 4);
    if (has_dump) {
      const std::string why = ending.faults.substr(ending.faults.find("brio: "));
      EXPECT_NE(read("cube.results/cube.log").find(why), std::string::npos) << read("cube.results/cube.log");
    } else {
      EXPECT_NE(info.faults.find("the result holds no dump"), std::string::npos) << info.faults;
    }
    return ending.faults;
  }
};

// The upper half is driven through the lower.
const std::string press =
    "boundary_conditions: [{set: cube.bottom, fix: [x, y, z]}, {set: cube.top, velocity: {z: -400}}]\n";

TEST_F(FailingRuns, FromElementsThatAreCrushedNamePartElementTimeAndWhatToTry) {
  write_deck("[0, 0, 0]", press);
  expect_failure("", {" of part 'cube'", " at time ", "likely cause: ", "; try "});
  const double time = summary("cube")["time"];
  EXPECT_GT(time, 1e-4) << "the last good state is one on the way";
}

TEST_F(FailingRuns, FromAnEnergyErrorNamePartElementTimeAndWhatToTry) {
  write_deck("[0, 0, 0]", press + "numerics: {energy_error_limit: 1e-5}\n");
  expect_failure("", {"the energy error ", "exceeds numerics.energy_error_limit at time ", " of part 'cube'",
                      "likely cause: ", "; try time.step_scale: 0.45"});
}

TEST_F(FailingRuns, FromVelocitiesThatAreTooLarge) {
  write_deck("[0, 0, 1e200]", "");
  expect_failure("", {" of part 'cube'", "at time 0", "check units"});
}

TEST_F(FailingRuns, FromVelocitiesThatResultsCannotHold) {
  write_deck("[0, 0, 1e60]", "", "1e-60");
  expect_failure("", {"a value of 'velocity' at time 0 is too large for the results", "check units"});
}

// Contact is not asked what meets nodes that are everywhere.
TEST_F(FailingRuns, FromLoadsThatThrowNodesOutOfTheSceneBeforeTheFirstStep) {
  write_deck("[0, 0, -10]", "loads: [{gravity: [0, 0, -1e156]}]\ncontact: {surfaces: all}\n");
  const std::vector<std::string> says{" of part 'cube' at (", " at time 0; likely cause: loads",
                                      "check units"};
  expect_failure("", says);
  const Ending check = brio("check cube.yaml");
  EXPECT_EQ(check.exit_code, 3);
  for (const std::string& word : says) EXPECT_NE(check.faults.find(word), std::string::npos) << check.faults;
}

// It is known with the first step, before anything is written.
TEST_F(FailingRuns, AreNotBegunWhereTheTimeCouldNotAdvanceToTheEnd) {
  write_deck("[0, 0, -10]", "", "1e30");
  for (const std::string command : {"run cube.yaml --quiet", "check cube.yaml"}) {
    const Ending ending = brio(command);
    EXPECT_EQ(ending.exit_code, 2) << command;
    EXPECT_EQ(ending.faults.substr(0, 24), "cube.yaml:7:7: 'end' is ") << ending.faults;
  }
  EXPECT_FALSE(fs::exists(folder_ / "cube.results"));
}

// Earlier results are not mixed with those of the run that failed: they are moved aside.
TEST_F(FailingRuns, BeforeTheFirstDumpLeaveEarlierResultsWhole) {
  write_deck("[0, 0, -10]", "");
  ASSERT_EQ(brio("run cube.yaml --quiet").exit_code, 0);
  write_deck("[0, 0, 1e200]", "");
  expect_failure("", {"check units"});
  const auto earlier = nlohmann::json::parse(read("cube.results.previous/cube.summary.json"));
  EXPECT_EQ(earlier["status"], "finished");
  EXPECT_EQ(brio("info cube.results.previous").exit_code, 0);
}

}  // namespace
}  // namespace brio
