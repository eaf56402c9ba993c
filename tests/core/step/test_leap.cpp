// Forces that throw nodes out of the scene within a step are refused by name before contact looks for what
// nodes that are everywhere meet; speed alone is where it brings thousands of features near each other.

#include <gtest/gtest.h>

#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

/// A body of a kind over another, that does not move yet.
Deck two_bodies(Kind kind) {
  Deck deck = impact(kind, Kind::hex8);
  deck.initial_conditions.clear();
  deck.numerics.energy_error_limit = HUGE_VAL;
  return deck;
}

/// What the first step says; nothing where it is made.
std::string fault_of_first_step(const Deck& deck) {
  Model model = build_model(deck);
  ThreadTeam team(1);
  try {
    update_velocities(model, deck.numerics.energy_error_limit, team);
  } catch (const Breakdown& breakdown) {
    return breakdown.what();
  }
  return {};
}

/// Gravity that moves what starts at rest by so many widths of the scene in the first step.
Gravity gravity_of_leap(const Deck& deck, double widths) {
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, HUGE_VAL, team);
  Gravity gravity;
  gravity.acceleration = {0, 0, -widths * model.extent.width / (model.times.mean() * model.times.next)};
  return gravity;
}

void expect_leap_named(const std::string& fault, double widths) {
  EXPECT_NE(fault.find("forces move node "), std::string::npos) << fault;
  EXPECT_NE(fault.find(" of part '"), std::string::npos) << fault;
  EXPECT_NE(fault.find(" at time 0; likely cause: loads"), std::string::npos) << fault;
  const std::size_t after = fault.find(" widths of the scene");
  ASSERT_NE(after, std::string::npos) << fault;
  const std::size_t before = fault.rfind(' ', after - 1);
  EXPECT_NEAR(std::stod(fault.substr(before, after - before)) / widths, 1, 1e-5) << fault;
}

class Leap : public testing::TestWithParam<Kind> {};

TEST_P(Leap, OfAHundredWidthsInAStepIsRefusedAndOneBelowIsNot) {
  Deck deck = two_bodies(GetParam());
  for (const double widths : {101., 1e9, 1e60, 1e140}) {
    deck.loads = {gravity_of_leap(two_bodies(GetParam()), widths)};
    expect_leap_named(fault_of_first_step(deck), widths);
  }
  deck.loads = {gravity_of_leap(two_bodies(GetParam()), 99)};
  EXPECT_EQ(fault_of_first_step(deck), "");
}

// The change counts and not the speed: a frame that makes a million widths in a step sees the same.
TEST_P(Leap, IsTheSameInAFrameThatMoves) {
  Deck deck = two_bodies(GetParam());
  const Gravity over = gravity_of_leap(deck, 101), below = gravity_of_leap(deck, 99);
  deck.initial_conditions = {moving("upper", {0, 1e10, -1e12}), moving("lower", {0, 1e10, -1e12})};
  deck.loads = {over};
  expect_leap_named(fault_of_first_step(deck), 101);
  deck.loads = {below};
  EXPECT_EQ(fault_of_first_step(deck), "");
}

// Of a force on a few nodes as of one on all of them.
TEST_P(Leap, OfNodesThatArePushedIsThatOfTheOneThatIsThrownFarthest) {
  Deck deck = two_bodies(GetParam());
  NodalForce force;
  force.where.set = "upper";
  force.force = {1e80, 0, 0};
  deck.loads = {force};
  const std::string fault = fault_of_first_step(deck);
  EXPECT_NE(fault.find(" of part 'upper'"), std::string::npos) << fault;
  EXPECT_NE(fault.find("forces move node "), std::string::npos) << fault;
}

// Supports resist any load.
TEST(LeapOfHeldNodes, IsNone) {
  Deck deck = two_bodies(Kind::hex8);
  deck.loads = {gravity_of_leap(deck, 1e20)};
  deck.boundary_conditions = {fix("lower", {0, 1, 2}), fix("upper", {0, 1, 2})};
  EXPECT_EQ(fault_of_first_step(deck), "");
}

// A sheet of 40 x 40 shells that a block crosses in a step: its nodes would move past all others.
TEST(Crowd, OfASheetThatIsHitAtManyWidthsAStepIsRefusedByName) {
  Deck deck = two_bodies(Kind::shell);
  for (Part& part : deck.parts)
    if (auto* plate = std::get_if<PlateMesh>(&part.mesh)) plate->elements = {40, 40};
  deck.initial_conditions = {moving("upper", {0, 0, -1e9})};
  const std::string fault = fault_of_first_step(deck);
  EXPECT_NE(fault.find("too many contact candidates (all is near all) in one time step, at time 0: node "),
            std::string::npos)
      << fault;
  EXPECT_NE(fault.find(" of part 'upper'"), std::string::npos) << fault;
  EXPECT_NE(fault.find(" widths of the scene"), std::string::npos) << fault;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Leap, testing::ValuesIn(deformable_kinds),
                         [](const auto& kind) { return name_of_kind(kind.param); });

}  // namespace
}  // namespace brio
