// Torsional springs and dashpots, between rigid parts and nodes of shells, against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "src/base/index.hpp"
#include "src/model/state.hpp"
#include "src/output/observe.hpp"
#include "src/output/result_order.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;
using std::numbers::pi;

constexpr double box_mass = 500;                    // of 1 x 1 x 0.5
constexpr double box_inertia = box_mass * 2 / 12.;  // about z
constexpr double twist = 2e4;                       // moment per angle
const double hinge_rate = std::sqrt(twist / box_inertia);

SpringEnd near(Vector3d point, std::optional<std::string> part = {}) {
  return {.point = point, .part = std::move(part)};
}
SpringEnd ground(Vector3d point = {5, 5, 5}) { return {.point = point, .fixed = true}; }

Spring torsional(SpringEnd from, SpringEnd to, Vector3d axis) {
  Spring made{.name = "hinge", .from = std::move(from), .to = std::move(to)};
  made.axis = axis;
  made.stiffness = twist;
  made.place = "deck.yaml:5:3";
  return made;
}

Part heavy_box(std::string name, Vector3d centre) {
  return box(std::move(name), {1, 1, 0.5}, {2, 2, 2}, centre, Rigid{});
}

InitialCondition thrown_and_spinning(std::string part, Vector3d centre, Vector3d velocity, Vector3d spin) {
  InitialCondition condition = moving(std::move(part), velocity);
  condition.spin = Spin{centre, spin};
  return condition;
}

/// A rigid box that turns about z, against the ground.
Deck pendulum(double spin, double periods) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {heavy_box("mass", {0, 0, 0})};
  deck.boundary_conditions = {fix("mass", {0, 1, 2, 3, 4})};
  deck.initial_conditions = {thrown_and_spinning("mass", {0, 0, 0}, {}, {0, 0, spin})};
  deck.springs = {torsional(ground(), near({0.5, 0.5, 0.25}), {0, 0, 3})};
  deck.time.step = 1e-3 / hinge_rate;
  deck.time.end = std::round(periods * 2e3 * pi) * *deck.time.step;
  return deck;
}

double angle_of_box(const Model& model) {
  const Quaternion<double>& q = model.rigid.body[0].attitude;
  return 2 * std::atan2(q.z, q.w);
}

/// Largest difference of the angle of the box from x(t); the spring has the angle of the box.
template <class Exact>
double largest_angle_error(const Deck& deck, Model& model, const Exact& exact) {
  ThreadTeam team(1);
  double error = 0;
  run(model, deck, team, [&](Model& m) {
    error = std::max(error, std::abs(angle_of_box(m) - exact(m.times.time)));
    EXPECT_NEAR(m.springs.spring[0].elongation, angle_of_box(m), 1e-12);
    EXPECT_LE(std::abs(m.energy.relative_error()), 1e-6);
  });
  return error;
}

TEST(TorsionalSprings, ABodyOscillatesAsTheClosedFormSays) {
  const double spin = 0.3;
  const Deck deck = pendulum(spin, 3);
  Model model = build_model(deck);
  const double error = largest_angle_error(
      deck, model, [&](double t) { return spin / hinge_rate * std::sin(hinge_rate * t); });
  EXPECT_LE(error, 1e-6 * spin / hinge_rate);
  EXPECT_NEAR(model.control.stable, 2 / hinge_rate, 1e-12 / hinge_rate);
  balance_momentum(model, momentum(model.nodes));
  EXPECT_LE(model.momentum.angular_imbalance(), 1e-12);
}

TEST(TorsionalSprings, AStepAboveTheStableOneIsRefusedByTheNameOfTheSpring) {
  Deck deck = pendulum(1e-3, 3);
  deck.time.step = 2.001 / hinge_rate;
  Model model = build_model(deck);
  ThreadTeam team(1);
  try {
    run(model, deck, team);
    ADD_FAILURE() << "it ran";
  } catch (const Breakdown& fault) {
    EXPECT_NE(std::string(fault.what()).find("spring 'hinge'"), std::string::npos) << fault.what();
  }
  deck.time.step = 1.999 / hinge_rate;
  deck.time.end = 2000 / hinge_rate;
  model = build_model(deck);
  double farthest = 0;
  run(model, deck, team, [&](Model& m) { farthest = std::max(farthest, std::abs(angle_of_box(m))); });
  EXPECT_LE(farthest, 1e-3 / hinge_rate / std::sqrt(1 - 0.9995 * 0.9995) * 1.01);
}

TEST(TorsionalSprings, DampedOscillationDecaysAsTheClosedFormSays) {
  const double spin = 0.3;
  for (const double ratio : {0.05, 0.4, 1.0, 1.5}) {
    SCOPED_TRACE(ratio);
    Deck deck = pendulum(spin, 1.5);
    deck.springs[0].damping = 2 * ratio * std::sqrt(twist * box_inertia);
    Model model = build_model(deck);
    const double error = largest_angle_error(deck, model, [&](double t) {
      const double split = std::sqrt(std::abs(1 - ratio * ratio)) * hinge_rate;
      const double wave = ratio < 1    ? std::sin(split * t) / split
                          : ratio == 1 ? t
                                       : std::sinh(split * t) / split;
      return spin * std::exp(-ratio * hinge_rate * t) * wave;
    });
    EXPECT_LE(error, 2e-6 * spin / hinge_rate);
    const double whole = 0.5 * box_inertia * spin * spin;
    EXPECT_NEAR(model.energy.all_viscous(), whole - model.energy.kinetic - model.energy.internal,
                1e-9 * whole);
    const double exact = 2 / hinge_rate * (std::sqrt(1 + ratio * ratio) - ratio);
    EXPECT_NEAR(model.control.stable, exact, 1e-9 * exact);
  }
}

// Two bodies that tumble, on a hinge whose axis turns with the first: moments are opposite, whatever the
// axis.
TEST(TorsionalSprings, ConserveMomentumAndEnergyOfBodiesThatTumble) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {heavy_box("left", {-2, 0, 0}), heavy_box("right", {2, 0.5, 0.3})};
  deck.initial_conditions = {thrown_and_spinning("left", {-2, 0, 0}, {0, 1, 0.5}, {1, 2, 0.3}),
                             thrown_and_spinning("right", {2, 0.5, 0.3}, {0, -1, 0}, {-1, 0, 2})};
  deck.springs = {torsional(near({-1.5, 0.5, 0.25}, "left"), near({1.5, 0, 0.05}, "right"), {1, 1, 0.5})};
  deck.springs[0].angle = -0.5;
  deck.time.end = 3;
  deck.time.step_scale = 0.02;
  const auto error_at = [&](double scale) {
    deck.time.step_scale = scale;
    Model model = build_model(deck);
    ThreadTeam team(1);
    double least = 0, most = 0, error = 0;
    run(model, deck, team, [&](Model& m) {
      balance_momentum(m, momentum(m.nodes));
      EXPECT_LE(m.momentum.linear_imbalance(), 1e-12);
      EXPECT_LE(m.momentum.angular_imbalance(), 1e-12);
      least = std::min(least, m.springs.spring[0].elongation);
      most = std::max(most, m.springs.spring[0].elongation);
      // At the first step velocities are those of the start, not of half a step before.
      if (m.step > 0) error = std::max(error, std::abs(m.energy.relative_error()));
    });
    EXPECT_GT(most - least, 0.5);
    return error;
  };
  const double coarse = error_at(0.04), fine = error_at(0.02);
  EXPECT_LE(fine, 1e-3);
  EXPECT_LE(fine, 0.3 * coarse);  // second order in the time step
}

// The axis turns with its first end: a quarter turn of that end about x takes the axis z to -y.
TEST(TorsionalSprings, TheAxisTurnsWithItsFirstEnd) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {heavy_box("arm", {0, 0, 0}), heavy_box("wheel", {4, 0, 0})};
  PrescribedMotion turn = fix("arm", {0, 1, 2, 4, 5});
  turn.components.push_back({3, Curve{{{0, pi / 2}}}});  // about x
  deck.boundary_conditions = {turn, fix("wheel", {0, 1, 2, 3, 4, 5})};
  deck.springs = {torsional(near({0.5, 0, 0}, "arm"), near({3.5, 0, 0}, "wheel"), {0, 0, 1})};
  deck.time.step = 1e-3;
  deck.time.end = 1;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  const SpringInRun& hinge = model.springs.spring[0];
  EXPECT_NEAR(norm(hinge.direction - Vector3d{0, -1, 0}), 0, 1e-6);
  EXPECT_NEAR(hinge.elongation, 0, 1e-12);  // the turn is across the axis
}

/// A shell whose nodes turn about its normal against the ground; nothing else resists that.
Deck turning_nodes(double angle) {
  Shell4 shell;
  shell.thickness = 0.1;
  shell.drilling_stiffness = shell.drilling_viscosity = 0;
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {{"plate", PlateMesh{{1, 1}, {1, 1}}, {}, shell, "material"}};
  deck.boundary_conditions = {fix("plate", {0, 1, 2, 3, 4})};
  for (const double x : {-0.5, 0.5}) {
    deck.springs.push_back(torsional(ground(), near({x, 0.5, 0}), {0, 0, 1}));
    deck.springs.back().name += x < 0 ? "_left" : "_right";
    deck.springs.back().angle = angle;
  }
  return deck;
}

TEST(TorsionalSprings, NodesOfShellsOscillateAsTheClosedFormSays) {
  const double angle = 0.2;
  Deck deck = turning_nodes(angle);
  Model model = build_model(deck);
  const auto node = index(model.springs.spring[0].end[1].node);
  const double inertia = model.nodes.rotational_inertia[node];
  for (Spring& spring : deck.springs) spring.stiffness = 1e-3 * inertia / 1e-12;
  const double fast = std::sqrt(deck.springs[0].stiffness / inertia);
  for (const double ratio : {0.0, 0.3}) {
    SCOPED_TRACE(ratio);
    for (Spring& spring : deck.springs) spring.damping = 2 * ratio * inertia * fast;
    deck.time.step = 1e-3 / fast;
    deck.time.end = 9 / fast;
    model = build_model(deck);
    EXPECT_NEAR(model.energy.internal, deck.springs[0].stiffness * angle * angle,
                1e-12 * model.energy.internal);
    const double split = fast * std::sqrt(1 - ratio * ratio);
    ThreadTeam team(1);
    double error = 0;
    run(model, deck, team, [&](Model& m) {
      const double t = m.times.time;
      const double exact = angle * std::exp(-ratio * fast * t) *
                           (std::cos(split * t) + ratio * fast / split * std::sin(split * t));
      error = std::max(error, std::abs(m.springs.spring[1].elongation - exact));
    });
    EXPECT_LE(error, 2e-6 * angle);
    EXPECT_LE(model.energy.error_max, 1e-6);
    balance_momentum(model, momentum(model.nodes));
    // No node moves, so that the imbalance is not divided by any momentum.
    EXPECT_EQ(model.momentum.angular_scale, 0);
    EXPECT_LE(model.momentum.angular_imbalance(), 1e-12 * deck.springs[0].stiffness * angle / fast);
  }
}

// Two at a node bound the time step by the sum of their stiffness: at 0.95 of it the amplitude is that of
// central differences.
TEST(TorsionalSprings, StiffOnesBoundTheStepOfShells) {
  Deck deck = turning_nodes(1e-3);
  for (Spring& spring : deck.springs) spring.stiffness = 5e9;
  for (const std::size_t i : {0u, 1u}) {
    deck.springs.push_back(deck.springs[i]);
    deck.springs.back().name += "_again";
  }
  deck.time.step_scale = 0.95;
  deck.time.end = 0.04;
  deck.numerics.energy_error_limit = 1e3;  // no energy at all is conserved at such a step
  Model model = build_model(deck);
  ThreadTeam team(1);
  double most = 0;
  run(model, deck, team, [&](Model& m) { most = std::max(most, std::abs(m.springs.spring[0].elongation)); });
  EXPECT_GE(model.springs.critical, 0);
  EXPECT_GT(model.step, 1000);
  EXPECT_LE(most, 1e-3 / std::sqrt(1 - 0.95 * 0.95) * 1.01);
  const auto node = index(model.springs.spring[0].end[1].node);
  const double both = std::sqrt(1e10 / model.nodes.rotational_inertia[node]);
  EXPECT_LE(model.control.stable, 2 / both);
  EXPECT_GE(model.control.stable, 0.9 * 2 / both);
}

TEST(TorsionalSprings, ATableOfMomentsHasItsPeriodAndEnergy) {
  const double spin = 0.4, stiff = 4 * twist;
  Deck deck = pendulum(spin, 3);
  deck.springs[0].stiffness = 0;
  deck.springs[0].moment = {{-1, -stiff}, {0, 0}, {1, twist}};
  deck.time.step = 1e-3 / std::sqrt(stiff / box_inertia);
  const double half = pi / hinge_rate, period = 1.5 * half;
  deck.time.end = 2 * period;
  Model model = build_model(deck);
  const double error = largest_angle_error(deck, model, [&](double t) {
    const double phase = std::fmod(t, period);
    return phase < half ? spin / hinge_rate * std::sin(hinge_rate * phase)
                        : -0.5 * spin / hinge_rate * std::sin(2 * hinge_rate * (phase - half));
  });
  EXPECT_LE(error, 1e-5 * spin / hinge_rate);
}

// In either direction, with what it stores.
TEST(TorsionalSprings, BreakAtTheirStrength) {
  for (const double spin : {1.0, -1.0}) {
    Deck deck = pendulum(spin, 3);
    const double strength = 0.5 * twist / hinge_rate;  // half of the largest moment
    deck.springs[0].strength = strength;
    Model model = build_model(deck);
    const std::vector<std::string> columns = history_columns(model);
    ThreadTeam team(1);
    double largest = 0;
    run(model, deck, team,
        [&](Model& m) { largest = std::max(largest, std::abs(m.springs.spring[0].force)); });
    EXPECT_TRUE(model.springs.spring[0].is_broken);
    EXPECT_LE(largest, strength);
    EXPECT_GE(largest, 0.998 * strength);
    const double stored = 0.5 * strength * strength / twist;
    EXPECT_NEAR(model.energy.deleted, stored, 4e-3 * stored);
    EXPECT_NEAR(std::abs(model.rigid.motion[0].angular_velocity[2]), std::sqrt(0.75), 1e-3);
    EXPECT_LE(model.energy.error_max, 1e-12);
    EXPECT_NE(std::find(columns.begin(), columns.end(), "spring.hinge.angle"), columns.end());
    const auto moment = std::find(columns.begin(), columns.end(), "spring.hinge.moment") - columns.begin();
    std::vector<double> row;
    observe_history(model, row);
    ASSERT_EQ(row.size(), columns.size());
    EXPECT_EQ(row[index(moment)], 0);
  }
}

TEST(TorsionalSprings, AreSavedAndRestored) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {heavy_box("left", {-2, 0, 0}), heavy_box("right", {2, 0.5, 0.3})};
  deck.initial_conditions = {thrown_and_spinning("left", {-2, 0, 0}, {0, 1, 0.5}, {1, 2, 0.3})};
  deck.springs = {torsional(near({-1.5, 0.5, 0.25}, "left"), near({1.5, 0, 0.05}, "right"), {1, 1, 0.5})};
  deck.springs[0].damping = 10;
  deck.time.end = 10;
  ThreadTeam team(1);
  const auto state_of = [](const Model& model) {
    std::ostringstream out;
    save_state(model, out);
    return out.str();
  };
  Model whole = build_model(deck);
  make_steps(whole, 300, 1, team);
  const std::string saved = state_of(whole);
  make_steps(whole, 300, 1, team);
  Model continued = build_model(deck);
  std::istringstream in(saved);
  restore_state(continued, in, saved.size());
  make_steps(continued, 300, 1, team);
  EXPECT_TRUE(state_of(continued) == state_of(whole));
}

TEST(TorsionalSprings, OnNodesThatDoNotTurnAreRefused) {
  Deck deck = pendulum(0, 1);
  deck.parts = {box("mass", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, hex8())};
  deck.boundary_conditions.clear();
  deck.initial_conditions.clear();
  try {
    build_model(deck);
    ADD_FAILURE() << "it was built";
  } catch (const BuildError& fault) {
    EXPECT_NE(std::string(fault.what()).find("a node that does not turn"), std::string::npos) << fault.what();
    EXPECT_EQ(fault.place, "deck.yaml:5:3");
  }
}

TEST(TorsionalSprings, SayWhatTheyAccept) {
  Spring spring = torsional(ground(), near({0, 0, 0}), {0, 0, 1});
  EXPECT_EQ(spring.fault(), "");
  spring.length = 1;
  EXPECT_NE(spring.fault().find("accepted beside 'axis' are moment and angle"), std::string::npos);
  spring.length.reset();
  spring.axis = {0, 0, 0};
  EXPECT_NE(spring.fault().find("no direction"), std::string::npos);
  spring.axis.reset();
  spring.angle = 1;
  EXPECT_NE(spring.fault().find("an 'axis' is wanted"), std::string::npos);
}

}  // namespace
}  // namespace brio
