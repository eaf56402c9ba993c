// The program as scripts use it: exit codes, messages with places, what a run leaves behind.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

#include "tests/system/program.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;
using test::Program;

const std::string small_deck = R"(title: A cube that meets a wall
materials:
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0.3}
parts:
  cube: {mesh: {box: {size: [1, 1, 1], elements: [4, 4, 4]}}, element: hex8, material: rubber}
initial_conditions: [{part: cube, velocity: [0, 0, -10]}]
boundary_conditions: [{rigid_wall: {point: [0, 0, -0.6], normal: [0, 0, 1]}}]
time: {end: 0.03}
)";

// Of which threads cost more than they gain.
TEST_F(Program, ASmallSceneHasOneThreadUnlessMoreAreAskedFor) {
  write("cube.yaml", small_deck);
  ASSERT_EQ(brio("run cube.yaml --quiet").exit_code, 0);
  EXPECT_EQ(summary("cube")["threads"], 1);
  ASSERT_EQ(brio("run cube.yaml --quiet --overwrite --threads 3").exit_code, 0);
  EXPECT_EQ(summary("cube")["threads"], 3);
  EXPECT_NE(brio("check cube.yaml --coarse-run=0").output.find("for 1 thread,"), std::string::npos);
}

TEST_F(Program, RunsADeckAndLeavesItsResults) {
  write("cube.yaml", small_deck);
  const Ending ending = brio("run cube.yaml");
  EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  for (const char* file : {"cube.vtkhdf", "cube.xdmf2", "cube.history.csv", "cube.summary.json"})
    EXPECT_TRUE(fs::exists(folder_ / "cube.results" / file)) << file;
  const nlohmann::json end = summary("cube");
  EXPECT_EQ(end["status"], "finished");
  EXPECT_EQ(end["exit_code"], 0);
  EXPECT_DOUBLE_EQ(end["time"].get<double>(), 0.03);
  EXPECT_EQ(end["elements"]["hex8"], 64);
  EXPECT_LT(std::abs(end["energy"]["error_relative"].get<double>()), 0.01);
  EXPECT_NEAR(end["energy"]["total_start"].get<double>(), 0.5 * 1000 * 100, 1e-6);
  const Ending info = brio("info cube.results");
  EXPECT_EQ(info.exit_code, 0) << info.faults;
  EXPECT_NE(info.output.find("A cube that meets a wall"), std::string::npos) << info.output;
}

TEST_F(Program, JsonPrintsTheSummaryAlone) {
  write("cube.yaml", small_deck);
  const Ending ending = brio("run cube.yaml --json --quiet --threads 1");
  EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  EXPECT_EQ(nlohmann::json::parse(ending.output)["threads"], 1);
}

TEST_F(Program, CheckSaysWhatIsSwitchedOnAndWritesNothing) {
  write("cube.yaml", small_deck);
  const Ending ending = brio("check cube.yaml");
  EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  EXPECT_NE(ending.output.find("switched on: elastic hex8 rigid_wall"), std::string::npos) << ending.output;
  EXPECT_NE(ending.output.find("not built: shells"), std::string::npos) << ending.output;
  EXPECT_EQ(ending.output.find("warning"), std::string::npos) << ending.output;
  EXPECT_FALSE(fs::exists(folder_ / "cube.results"));
}

// A small scene is run to its end: the number of steps is exact, and results are as large as predicted.
TEST_F(Program, CheckForecastsARun) {
  write("cube.yaml", small_deck);
  const Ending ending = brio("check cube.yaml --threads 1 --json");
  EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  ASSERT_EQ(brio("run cube.yaml --threads 1").exit_code, 0);
  const nlohmann::json check = nlohmann::json::parse(ending.output), run = summary("cube");
  const nlohmann::json& forecast = check["forecast"];
  EXPECT_TRUE(forecast["steps_exact"]);
  EXPECT_EQ(forecast["steps"], run["steps"]);
  double bytes = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(folder_ / "cube.results"))
    bytes += static_cast<double>(file.file_size());
  EXPECT_NEAR(forecast["result_bytes"].get<double>(), bytes, 0.2 * bytes);
#if !defined(__SANITIZE_ADDRESS__)  // which keeps what is freed
  const double memory = run["peak_memory_mb"];
  EXPECT_NEAR(forecast["peak_memory_mb"].get<double>(), memory, 0.25 * memory);
#endif
  EXPECT_EQ(check["active_features"], run["active_features"]);
  EXPECT_TRUE(check["warnings"].empty()) << check["warnings"];
  EXPECT_EQ(check["step"]["part"], "cube");
}

TEST_F(Program, CheckWithACoarseRunRunsACoarserScene) {
  write("cube.yaml", small_deck);
  const Ending ending = brio(
      "check cube.yaml --threads 1 --json --coarse-run 1 --set time.end=1e3 --set output.fields.every=1e3");
  EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  const nlohmann::json forecast = nlohmann::json::parse(ending.output)["forecast"];
  EXPECT_FALSE(forecast["steps_exact"]);
  EXPECT_TRUE(!forecast["coarse_runs"].empty() || forecast["coarse_run_fault"] != "") << forecast;
  EXPECT_EQ(forecast["pilots"], forecast["coarse_runs"]) << "the old name";
}

TEST_F(Program, BudgetOfCoarseRunsIsSecondsOrAPercentage) {
  write("cube.yaml", small_deck);
  for (const char* budget : {"0", "0%", "0.1", "40%", "2.5%"}) {
    const Ending ending = brio("check cube.yaml --threads 1 --coarse-run=" + std::string(budget));
    EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  }
  for (const char* budget : {"-1", "%", "ten", "4%%", "nan", "inf"}) {
    const Ending ending = brio("check cube.yaml --threads 1 --coarse-run=" + std::string(budget));
    EXPECT_EQ(ending.exit_code, 2) << budget;
    EXPECT_NE(ending.faults.find("accepted: seconds >= 0, or a percentage"), std::string::npos)
        << ending.faults;
  }
}

TEST_F(Program, OldNameOfTheCoarseRunIsAcceptedWithANotice) {
  write("cube.yaml", small_deck);
  const Ending ending = brio("check cube.yaml --threads 1 --pilot=0");
  EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  EXPECT_NE(ending.faults.find("--pilot is called --coarse-run now"), std::string::npos) << ending.faults;
  EXPECT_EQ(brio("check cube.yaml --threads 1 --coarse-run=0").faults, "");
}

TEST_F(Program, CheckWarnsAndSaysWhy) {
  write("two.yaml", R"(
materials:
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e6, poissons_ratio: 0.3}
  forgotten: {model: elastic, density: 1000, youngs_modulus: 1e6, poissons_ratio: 0.3}
parts:
  lower: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, element: hex8, material: rubber}
  upper:
    mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}
    placement: {translate: [0, 0, 1.1]}
    element: hex8
    material: rubber
initial_conditions: [{part: upper, velocity: [0, 0, -10]}]
time: {end: 0.1}
)");
  const Ending ending = brio("check two.yaml --threads 1");
  EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  EXPECT_NE(ending.output.find("warning: material 'forgotten'"), std::string::npos) << ending.output;
  EXPECT_NE(ending.output.find("warning: parts 'lower' and 'upper'"), std::string::npos) << ending.output;
  EXPECT_NE(ending.output.find("hex8: because of parts.lower.element, parts.upper.element"),
            std::string::npos)
      << ending.output;
}

TEST_F(Program, OverlapsOfTheMeshAreReported) {
  write("two.yaml", R"(
materials:
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e6, poissons_ratio: 0.3}
parts:
  lower: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, element: hex8, material: rubber}
  upper:
    mesh: {box: {size: [0.5, 0.5, 0.5], elements: [1, 1, 1]}}
    placement: {translate: [0.05, 0.02, 0.745]}
    element: hex8
    material: rubber
contact: {surfaces: all}
time: {end: 1e-3}
)");
  for (const std::string command : {"check two.yaml", "run two.yaml --threads 1"}) {
    const Ending ending = brio(command);
    EXPECT_EQ(ending.exit_code, 0) << ending.faults;
    EXPECT_NE(ending.output.find("nodes of 'upper' lay in 'lower', the deepest by 0.005"), std::string::npos)
        << ending.output;
  }
}

TEST_F(Program, BadDecksEndWithTwoNameThePlaceAndLeaveNothing) {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<std::pair<std::string, std::string>> decks{
      {with(small_deck, "density", "densitty"), "bad.yaml:3:28"},
      {with(small_deck, "density: 1000", "density: -1"), "bad.yaml:3:"},
      {with(small_deck, "density: 1000", "density: .nan"), "bad.yaml:3:"},
      {with(small_deck, "poissons_ratio: 0.3", "poissons_ratio: 0.5"), "bad.yaml:3:"},
      {with(small_deck, "material: rubber", "material: steel"), "bad.yaml:5:"},
      {with(small_deck, "elements: [4, 4, 4]", "elements: many"), "bad.yaml:5:"},
      {with(small_deck, "time: {end: 0.03}", ""), "bad.yaml:"},
      {with(small_deck, "time: {end: 0.03}", "time: {end: 0.03, end: 1}"), "bad.yaml:8:"},
      {"", "bad.yaml"},
      {std::string("\x7f"
                   "ELF\x00\x01\xff\xfe",
                   8),
       "bad.yaml"},
  };
  for (const auto& [text, place] : decks) {
    write("bad.yaml", text);
    for (const char* command : {"run", "check"}) {
      const Ending ending = brio(std::string(command) + " bad.yaml");
      EXPECT_EQ(ending.exit_code, 2) << text;
      EXPECT_NE(ending.faults.find(place), std::string::npos) << ending.faults;
      EXPECT_FALSE(fs::exists(folder_ / "bad.results"));
    }
  }
}

TEST_F(Program, BadCommandsEndWithTwo) {
  write("cube.yaml", small_deck);
  for (const char* arguments :
       {"", "rum cube.yaml", "run", "run nothing.yaml", "run cube.yaml --threads 0",
        "run cube.yaml --set time.ende=1", "run cube.yaml --set time.end=-1", "check"})
    EXPECT_EQ(brio(arguments).exit_code, 2) << arguments;
  EXPECT_NE(brio("rum cube.yaml").faults.find("run"), std::string::npos);
}

TEST_F(Program, OverridesAreCheckedLikeTheDeck) {
  write("cube.yaml", small_deck);
  EXPECT_EQ(brio("run cube.yaml --set time.end=1e-3 --set parts.cube.mesh.box.elements=[2,2,2]").exit_code,
            0);
  EXPECT_EQ(summary("cube")["elements"]["hex8"], 8);
  EXPECT_EQ(summary("cube")["time"], 1e-3);
}

TEST_F(Program, NumericalFailureEndsWithThreeAndKeepsResults) {
  write("cube.yaml", small_deck);
  const Ending ending = brio("run cube.yaml --set time.step=1e-3");
  EXPECT_EQ(ending.exit_code, 3);
  EXPECT_NE(ending.faults.find("part 'cube'"), std::string::npos) << ending.faults;
  EXPECT_EQ(summary("cube")["status"], "failed");
  EXPECT_EQ(brio("info cube.results").exit_code, 0);
}

TEST_F(Program, CheckOfARunThatCannotStartEndsWithThree) {
  write("cube.yaml", small_deck);
  const Ending ending = brio("check cube.yaml --set time.step=1e-3");
  EXPECT_EQ(ending.exit_code, 3);
  EXPECT_NE(ending.faults.find("exceeds the stable time step"), std::string::npos) << ending.faults;
}

TEST_F(Program, UnwritableFolderEndsWithFour) {
  write("cube.yaml", small_deck);
  write("in the way", "");
  EXPECT_EQ(brio("run cube.yaml --output 'in the way'").exit_code, 4);
  EXPECT_EQ(brio("run cube.yaml --output /proc/brio").exit_code, 4);
}

TEST_F(Program, FileThatMayNotGrowEndsWithFourAndStaysReadable) {
  write("cube.yaml", small_deck);
  const Ending ending =
      brio("run cube.yaml --set output.fields.every=1e-4 --set time.end=0.1", "ulimit -f 800; ");
  EXPECT_EQ(ending.exit_code, 4) << ending.faults;
  EXPECT_EQ(brio("info cube.results").exit_code, 0);
}

TEST_F(Program, TerminationClosesResultsFirst) {
  write("cube.yaml", small_deck);
  const fs::path here = fs::current_path();
  const pid_t child = fork();
  if (child == 0) {
    fs::current_path(folder_);
    execl(BRIO_PROGRAM, BRIO_PROGRAM, "run", "cube.yaml", "--quiet", "--set", "time.end=1e6", "--threads",
          "1", nullptr);
    _exit(99);
  }
  for (int i = 0; i < 200 && !fs::exists(folder_ / "cube.results" / "cube.vtkhdf"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  kill(child, SIGTERM);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 143);
  EXPECT_EQ(summary("cube")["status"], "terminated");
  EXPECT_EQ(brio("info cube.results").exit_code, 0);
}

// The paper's second example on a coarse mesh, to the time at which the edge is through the upper half.
using ProgramSlow = Program;
TEST_F(ProgramSlow, CutsAPipe) {
  const Ending ending =
      brio("run '" BRIO_SOURCE_DIR
           "/inputs/pipe_cutting.yaml' --output cut --set parts.pipe.mesh.tube.elements=[48,36,3] "
           "--threads 1 --set contact.audit=true --set time.end=1.2e-3 --set output.fields.every=1e-4");
  ASSERT_EQ(ending.exit_code, 0) << ending.faults;
  const nlohmann::json found = nlohmann::json::parse(read("cut/pipe_cutting.summary.json"));
  expect_momentum_kept("cut/pipe_cutting.history.csv");
  EXPECT_EQ(found["contact"]["audited_dumps"], 13);
  EXPECT_EQ(found["crossings"], 0);
  EXPECT_EQ(found["contact"]["unresolved"], 0);
  EXPECT_EQ(found["contact"]["too_close"], 0);
  EXPECT_EQ(found["contact"]["swallowed"], 0);
  EXPECT_GT(found["deleted"]["hex8"], 50);
  EXPECT_GE(found["deleted_by_cause"]["damage"].get<double>(), 0.9 * found["deleted"]["hex8"].get<double>());
  EXPECT_LT(std::abs(found["energy"]["error_relative"].get<double>()), 1e-4);
  EXPECT_GT(found["dt"]["min"].get<double>(), 0.1 * found["dt"]["max"].get<double>());
  const nlohmann::json& mass = found["mass"];
  const double now =
      mass["intact"].get<double>() + mass["debris"].get<double>() + mass["deleted"].get<double>();
  EXPECT_NEAR(now, mass["start"].get<double>(), 1e-12 * mass["start"].get<double>());
  const double contact = found["energy"]["contact"].get<double>();
  EXPECT_GT(contact, -1e-3 * found["energy"]["external"].get<double>()) << "contact adds no energy";
}

TEST_F(ProgramSlow, ScattersBricks) {
  const Ending ending = brio("run '" BRIO_SOURCE_DIR
                             "/inputs/brick_stack.yaml' --output bricks --threads 1 "
                             "--set contact.audit=true --set time.end=6e-3 --set output.fields.every=5e-4");
  ASSERT_EQ(ending.exit_code, 0) << ending.faults;
  const nlohmann::json found = nlohmann::json::parse(read("bricks/brick_stack.summary.json"));
  expect_momentum_kept("bricks/brick_stack.history.csv");
  EXPECT_EQ(found["contact"]["bodies"], 19);
  EXPECT_EQ(found["crossings"], 0);
  EXPECT_EQ(found["contact"]["unresolved"], 0);
  EXPECT_EQ(found["contact"]["too_close"], 0);
  EXPECT_EQ(found["contact"]["swallowed"], 0);
  EXPECT_LT(std::abs(found["energy"]["error_relative"].get<double>()), 1e-4);
  EXPECT_GT(found["energy"]["contact"].get<double>(), 0) << "contact adds no energy";
}

// Bodies that overlap by rounding and have no load yet: the energy balance holds nothing but rounding.
TEST_F(ProgramSlow, BeginsAtRest) {
  const Ending ending =
      brio("run '" BRIO_SOURCE_DIR "/inputs/resting_stack.yaml' --output rest --set time.end=0.02");
  ASSERT_EQ(ending.exit_code, 0) << ending.faults;
  const nlohmann::json found = nlohmann::json::parse(read("rest/resting_stack.summary.json"));
  EXPECT_EQ(found["contact"]["bodies"], 10);
  EXPECT_GT(found["steps"], 500);
  EXPECT_LT(std::abs(found["energy"]["error_relative"].get<double>()), 1e-3);
}

TEST_F(ProgramSlow, CatchesATubeInANetOfBeams) {
  const Ending ending =
      brio("run '" BRIO_SOURCE_DIR "/inputs/net.yaml' --output net --set contact.audit=true");
  ASSERT_EQ(ending.exit_code, 0) << ending.faults;
  const nlohmann::json found = nlohmann::json::parse(read("net/net.summary.json"));
  EXPECT_EQ(found["crossings"], 0);
  EXPECT_EQ(found["contact"]["swallowed"], 0);
  EXPECT_EQ(found["contact"]["too_close"], 0);
  EXPECT_LT(std::abs(found["energy"]["error_relative"].get<double>()), 1e-2);
  EXPECT_GT(found["energy"]["contact"].get<double>(), 0);
  expect_momentum_kept("net/net.history.csv");
  EXPECT_GT(last_row("net/net.history.csv").at("tube.velocity_z"), 1) << "thrown back from -20";
}

// Particles, shells and beams in one contact, coarsely.
TEST_F(ProgramSlow, SplashesABirdOnAStiffenedPanel) {
  const Ending ending =
      brio("run '" BRIO_SOURCE_DIR
           "/inputs/bird_strike.yaml' --output bird --set contact.audit=true --set time.end=3e-3"
           " --set parts.bird.mesh.particles.cylinder.spacing=0.015 --set output.fields.every=3e-4");
  ASSERT_EQ(ending.exit_code, 0) << ending.faults;
  const nlohmann::json found = nlohmann::json::parse(read("bird/bird_strike.summary.json"));
  expect_momentum_kept("bird/bird_strike.history.csv");
  EXPECT_EQ(found["crossings"], 0);
  EXPECT_EQ(found["contact"]["missed"], 0);
  EXPECT_EQ(found["contact"]["bodies"], 2) << "the bird, and the panel with what is merged with it";
  EXPECT_LT(std::abs(found["energy"]["error_relative"].get<double>()), 1e-3);
  EXPECT_GT(found["energy"]["contact"].get<double>(), 0);
  EXPECT_GT(found["dt"]["min"].get<double>(), 0.5 * found["dt"]["max"].get<double>());
  EXPECT_LT(found["momentum"]["linear"][0].get<double>(), -60) << "it slides off";
}

}  // namespace
}  // namespace brio
