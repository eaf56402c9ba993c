// The step as a whole: waves, walls, energy balance, and what must not depend on threads or frames.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// A bar along x of n elements and length 1, cross-section h by h.
Deck bar(int elements, double velocity, const Hex8& element) {
  Deck deck;
  const double h = 1.0 / elements;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("bar", {1, h, h}, {elements, 1, 1}, {0.5, 0, 0}, element)};
  deck.initial_conditions = {moving("bar", {velocity, 0, 0})};
  return deck;
}

RigidWall wall(Vector3d point, Vector3d normal) {
  RigidWall result;
  result.point = point;
  result.normal = normal;
  return result;
}

// Stress behind the front when material that meets a wall at speed v is stopped, with sigma = E ln(stretch)
// in uniaxial strain and nu 0: the jump conditions rho U v = sigma, stretch = 1 - v/U. For small v it is rho
// c v.
double stopping_stress(double speed) {
  double front = 1000;
  for (int i = 0; i < 100; ++i)
    front = std::sqrt(front * -1e9 * std::log(1 - speed / front) / (1000 * speed));
  return 1000 * front * speed;
}

// Bar against a wall at x = 0: stress rho c v until 2L/c, then it leaves.
struct BarImpact {
  double stress = 0;    ///< mean over the middle element while the plateau lasts
  double duration = 0;  ///< last time at which the wall pushed
  double restitution = 0;
  double energy_error = 0;
  double dissipated = 0;  ///< by the wall, over the kinetic energy at the start
};
BarImpact impact_on_wall(int elements, double speed, const Hex8& element) {
  Deck deck = bar(elements, -speed, element);
  deck.boundary_conditions = {wall({0, 0, 0}, {1, 0, 0})};
  deck.time.end = 3e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  BarImpact result;
  double samples = 0, last_impulse = 0;
  run(model, deck, team, [&](Model& m) {
    if (m.times.time > 0.8e-3 && m.times.time < 1.2e-3) {
      const std::size_t middle = index(m.parts[0].element_slot[index(elements / 4)]);
      result.stress -= m.blocks[0].kernel.sample(m.blocks[0], m.nodes, middle, true).stress.xx;
      ++samples;
    }
    if (m.momentum.walls.linear[0] > last_impulse) result.duration = m.times.time;
    last_impulse = m.momentum.walls.linear[0];
  });
  result.stress /= samples;
  result.restitution = mean_velocity(model, 0, 0) / speed;
  result.energy_error = model.energy.error_max;
  result.dissipated = -model.energy.contact.at_step() / model.energy.kinetic_start;
  return result;
}

TEST(Step, BarOnRigidWallCarriesTheWaveStressAndLeavesAfterTwoTransits) {
  EXPECT_NEAR(stopping_stress(1), 1e6, 0.001e6);
  for (double speed : {1.0, 100.0}) {
    for (int elements : {20, 40}) {
      const BarImpact impact = impact_on_wall(elements, speed, hex8());
      EXPECT_NEAR(impact.stress, stopping_stress(speed), 0.01 * stopping_stress(speed));
      EXPECT_NEAR(impact.duration, 2e-3, 0.05 * 2e-3);
      EXPECT_GE(impact.restitution, 0.92);
      EXPECT_LE(impact.restitution, 1.0);
      EXPECT_LE(impact.energy_error, 0.01);
    }
  }
}

// A lumped mass that meets a wall stops at once: that energy is dissipated, counted as contact, and halves
// with the element.
TEST(Step, LossOfALumpedImpactHalvesWithTheElementSize) {
  const BarImpact coarse = impact_on_wall(20, 1, inviscid_hex8());
  const BarImpact fine = impact_on_wall(40, 1, inviscid_hex8());
  EXPECT_GE(coarse.restitution, 0.96);
  EXPECT_GE(fine.restitution, 0.975);
  EXPECT_NEAR(fine.dissipated / coarse.dissipated, 0.5, 0.05);
}

TEST(Step, StepLoadSendsAFrontAtTheWaveSpeedWithoutRinging) {
  Deck deck = bar(100, 0, hex8());
  NodalForce force;
  force.where.set = "bar.xmin";
  force.force = {1e-4 * 1e6 / 4, 0, 0};  // stress 1e6 on an area of 1e-4, four nodes
  deck.loads = {force};
  deck.time.end = 0.5e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  double front = 0, largest = 0;
  for (int e = 0; e < 100; ++e) {
    const auto slot = index(model.parts[0].element_slot[index(e)]);
    const double stress = -model.blocks[0].kernel.sample(model.blocks[0], model.nodes, slot, true).stress.xx;
    largest = std::max(largest, stress);
    front += 0.01 * stress / 1e6;  // momentum carried: area under the profile
  }
  EXPECT_NEAR(front, 0.5, 0.005);
  EXPECT_LE(largest, 1.1e6);
}

TEST(Step, FreeCubeIsStableWhereNineTenthsOfEdgeOverSpeedIsNot) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("cube", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, inviscid_hex8())};
  deck.time.end = 1;
  Model model = build_model(deck);
  ThreadTeam team(1);
  // A breathing disturbance of the mode that sets the limit.
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      model.nodes.record[i].velocity[axis] = 1e-3 * model.nodes.record[i].position[axis];
  update_velocities(model, 1e9, team);
  const double start = model.energy.kinetic_half;
  const double wave_speed = std::sqrt(1e9 * 0.7 / (1.3 * 0.4) / 1000);
  EXPECT_NEAR(model.control.stable * wave_speed, std::sqrt(0.7 / 1.3), 1e-3);
  double largest = 0;
  look_at_steps(model, 20001, 1e9, team,
                [&](int) { largest = std::max(largest, model.energy.kinetic_half); });
  // An oscillation sampled with omega dt / 2 = 0.9 from its start at rest peaks at v0^2 / (1 - 0.9^2).
  EXPECT_NEAR(largest, start / (1 - 0.81), 0.01 * start);
}

// A distorted, spinning block under gravity on three supports with a pressure on top: every term
// of the energy balance.
Deck busy_deck() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("a", {2, 1, 1}, {12, 6, 6}, {0, 0, 0}, hex8()),
                box("b", {1, 1, 1}, {7, 6, 5}, {5, 0, 3}, hex8())};
  InitialCondition spin;
  spin.where.set = "b";
  spin.velocity = {20, 5, 0};
  spin.spin = Spin{{5, 0, 3}, {10, 0, 40}};
  deck.initial_conditions = {spin};
  deck.boundary_conditions = {fix("a.xmin", {0, 1, 2}), wall({6, 0, 0}, {-1, 0, 0})};
  Gravity gravity;
  gravity.acceleration = {0, 0, -1000};
  deck.loads = {gravity, Pressure{"a.zmax", Curve{{{0, 0}, {1e-3, 1e7}}}}};
  deck.time.end = 0.02;
  return deck;
}

TEST(Step, EnergyAndMomentumBalance) {
  const Deck deck = busy_deck();
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_LT(model.energy.error_max, 0.01);
  const Momentum now = momentum(model.nodes);
  model.momentum.now = now.total;
  EXPECT_LT(model.momentum.linear_imbalance(), 1e-10);
  EXPECT_LT(model.momentum.angular_imbalance(), 1e-10);
  EXPECT_GT(model.energy.external.at_step(), 0);
  EXPECT_LT(model.energy.contact.at_step(), 0);
}

TEST(Step, BitsDoNotDependOnTheNumberOfThreads) {
  const Deck deck = busy_deck();
  std::vector<Model> models;
  for (int threads : {1, 2, 4}) {
    models.push_back(build_model(deck));
    ThreadTeam team(threads);
    run(models.back(), deck, team);
  }
  for (std::size_t i = 1; i < models.size(); ++i) {
    ASSERT_EQ(std::memcmp(models[0].nodes.record.data(), models[i].nodes.record.data(),
                          models[0].nodes.size() * sizeof(NodeRecord)),
              0);
    EXPECT_EQ(models[0].energy.internal, models[i].energy.internal);
    EXPECT_EQ(models[0].energy.external.half, models[i].energy.external.half);
  }
}

TEST(Step, RemeetsTheEndTimeWithoutASliver) {
  Deck deck = bar(10, 0, hex8());
  deck.time.end = 1.0000001e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  double least = 1;
  run(model, deck, team, [&](Model& m) { least = std::min(least, m.times.next); });
  EXPECT_EQ(model.times.time, deck.time.end);
  EXPECT_GT(least, 0.4 * model.control.first);
}

TEST(Step, ConstantStepAboveTheStableOneIsRefused) {
  Deck deck = bar(10, 0, hex8());
  deck.time.end = 1e-3;
  deck.time.step = 1e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  EXPECT_THROW(run(model, deck, team), Breakdown);
}

TEST(Step, ProbesWatchTheNodesThatAreNearest) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("still", {1, 1, 1}, {2, 2, 2}, {0, 0, 0}, hex8()),
                box("flying", {1, 1, 1}, {2, 2, 2}, {1.2, 0, 0}, hex8())};
  deck.initial_conditions = {moving("flying", {3, -4, 5})};
  deck.time.end = 0.125;
  // 0.6 lies between the two: the nearer one is that of the part on its right.
  deck.output.history.probes = {{"any", {0.61, 0.1, 0.1}, {}}, {"left", {0.61, 0.1, 0.1}, "still"}};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  const std::vector<std::string> columns = history_columns(model);
  std::vector<double> row;
  observe_history(model, row);
  ASSERT_EQ(row.size(), columns.size());
  const auto value = [&](const std::string& column) {
    return row[index(std::find(columns.begin(), columns.end(), column) - columns.begin())];
  };
  EXPECT_NEAR(value("any.displacement_x"), 0.375, 1e-12);
  EXPECT_NEAR(value("any.displacement_z"), 0.625, 1e-12);
  EXPECT_NEAR(value("any.velocity_y"), -4, 1e-12);
  EXPECT_EQ(value("left.displacement_x"), 0);
  EXPECT_EQ(value("left.velocity_z"), 0);
}

TEST(Step, RadialVelocityPointsAwayFromItsAxis) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("bar", {1, 1, 2}, {3, 3, 2}, {0.25, -0.5, 0}, hex8())};
  InitialCondition burst;
  burst.where.set = "bar";
  burst.velocity = {0, 0, 3};
  burst.radial = RadialVelocity{{0.25, -0.5, 7}, {0, 0, -2}, -10};
  deck.initial_conditions = {burst};
  deck.time.end = 1;
  const Model model = build_model(deck);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodeRecord& node = model.nodes.record[i];
    const double x = node.position[0] - 0.25, y = node.position[1] + 0.5, r = std::hypot(x, y);
    EXPECT_NEAR(node.velocity[0], -10 * x / r, 1e-14);
    EXPECT_NEAR(node.velocity[1], -10 * y / r, 1e-14);
    EXPECT_EQ(node.velocity[2], 3);
  }
  std::get<BoxMesh>(deck.parts[0].mesh).elements = {2, 2, 2};
  EXPECT_THROW(build_model(deck), BuildError) << "a node on the axis";
}

TEST(Step, InvertedElementStopsTheRunAndIsNamed) {
  Deck deck = bar(4, 0, hex8());
  deck.time.end = 1e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  // Push one end face through the bar.
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (model.nodes.record[i].position[0] < 0.1) model.nodes.record[i].position[0] = 0.4;
  try {
    run(model, deck, team);
    FAIL() << "an inverted element went unnoticed";
  } catch (const Breakdown& breakdown) {
    EXPECT_NE(std::string(breakdown.what()).find("element 0 of part 'bar'"), std::string::npos)
        << breakdown.what();
  }
}

}  // namespace
}  // namespace brio
