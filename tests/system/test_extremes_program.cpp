// The program at its ends: exit codes and messages, folders, results that exist.

#include <pwd.h>

#include "tests/system/program.hpp"

namespace brio {
namespace {

using namespace test;

using ExtremesProgram = Program;

const std::string cube = R"(title: A cube that meets a wall
materials:
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0.3}
parts:
  cube: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, element: hex8, material: rubber}
initial_conditions: [{part: cube, velocity: [0, 0, -10]}]
boundary_conditions: [{rigid_wall: {point: [0, 0, -0.6], normal: [0, 0, 1]}}]
time: {end: 0.02}
)";

TEST_F(ExtremesProgram, StepJustAboveTheCriticalOneEndsWithThreeAndNamesTheElement) {
  write("cube.yaml", cube);
  // Edges of 0.5; the bound is h/c sqrt((1 - nu) / (1 + nu)) = 3.1623e-4 less viscosity.
  EXPECT_EQ(brio("run cube.yaml --quiet --set time.step=2.9e-4").exit_code, 0);
  const Ending ending = brio("run cube.yaml --quiet --set time.step=3.2e-4");
  EXPECT_EQ(ending.exit_code, 3);
  EXPECT_NE(ending.faults.find("the constant time step 0.00032 exceeds the stable time step 0.000"),
            std::string::npos)
      << ending.faults;
  EXPECT_NE(ending.faults.find("of part 'cube'"), std::string::npos) << ending.faults;
  EXPECT_EQ(summary("cube")["status"], "failed");
}

TEST_F(ExtremesProgram, IncompressibleIsRefusedAndNearlySoRuns) {
  write("cube.yaml", cube);
  EXPECT_EQ(brio("run cube.yaml --quiet --set materials.rubber.poissons_ratio=0.4999").exit_code, 0);
  const Ending ending = brio("run cube.yaml --set materials.rubber.poissons_ratio=0.5");
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_NE(ending.faults.find("'poissons_ratio' is '0.5'; expected a number"), std::string::npos)
      << ending.faults;
}

TEST_F(ExtremesProgram, PathsWithSpacesAreReadAndWritten) {
  fs::create_directories(folder_ / "a folder");
  write("a folder/a deck.yaml", cube);
  const Ending ending = brio("run 'a folder/a deck.yaml' --quiet --output 'a folder/some results'");
  EXPECT_EQ(ending.exit_code, 0) << ending.faults;
  EXPECT_TRUE(fs::exists(folder_ / "a folder/some results/a deck.summary.json"));
  EXPECT_EQ(brio("info 'a folder/some results'").exit_code, 0);
}

// Root may write anywhere: another user tries.
TEST_F(ExtremesProgram, ReadOnlyFolderEndsWithFourBeforeAnythingIsComputed) {
  write("cube.yaml", cube);
  fs::create_directories(folder_ / "locked");
  fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                          fs::perms::others_exec);
  if (geteuid() == 0) {
    const passwd* nobody = getpwnam("nobody");
    if (nobody == nullptr) GTEST_SKIP() << "there is no other user";
    const fs::path locked = folder_ / "locked";
    const std::string deck = (folder_ / "cube.yaml").string();
    fs::permissions(folder_, fs::perms::all);
    const pid_t child = fork();
    if (child == 0) {
      if (setuid(nobody->pw_uid) != 0) _exit(99);
      execl(BRIO_PROGRAM, BRIO_PROGRAM, "run", deck.c_str(), "--quiet", "--output", locked.c_str(), nullptr);
      _exit(99);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 99)
      GTEST_SKIP() << "the program is not open to other users";
    EXPECT_EQ(WEXITSTATUS(status), 4);
  } else {
    const Ending ending = brio("run cube.yaml --quiet --output locked");
    EXPECT_EQ(ending.exit_code, 4);
    EXPECT_NE(ending.faults.find("Permission denied"), std::string::npos) << ending.faults;
  }
  EXPECT_TRUE(fs::is_empty(folder_ / "locked"));
}

// A later run of the same deck takes the place of the earlier one; what else is in the folder stays.
TEST_F(ExtremesProgram, ResultThatExistsIsReplacedAndOtherFilesStay) {
  write("cube.yaml", cube);
  ASSERT_EQ(brio("run cube.yaml --quiet").exit_code, 0);
  write("cube.results/notes.txt", "mine");
  EXPECT_EQ(brio("run cube.yaml --quiet --set time.end=0.01").exit_code, 0);
  EXPECT_EQ(summary("cube")["time"], 0.01);
  EXPECT_EQ(read("cube.results/notes.txt"), "mine");
  // One that is refused leaves the earlier results.
  EXPECT_EQ(brio("run cube.yaml --quiet --set time.end=-1").exit_code, 2);
  EXPECT_EQ(summary("cube")["time"], 0.01);
  EXPECT_EQ(brio("info cube.results").exit_code, 0);
}

TEST_F(ExtremesProgram, BodiesInOneAnotherEndWithTwoAndNameTheParts) {
  std::string two = cube;
  const std::string part =
      "  cube: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, element: hex8, material: rubber}\n";
  std::string again = part;
  two.insert(two.find(part), again.replace(2, 4, "copy"));
  two += "contact: {surfaces: all}\n";
  write("two.yaml", two);
  const Ending ending = brio("run two.yaml");
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_NE(ending.faults.find("lies in part"), std::string::npos) << ending.faults;
  EXPECT_FALSE(fs::exists(folder_ / "two.results"));
}

}  // namespace
}  // namespace brio
