// Which runs a study makes, and which of them are worth their price.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "src/forecast/pareto.hpp"
#include "src/forecast/study.hpp"

namespace brio {
namespace {

TEST(ParetoFront, HoldsWhatNothingIsCheaperAndMoreAccurateThan) {
  const std::vector<CostAndError> runs{{1, 10}, {2, 5}, {2, 6}, {3, 5}, {4, 1}, {5, 2}};
  EXPECT_EQ(pareto_front(runs), (std::vector<bool>{true, true, false, false, true, false}));
}

TEST(ParetoFront, HoldsTwins) {
  EXPECT_EQ(pareto_front(std::vector<CostAndError>{{1, 1}, {1, 1}}), (std::vector<bool>{true, true}));
}

TEST(ParetoFront, LeavesOutFailedRuns) {
  const double nan = std::nan("");
  const std::vector<CostAndError> runs{{nan, nan}, {1, nan}, {2, 1}};
  EXPECT_EQ(pareto_front(runs), (std::vector<bool>{false, false, true}));
}

TEST(ParetoFront, BetterByAShareIsBetterInBoth) {
  EXPECT_TRUE(beats({0.9, 0.9}, {1, 1}, 0.05));
  EXPECT_FALSE(beats({0.96, 0.5}, {1, 1}, 0.05));
  EXPECT_FALSE(beats({0.5, 0.96}, {1, 1}, 0.05));
  EXPECT_FALSE(beats({0.5, std::nan("")}, {1, 1}, 0.05));
}

Study two_knobs() {
  Study study;
  study.set.overrides = {"time.end=1"};
  study.knobs = {{"mesh", {{"coarse", {{"a=1"}}}, {"fine", {{"a=3", "b=2"}}}}},
                 {"precision", {{"float", {{"c=float"}}}}}};
  return study;
}

TEST(StudyRuns, AreTheDefaultEachSettingAloneAndTheCombinations) {
  Study study = two_knobs();
  study.combinations = {{"mesh.fine", "precision.float"}};
  const std::vector<StudyRun> runs = runs_of(study);
  ASSERT_EQ(runs.size(), 5u);
  EXPECT_EQ(runs[0].name, "default");
  EXPECT_EQ(runs[0].overrides, (std::vector<std::string>{"time.end=1"}));
  EXPECT_EQ(runs[2].name, "mesh.fine");
  EXPECT_EQ(runs[2].knob, "mesh");
  EXPECT_EQ(runs[2].overrides, (std::vector<std::string>{"time.end=1", "a=3", "b=2"}));
  EXPECT_EQ(runs[4].name, "mesh.fine+precision.float");
  EXPECT_EQ(runs[4].overrides, (std::vector<std::string>{"time.end=1", "a=3", "b=2", "c=float"}));
}

TEST(StudyRuns, AreAnotherProblemWhereAKnobOfPhysicsIsTurned) {
  Study study = two_knobs();
  study.physics = {"precision"};
  study.combinations = {{"mesh.fine", "precision.float"}, {"mesh.coarse", "mesh.fine"}};
  std::vector<bool> other;
  for (const StudyRun& run : runs_of(study)) other.push_back(run.is_another_problem);
  EXPECT_EQ(other, (std::vector<bool>{false, false, false, true, true, false}));
}

TEST(StudyRuns, NameWhatIsNotThere) {
  Study study = two_knobs();
  study.combinations = {{"mesh.finest"}};
  EXPECT_THROW(runs_of(study), std::invalid_argument);
  study.combinations.clear();
  study.reference = "mesh";
  EXPECT_THROW(reference_run(study, runs_of(study)), std::invalid_argument);
  study.reference = "mesh.fine";
  EXPECT_EQ(reference_run(study, runs_of(study)), 2u);
}

}  // namespace
}  // namespace brio
