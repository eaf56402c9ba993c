// Mass-proportional damping and dynamic relaxation against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "src/step/relax.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

double velocity_of(const Model& model, std::size_t part, std::size_t axis) {
  return mean_velocity(model, part, axis);
}

// One element of unit size: masses of 500 at both ends of a spring of 1e9.
Deck oscillator(double velocity) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("spring", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, inviscid_hex8())};
  deck.boundary_conditions = {fix("spring.xmin", {0, 1, 2}), fix("spring.xmax", {1, 2})};
  deck.initial_conditions = {moving("spring.xmax", {velocity, 0, 0})};
  deck.time.step = 1e-6;
  return deck;
}

int end_node(const Model& model) {
  for (const int node : model.parts[0].node)
    if (model.nodes.record[index(node)].position[0] > 0) return node;
  return -1;
}

TEST(Damping, OscillationDecaysAsTheClosedFormSays) {
  const double velocity = 0.01, frequency = std::sqrt(1e9 / 500);
  for (const double ratio : {0.05, 0.2, 0.9}) {
    SCOPED_TRACE(ratio);
    Deck deck = oscillator(velocity);
    deck.parts[0].damping = 2 * ratio * frequency;
    deck.time.end = 12 / frequency;
    Model model = build_model(deck);
    ThreadTeam team(1);
    const auto node = index(end_node(model));
    const double start = model.nodes.record[node].position[0];
    const double damped = frequency * std::sqrt(1 - ratio * ratio);
    double largest_error = 0;
    run(model, deck, team, [&](Model& m) {
      const double t = m.times.time;
      const double exact = velocity / damped * std::exp(-ratio * frequency * t) * std::sin(damped * t);
      largest_error = std::max(largest_error, std::abs(m.nodes.record[node].position[0] - start - exact));
      EXPECT_LE(std::abs(m.energy.relative_error()), 2e-6);  // strains of 1e-5
    });
    EXPECT_LE(largest_error, 2e-5 * velocity / frequency);  // strains of 1e-5
    const double whole = 0.5 * 500 * velocity * velocity;
    EXPECT_NEAR(model.energy.all_viscous(), whole - model.energy.kinetic - model.energy.internal,
                1e-9 * whole);
    EXPECT_NEAR(model.energy.viscous, 0, 1e-12 * whole);
  }
}

// A mass of 1500 on the free end of the spring halves its frequency.
TEST(PointMass, LowersTheFrequencyOfASpring) {
  const double velocity = 0.01, frequency = std::sqrt(1e9 / 2000);
  Deck deck = oscillator(velocity);
  PointMass point;
  point.where.set = "spring.xmax";
  point.mass = 1500.0 / 4;
  deck.point_masses = {point};
  deck.time.end = 12 / frequency;
  Model model = build_model(deck);
  ThreadTeam team(1);
  const auto node = index(end_node(model));
  const double start = model.nodes.record[node].position[0];
  double largest_error = 0;
  run(model, deck, team, [&](Model& m) {
    const double exact = velocity / frequency * std::sin(frequency * m.times.time);
    largest_error = std::max(largest_error, std::abs(m.nodes.record[node].position[0] - start - exact));
  });
  EXPECT_LE(largest_error, 5e-5 * velocity / frequency);  // strains of 1e-5
  EXPECT_NEAR(model.energy.kinetic_start, 0.5 * 2000 * velocity * velocity, 1e-12);
}

TEST(PointMass, OfARigidPartIsRefused) {
  Deck deck = oscillator(0);
  deck.parts[0].element = Rigid{};
  deck.boundary_conditions.clear();
  deck.initial_conditions.clear();
  PointMass point;
  point.where.set = "spring.xmax";
  point.mass = 1;
  deck.point_masses = {point};
  EXPECT_THROW(build_model(deck), BuildError);
}

TEST(Damping, SlowsOnlyThePartThatNamesIt) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("damped", {1, 1, 1}, {2, 2, 2}, {0, 0, 0}, hex8()),
                box("free", {1, 1, 1}, {2, 2, 2}, {3, 0, 0}, hex8())};
  deck.parts[0].damping = 800;
  deck.initial_conditions = {moving("damped", {1, 2, 0}), moving("free", {1, 2, 0})};
  deck.time = {.end = 2e-3, .step_scale = 0.9, .step = 2e-6};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  // Velocities are those of the half step after the end; the first half step was half a step long.
  const double left = std::exp(-800 * (model.times.time + 0.5 * model.times.next));
  EXPECT_NEAR(velocity_of(model, 0, 0), left, 1e-5 * left);
  EXPECT_NEAR(velocity_of(model, 0, 1), 2 * left, 2e-5 * left);
  EXPECT_NEAR(velocity_of(model, 1, 0), 1, 1e-12);
  EXPECT_LE(std::abs(model.energy.relative_error()), 1e-9);
}

TEST(Damping, OfSharedNodesIsTheMeanByMass) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("damped", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, hex8()),
                box("free", {3, 1, 1}, {1, 1, 1}, {2, 0, 0}, hex8())};
  deck.parts[0].damping = 400;
  deck.connections = {Merge{{"damped", "free"}, 1e-6, ""}};
  deck.time.end = 1e-3;
  const Model model = build_model(deck);
  std::size_t shared = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const double x = model.nodes.record[i].position[0];
    const double expected = x < 0 ? 400 : x < 1 ? 100 : 0;
    EXPECT_NEAR(model.damping.rate[i], expected, 1e-12 * 400);
    if (x > 0 && x < 1) ++shared;
  }
  EXPECT_EQ(shared, 4u);
}

// Nothing of it exists where no deck names it.
TEST(Damping, IsEmptyWhereNoPartIsDamped) {
  const Model model = build_model(oscillator(1));
  EXPECT_TRUE(model.damping.empty());
  EXPECT_TRUE(model.damping.force.empty());
}

// A bar that hangs: u(x) = rho g / E (L x - x^2 / 2), which linear elements have at their nodes.
Deck hanging_bar() {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("bar", {0.1, 0.1, 1}, {1, 1, 20}, {0, 0, -0.5}, hex8())};
  deck.boundary_conditions = {fix("bar.zmax", {0, 1, 2})};
  Gravity gravity;
  gravity.acceleration = {0, 0, -10};
  deck.loads = {gravity};
  deck.time.end = 2e-3;
  deck.time.relaxation = Relaxation{.tolerance = 1e-6};
  return deck;
}

void expect_hanging(const Model& model, const std::vector<double>& start, double tolerance,
                    double risen = 0) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const double x = -start[i];
    const double expected = -1000 * 10 / 1e9 * (x - x * x / 2);
    EXPECT_NEAR(model.nodes.record[i].position[2] - start[i] - risen, expected, tolerance * 5e-6);
  }
}

TEST(Relaxation, ComesToTheStaticDeflectionAndStaysThere) {
  const Deck deck = hanging_bar();
  Model model = build_model(deck);
  std::vector<double> start;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) start.push_back(model.nodes.record[i].position[2]);
  ThreadTeam team(1);
  relax(*deck.time.relaxation, model, team);
  EXPECT_EQ(model.times.time, 0);
  EXPECT_EQ(model.step, 0);
  expect_hanging(model, start, 3e-5);  // strains of 1e-5
  run(model, deck, team);
  expect_hanging(model, start, 3e-5);
  EXPECT_LE(model.energy.kinetic, 1e-11 * model.energy.internal);
  EXPECT_LE(std::abs(model.energy.relative_error()), 1e-6);
  const double energy = 1000.0 * 1000 * 100 / 1e9 / 6 * 0.01;  // (rho g)^2 A L^3 / (6 E)
  EXPECT_NEAR(model.energy.internal, energy, 2e-3 * energy);   // 20 elements: 1 / (4 n^2) less
}

// Supports stand still before the run, and move in it; initial velocities are given after.
TEST(Relaxation, MotionsBeginWithTheRun) {
  Deck deck = hanging_bar();
  PrescribedMotion rise = fix("bar.zmax", {0, 1});
  rise.components.push_back({2, Curve{{{0, 0.3}}}});
  deck.boundary_conditions = {rise};
  deck.initial_conditions = {moving("bar", {0, 0, 0.3})};
  Model model = build_model(deck);
  std::vector<double> start;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) start.push_back(model.nodes.record[i].position[2]);
  ThreadTeam team(1);
  relax(*deck.time.relaxation, model, team);
  expect_hanging(model, start, 3e-5);
  EXPECT_NEAR(velocity_of(model, 0, 2), 0.3, 1e-12);
  run(model, deck, team);
  expect_hanging(model, start, 1e-3, 0.3 * model.times.time);
}

TEST(Relaxation, OfWhatNothingHoldsIsRefused) {
  Deck deck = hanging_bar();
  deck.boundary_conditions.clear();
  deck.time.relaxation->steps = 2000;
  Model model = build_model(deck);
  ThreadTeam team(1);
  try {
    relax(*deck.time.relaxation, model, team);
    FAIL() << "a falling bar is at rest";
  } catch (const Breakdown& fault) {
    EXPECT_NE(std::string(fault.what()).find("has not come to rest within 2000 steps"), std::string::npos);
  }
}

TEST(Relaxation, OfASceneWithoutLoadsChangesNothing) {
  Deck deck = hanging_bar();
  deck.loads.clear();
  Model model = build_model(deck);
  const Model before = model;
  ThreadTeam team(1);
  relax(*deck.time.relaxation, model, team);
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(model.nodes.record[i].position[axis], before.nodes.record[i].position[axis]);
}

}  // namespace
}  // namespace brio
