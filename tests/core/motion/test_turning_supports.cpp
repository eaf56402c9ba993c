// Supports that turn nodes, from rest: what they put in is what there is.

#include <gtest/gtest.h>

#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

PrescribedMotion turn(std::string set, int axis, MotionKind kind, Curve curve) {
  PrescribedMotion motion;
  motion.where.set = std::move(set);
  motion.kind = kind;
  motion.components = {{axis, std::move(curve)}};
  return motion;
}

Deck beam_held_at_its_start() {
  Beam2 beam;
  beam.section = RectangleSection{.width = 0.05, .height = 0.05};
  beam.orientation = {0, 0, 1};
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {{"strip", LineMesh{{0, 0, 0}, {1, 0, 0}, 12}, {}, beam, "material"}};
  deck.boundary_conditions = {fix("strip.start", {0, 1, 2, 3, 4, 5})};
  deck.time.end = 0.1;
  return deck;
}

Deck shells_held_at_one_edge() {
  Shell4 shell;
  shell.thickness = 0.05;
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {{"strip", PlateMesh{{1, 0.25}, {12, 3}}, {}, shell, "material"}};
  deck.boundary_conditions = {fix("strip.xmin", {0, 1, 2, 3, 4, 5})};
  deck.time.end = 0.1;
  return deck;
}

struct Turning {
  std::string name;
  MotionKind kind;
  Curve curve;
};

class TurnedFromRest : public testing::TestWithParam<Turning> {
 protected:
  static void expect_balance(Deck deck, const std::string& set) {
    deck.boundary_conditions.push_back(turn(set, 4, GetParam().kind, GetParam().curve));
    deck.time.step_bound = StepBound::elements;
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    EXPECT_GT(model.energy.external.at_step(), 1);
    EXPECT_GT(model.energy.internal, 0.1);
    EXPECT_LT(model.energy.error_max, 3e-4);  // of the size of the step squared
    model.momentum.now = momentum(model.nodes).total;
    EXPECT_LT(model.momentum.angular_imbalance(), 1e-10);
  }
};

TEST_P(TurnedFromRest, Beam) { expect_balance(beam_held_at_its_start(), "strip.end"); }
TEST_P(TurnedFromRest, Shells) { expect_balance(shells_held_at_one_edge(), "strip.xmax"); }

INSTANTIATE_TEST_SUITE_P(
    Supports, TurnedFromRest,
    testing::Values(Turning{"ramp", MotionKind::velocity, {{{0, 0}, {0.05, -20}, {0.1, 0}}}},
                    Turning{"at_once", MotionKind::velocity, {{{0, -5}}}},
                    Turning{"acceleration", MotionKind::acceleration, {{{0, -100}}}},
                    Turning{"angle", MotionKind::displacement, {{{0, 0}, {0.1, -0.5}}}}),
    [](const auto& entry) { return entry.param.name; });

TEST(TurningSupport, PutsInTheEnergyOfRotationWithItsFirstImpulse) {
  Deck deck = beam_held_at_its_start();
  deck.boundary_conditions.push_back(turn("strip.end", 4, MotionKind::velocity, {{{0, -5}}}));
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, 1e-12, team);
  const double inertia = model.nodes.rotational_inertia[index(model.parts[0].node[12])];
  EXPECT_EQ(model.energy.kinetic, 0);
  EXPECT_EQ(model.energy.external.at_step(), 0);
  EXPECT_DOUBLE_EQ(model.energy.kinetic_half, 0.5 * inertia * 25);
  EXPECT_DOUBLE_EQ(model.energy.external.after, inertia * 25);
}

}  // namespace
}  // namespace brio
