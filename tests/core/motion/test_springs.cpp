// Discrete springs and dashpots against closed forms; moments on rigid bodies and beams.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "src/base/index.hpp"
#include "src/model/state.hpp"
#include "src/output/observe.hpp"
#include "src/output/result_order.hpp"
#include "src/step/relax.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;
using std::numbers::pi;

constexpr double mass = 500;  // a rigid box of 1 x 1 x 0.5
constexpr double stiffness = 2e4;
const double frequency = std::sqrt(stiffness / mass);

SpringEnd at_node(Vector3d point, std::optional<std::string> part = {}) {
  return {.point = point, .part = std::move(part)};
}
SpringEnd fixed_at(Vector3d point) { return {.point = point, .fixed = true}; }

Spring spring(SpringEnd from, SpringEnd to) {
  Spring made{.name = "strut", .from = std::move(from), .to = std::move(to)};
  made.place = "deck.yaml:5:3";
  return made;
}

Part rigid_box(std::string name, Vector3d centre) {
  return box(std::move(name), {1, 1, 0.5}, {2, 2, 2}, centre, Rigid{});
}

/// A rigid mass that moves along x, on a spring from its centre node to a point on its left.
Deck oscillator(double velocity, double periods = 3) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {rigid_box("mass", {0, 0, 0})};
  deck.boundary_conditions = {fix("mass", {1, 2, 3, 4, 5})};
  deck.initial_conditions = {moving("mass", {velocity, 0, 0})};
  Spring made = spring(at_node({0, 0, 0}), fixed_at({-2, 0, 0}));
  made.stiffness = stiffness;
  deck.springs = {made};
  deck.time.step = 1e-3 / frequency;
  deck.time.end = std::round(periods * 2e3 * pi) * *deck.time.step;
  return deck;
}

/// Largest difference of the place of the mass from x(t).
template <class Exact>
double largest_error(const Deck& deck, Model& model, const Exact& exact) {
  ThreadTeam team(1);
  double error = 0;
  run(model, deck, team, [&](Model& m) {
    error = std::max(error, std::abs(m.rigid.body[0].centre[0] - exact(m.times.time)));
    EXPECT_LE(std::abs(m.energy.relative_error()), 1e-6);
  });
  return error;
}

TEST(Springs, AMassOscillatesAsTheClosedFormSays) {
  const double velocity = 0.3;
  const Deck deck = oscillator(velocity);
  Model model = build_model(deck);
  const double error =
      largest_error(deck, model, [&](double t) { return velocity / frequency * std::sin(frequency * t); });
  EXPECT_LE(error, 1e-6 * velocity / frequency);
  EXPECT_LE(model.energy.error_max, 1e-12);
  EXPECT_NEAR(model.control.stable, 2 / frequency, 1e-12 / frequency);
}

TEST(Springs, AStepAboveTheStableOneIsRefusedByTheNameOfTheSpring) {
  const double velocity = 1e-3;
  Deck deck = oscillator(velocity);
  deck.time.step = 2.001 / frequency;
  Model model = build_model(deck);
  ThreadTeam team(1);
  try {
    run(model, deck, team);
    ADD_FAILURE() << "it ran";
  } catch (const Breakdown& fault) {
    EXPECT_NE(std::string(fault.what()).find("spring 'strut'"), std::string::npos) << fault.what();
  }
  // Just below it the amplitude stays.
  deck.time.step = 1.999 / frequency;
  deck.time.end = 2000 / frequency;
  model = build_model(deck);
  double farthest = 0;
  run(model, deck, team,
      [&](Model& m) { farthest = std::max(farthest, std::abs(m.rigid.body[0].centre[0])); });
  EXPECT_LE(farthest, velocity / frequency / std::sqrt(1 - 0.9995 * 0.9995) * 1.01);
}

TEST(Springs, DampedOscillationDecaysAsTheClosedFormSays) {
  const double velocity = 0.3;
  for (const double ratio : {0.05, 0.4, 1.0, 1.5}) {
    SCOPED_TRACE(ratio);
    Deck deck = oscillator(velocity, 1.5);
    deck.springs[0].damping = 2 * ratio * std::sqrt(stiffness * mass);
    Model model = build_model(deck);
    const double rate = ratio * frequency;
    const double error = largest_error(deck, model, [&](double t) {
      const double split = std::sqrt(std::abs(1 - ratio * ratio)) * frequency;
      const double wave = ratio < 1    ? std::sin(split * t) / split
                          : ratio == 1 ? t
                                       : std::sinh(split * t) / split;
      return velocity * std::exp(-rate * t) * wave;
    });
    EXPECT_LE(error, 2e-6 * velocity / frequency);
    const double whole = 0.5 * mass * velocity * velocity;
    EXPECT_NEAR(model.energy.all_viscous(), whole - model.energy.kinetic - model.energy.internal,
                1e-9 * whole);
    // As of a velocity that lags by half a step: Belytschko, Liu, Moran 2000, section 6.2.
    const double exact = 2 / frequency * (std::sqrt(1 + ratio * ratio) - ratio);
    EXPECT_NEAR(model.control.stable, exact, 1e-9 * exact);
  }
}

// Of a node of elements as of a rigid body: the middle node of a light box that carries a point mass.
TEST(Springs, ADashpotOnANodeOfElementsTakesTheSame) {
  const double velocity = 0.3, ratio = 0.4;
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("block", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, inviscid_hex8())};
  deck.initial_conditions = {moving("block", {velocity, 0, 0})};
  for (const double y : {-0.5, 0.5})
    for (const double z : {-0.5, 0.5}) {
      Spring made = spring(at_node({-0.5, y, z}), fixed_at({-2, y, z}));
      made.name += std::to_string(deck.springs.size());
      made.stiffness = 100;
      made.damping = 2 * ratio * std::sqrt(100 * 250.0);
      deck.springs.push_back(made);
    }
  deck.boundary_conditions = {fix("block", {1, 2})};
  const double slow =
      std::sqrt(400 / 1000.0);  // a block of 1000 on four springs, far below its own frequencies
  deck.time.end = 1.5 / slow;
  deck.time.step = 2e-4;
  Model model = build_model(deck);
  ThreadTeam team(1);
  const double damped = slow * std::sqrt(1 - ratio * ratio);
  double error = 0;
  run(model, deck, team, [&](Model& m) {
    const double t = m.times.time;
    double place = 0;
    for (const NodeRecord& record : m.nodes.record) place += record.position[0] / 8;
    const double exact = velocity / damped * std::exp(-ratio * slow * t) * std::sin(damped * t);
    error = std::max(error, std::abs(place - exact));
  });
  EXPECT_LE(error, 2e-4 * velocity / slow);
  EXPECT_LE(model.energy.error_max, 1e-5);
  balance_momentum(model, momentum(model.nodes));
  EXPECT_LE(model.momentum.linear_imbalance(), 1e-12);
}

// Two rigid bodies, not through their centres: they turn, too.
TEST(Springs, ConserveMomentumAndEnergyOfBodiesThatTurn) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {rigid_box("left", {-2, 0, 0}), rigid_box("right", {2, 0.5, 0.3})};
  deck.initial_conditions = {moving("left", {0, 1, 0.5}), moving("right", {0, -1, 0})};
  Spring made = spring(at_node({-1.5, 0.5, 0.25}, "left"), at_node({1.5, 0, 0.05}, "right"));
  made.stiffness = 1e4;
  made.length = 2;  // starts stretched
  deck.springs = {made};
  deck.time.end = 4;
  deck.time.step_scale = 0.05;
  Model model = build_model(deck);
  ThreadTeam team(1);
  double largest_turn = 0;
  run(model, deck, team, [&](Model& m) {
    balance_momentum(m, momentum(m.nodes));
    ASSERT_LE(m.momentum.linear_imbalance(), 1e-12);
    ASSERT_LE(m.momentum.angular_imbalance(), 1e-12);
    largest_turn = std::max(largest_turn, norm(m.rigid.motion[0].angular_velocity));
  });
  EXPECT_GT(largest_turn, 1);
  EXPECT_GT(model.energy.kinetic_start,
            0.5 * mass * 2.25 + 0.5 * 1e4 * 0.9);  // what the spring stores as well
  EXPECT_LE(model.energy.error_max, 1e-3);
}

// k1 in tension and k2 in compression: half a period of each.
TEST(Springs, ATableOfForcesHasItsPeriodAndEnergy) {
  const double velocity = 0.4, stiff = 4 * stiffness;
  Deck deck = oscillator(velocity);
  deck.springs[0].stiffness = 0;
  deck.springs[0].force = {{-1, -stiff}, {0, 0}, {1, stiffness}};
  deck.time.step = 1e-3 / std::sqrt(stiff / mass);
  const double half = pi / frequency, period = half + 0.5 * half;
  deck.time.end = 2 * period;
  Model model = build_model(deck);
  const double error = largest_error(deck, model, [&](double t) {
    const double phase = std::fmod(t, period);
    return phase < half ? velocity / frequency * std::sin(frequency * phase)
                        : -0.5 * velocity / frequency * std::sin(2 * frequency * (phase - half));
  });
  EXPECT_LE(error, 1e-5 * velocity / frequency);
  EXPECT_NEAR(model.control.stable, 2 / std::sqrt(stiff / mass), 1e-12);
  // Beyond the last points the force stays.
  const SpringInRun& made = model.springs.spring[0];
  EXPECT_EQ(force_at(made, 3), stiffness);
  EXPECT_EQ(energy_at(made, 3), 0.5 * stiffness + 2 * stiffness);
  EXPECT_EQ(energy_at(made, -1.5), 0.5 * stiff + 0.5 * stiff);
}

TEST(Springs, BreakAtTheirStrength) {
  const double velocity = 1;
  Deck deck = oscillator(velocity);
  const double strength = 0.5 * stiffness * velocity / frequency;  // half of the largest force
  deck.springs[0].strength = strength;
  Model model = build_model(deck);
  const std::vector<std::string> columns = history_columns(model);
  ThreadTeam team(1);
  double largest = 0;
  run(model, deck, team, [&](Model& m) { largest = std::max(largest, m.springs.spring[0].force); });
  EXPECT_TRUE(model.springs.spring[0].is_broken);
  EXPECT_LE(largest, strength);
  EXPECT_GE(largest, 0.998 * strength);
  const double stored = 0.5 * strength * strength / stiffness;
  EXPECT_NEAR(model.energy.deleted, stored, 4e-3 * stored);
  EXPECT_NEAR(model.energy.internal, 0, 1e-9 * stored);
  EXPECT_NEAR(model.rigid.motion[0].velocity[0], velocity * std::sqrt(0.75), 1e-3);
  EXPECT_LE(model.energy.error_max, 1e-12);
  std::vector<double> row;
  observe_history(model, row);
  const auto column = std::find(columns.begin(), columns.end(), "spring.strut.force") - columns.begin();
  ASSERT_LT(index(column), columns.size());
  EXPECT_EQ(row[index(column)], 0);
}

TEST(Springs, AreSavedAndRestored) {
  Deck deck = oscillator(0.3);
  deck.springs[0].damping = 100;
  deck.springs[0].strength = 1e5;
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

// The bound holds for any number of springs at a node: a fan of them is stable at the whole step.
TEST(Springs, ManyAtOneNodeStayStable) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("block", {0.1, 0.1, 0.1}, {1, 1, 1}, {0, 0, 0}, hex8())};
  deck.initial_conditions = {moving("block", {1e-3, 2e-3, 0})};
  for (int i = 0; i < 7; ++i) {
    Spring made = spring(at_node({0.05, 0.05, 0.05}),
                         fixed_at({0.05 + std::cos(i), 0.05 + std::sin(i), 0.05 + 0.1 * i}));
    made.name += std::to_string(i);
    made.stiffness = 1e9;
    made.damping = 100 * i;
    deck.springs.push_back(made);
  }
  deck.time.step_scale = 1;
  deck.time.end = 2e-2;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_LE(model.energy.error_max, 0.02);
  EXPECT_GT(model.step, 1000);
}

TEST(Springs, AreRefusedWhereNothingCanMove) {
  const auto fault_of = [](Deck deck) -> std::string {
    try {
      build_model(deck);
    } catch (const BuildError& fault) {
      return fault.what();
    }
    return "";
  };
  Deck deck = oscillator(0);
  deck.springs[0].from = fixed_at({0, 0, 0});
  EXPECT_NE(fault_of(deck).find("both ends of spring 'strut' are fixed"), std::string::npos);
  deck.springs[0].from = at_node({0, 0, 0});
  deck.springs[0].to = at_node({0.5, 0.5, 0.25});
  EXPECT_NE(fault_of(deck).find("at one node or rigid part"), std::string::npos);
}

TEST(Springs, DoNotExistWhereNoDeckNamesThem) {
  Deck deck = oscillator(1);
  deck.springs.clear();
  const Model model = build_model(deck);
  EXPECT_TRUE(model.springs.empty());
  EXPECT_TRUE(model.springs.mass.empty());
}

// ---- moments

NodalMoment moment_on(std::string set, Vector3d moment) {
  NodalMoment load;
  load.where.set = std::move(set);
  load.moment = moment;
  return load;
}

TEST(Moments, TurnARigidBodyOnce) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {rigid_box("box", {3, 1, 2})};
  deck.loads = {moment_on("box", {0, 0, 40})};
  deck.time.end = 1;
  deck.time.step = 1e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  // About the axis of symmetry z; velocities are half a step ahead.
  EXPECT_NEAR(model.rigid.body[0].angular_momentum[2], 40 * 1.0005, 1e-10);
  const double inertia = mass * 2 / 12.0;
  EXPECT_NEAR(model.energy.external.at_step(), 0.5 * 40 * 40 / inertia, 1e-5);
  EXPECT_LE(model.energy.error_max, 1e-12);
  balance_momentum(model, momentum(model.nodes));
  EXPECT_LE(model.momentum.angular_imbalance(), 1e-12);
  EXPECT_LE(model.momentum.linear_imbalance(), 1e-12);
}

// Curvature M / EI, deflection M L^2 / 2 EI.
TEST(Moments, BendACantileverToACircle) {
  Beam2 beam;
  beam.section = RectangleSection{.width = 0.05, .height = 0.05};
  beam.orientation = {0, 0, 1};
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {{"beam", LineMesh{{0, 0, 0}, {1, 0, 0}, 8}, {}, beam, "material"}};
  deck.boundary_conditions = {fix("beam.start", {0, 1, 2, 3, 4, 5})};
  const double second_moment = std::pow(0.05, 4) / 12, moment = 0.2;
  deck.loads = {moment_on("beam.end", {0, -moment, 0})};
  deck.time.end = 1;
  deck.time.relaxation = Relaxation{};
  Model model = build_model(deck);
  ThreadTeam team(1);
  relax(*deck.time.relaxation, model, team);
  const auto tip = index(model.parts[0].node[8]);
  const double exact = moment / (2 * 1e9 * second_moment);
  EXPECT_NEAR(model.nodes.record[tip].position[2], exact, 1e-3 * exact);
}

TEST(Moments, OnNodesThatDoNotTurnAreRefused) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("block", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, hex8())};
  deck.loads = {moment_on("block.xmax", {0, 0, 1})};
  deck.time.end = 1;
  EXPECT_THROW(build_model(deck), BuildError);
}

}  // namespace
}  // namespace brio
