// Particles in whole steps: momenta, energy, rotation, waves, units, threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/core/sweep/particle_scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr ParticleFrame kernels[] = {ParticleFrame::total_lagrangian, ParticleFrame::eulerian};

class Particles : public testing::TestWithParam<ParticleFrame> {
 protected:
  Particle element() const { return particle(GetParam()); }
  bool is_eulerian() const { return GetParam() == ParticleFrame::eulerian; }
};

void expect_kept(const Vector3d& now, const Vector3d& start, double size, double share) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(now[i], start[i], share * size);
}

TEST_P(Particles, FreePlasticBodyKeepsBothMomentaToRounding) {
  const Deck deck = spinning_block(yielding(), element(), 30);
  Model model = build_model(deck);
  const Momentum start = momentum(model.nodes);
  ThreadTeam team(1);
  run(model, deck, team);
  const Momentum end = momentum(model.nodes);
  EXPECT_GT(model.step, 100);
  EXPECT_GT(model.energy.internal, 0.1 * model.energy.kinetic_start);
  expect_kept(end.total.linear, start.total.linear, start.linear_size, 1e-12);
  expect_kept(end.total.angular, start.total.angular, start.angular_size, 1e-12);
}

double energy_error_of_throw(const Material& material, const Particle& particle, double throw_speed,
                             double step_scale) {
  Deck deck = spinning_block(material, particle, throw_speed);
  deck.time.end = 0.04;
  deck.time.step_scale = step_scale;
  Model model = build_model(deck);
  ThreadTeam team(1);
  const double error = largest_energy_error(model, deck, team);
  EXPECT_GT(model.step, 300);
  return error;
}

// The trapezoidal rule of the energy balance is of second order in the time step. A third of the body is
// thrown.
TEST_P(Particles, EnergyErrorIsSmallAndFallsWithTheSquareOfTheStep) {
  for (const auto& [material, particle, speed] :
       {std::tuple{Material(elastic(0.3)), inviscid(element()), 5.0},
        std::tuple{Material(yielding()), element(), 30.0}}) {
    const double whole = energy_error_of_throw(material, particle, speed, 0.9);
    EXPECT_LT(whole, 1e-2);
    EXPECT_LT(energy_error_of_throw(material, particle, speed, 0.3), 0.2 * whole);
  }
}

// Every particle goes round the axis by the given angle a step; F and stress must not see it.
TEST_P(Particles, RigidRotationLeavesNoStress) {
  const Deck deck = spinning_block(elastic(0.3), element(), 0);
  Model model = build_model(deck);
  Block& block = model.blocks[0];
  const double angle = 0.1;
  const int steps = 6283;  // a hundred turns
  for (int step = 0; step < steps; ++step) {
    for (NodeRecord& record : model.nodes.record) {
      const double x = record.position[0], y = record.position[1];
      record.position[0] = std::cos(angle) * x - std::sin(angle) * y;
      record.position[1] = std::sin(angle) * x + std::cos(angle) * y;
      record.velocity[0] = record.position[0] - x;
      record.velocity[1] = record.position[1] - y;
      record.velocity[2] = 0;
    }
    for (const SweepTask& sweep : model.schedule.tasks)
      block.kernel.sweep(block, sweep.chunk, model.nodes, 1.0);
  }
  for (std::size_t e = 0; e < block.element_count; ++e) {
    const SymmetricTensor<double> s = block.kernel.sample(block, model.nodes, e, true).stress;
    for (const double component : {s.xx, s.yy, s.zz, s.xy, s.yz, s.xz})
      ASSERT_NEAR(component, 0, 1e-9 * 1e9) << e;
  }
}

/// Arrival at the middle of a wave that is thrown into a bar in uniaxial strain.
TEST_P(Particles, ElasticWaveHasItsSpeed) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  const double spacing = 0.025, length = 2;
  deck.parts = {particles("bar", box_of_particles({length, 0.1, 0.1}, spacing), element())};
  PrescribedMotion sides = fix("bar.all", {1, 2});
  PrescribedMotion push;
  push.where.set = "bar.xmin";
  push.components = {{0, Curve{{{0, 1}}}}};
  deck.boundary_conditions = {sides, push};
  const double nu = 0.3;
  const double speed = std::sqrt((1 - nu) / ((1 + nu) * (1 - 2 * nu))) * 1000;
  deck.time.end = 1.6 / speed;
  Model model = build_model(deck);
  ThreadTeam team(1);
  // The front passes a place when half of the speed is reached there.
  const std::array<double, 2> place{-0.5, 0.5};
  std::array<double, 2> arrival{};
  run(model, deck, team, [&](Model& m) {
    for (std::size_t p = 0; p < 2; ++p) {
      if (arrival[p] > 0) continue;
      double fastest = 0;
      for (const NodeRecord& record : m.nodes.record)
        if (std::abs(record.position[0] - place[p]) < 0.5 * spacing)
          fastest = std::max(fastest, record.velocity[0]);
      if (fastest > 0.5) arrival[p] = m.times.time;
    }
  });
  ASSERT_GT(arrival[1], 0);
  EXPECT_NEAR((place[1] - place[0]) / (arrival[1] - arrival[0]), speed, 0.02 * speed);
  // Behind the front stress is -rho c v.
  const Block& block = model.blocks[0];
  double stress = 0;
  int count = 0;
  for (std::size_t e = 0; e < block.element_count; ++e)
    if (std::abs(model.nodes.record[index(block.node(e, 0))].position[0]) < 0.2) {
      stress += block.kernel.sample(block, model.nodes, e, true).stress.xx;
      ++count;
    }
  EXPECT_NEAR(stress / count, -1000 * speed, 0.02 * 1000 * speed);
}

TEST_P(Particles, PowersOfTwoInLengthTimeAndMassGiveTheSameBits) {
  struct Units {
    double length, time, mass;
  };
  const auto in_units = [this](const Units& u) {
    ElasticPlastic law = yielding();
    law.density *= u.mass / (u.length * u.length * u.length);
    for (double* stress : {&law.youngs_modulus, &law.yield_stress, &law.hardening_modulus})
      *stress *= u.mass / (u.length * u.time * u.time);
    Deck deck = spinning_block(law, element(), 0);
    deck.parts[0].mesh = box_of_particles({1 * u.length, 0.75 * u.length, 0.5 * u.length}, 0.125 * u.length);
    InitialCondition& turning = deck.initial_conditions[0];
    for (std::size_t i = 0; i < 3; ++i) {
      turning.velocity[i] *= u.length / u.time;
      turning.spin->angular_velocity[i] *= 20 / u.time;
    }
    deck.time.end = 0.005 * u.time;
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    return model;
  };
  const Model reference = in_units({1, 1, 1});
  EXPECT_GT(reference.energy.internal, 0);
  for (const Units& u : {Units{1024, 1, 1}, Units{1, 0.0078125, 1}, Units{1, 1, 4096},
                         Units{0.0009765625, 0.125, 0.00048828125}}) {
    const Model other = in_units(u);
    ASSERT_EQ(reference.step, other.step);
    for (std::size_t i = 0; i < reference.nodes.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        ASSERT_EQ(reference.nodes.record[i].position[axis] * u.length, other.nodes.record[i].position[axis])
            << i;
    EXPECT_EQ(reference.energy.internal * u.mass * u.length * u.length / (u.time * u.time),
              other.energy.internal);
  }
}

TEST_P(Particles, AnyNumberOfThreadsGivesTheSameBits) {
  Deck deck = spinning_block(yielding(), element(), 30);
  deck.parts[0].mesh = box_of_particles({1, 0.75, 0.5}, 0.0625);
  deck.time.end = 0.003;
  Model reference;
  for (const int threads : {1, 2, 4}) {
    Model model = build_model(deck);
    ThreadTeam team(threads);
    run(model, deck, team);
    if (threads == 1) {
      reference = std::move(model);
      continue;
    }
    ASSERT_EQ(reference.step, model.step);
    for (std::size_t i = 0; i < reference.nodes.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        ASSERT_EQ(reference.nodes.record[i].position[axis], model.nodes.record[i].position[axis]);
    EXPECT_EQ(reference.energy.internal, model.energy.internal);
  }
}

// The block thrown along x, and its image in the plane x = 0.
TEST_P(Particles, MirrorImageMovesAsAMirrorImage) {
  Deck deck = spinning_block(yielding(), element(), 0);
  deck.initial_conditions = {moving("block", {40, 3, 1})};
  RigidWall wall;
  wall.point = {0.5, 0, 0};
  wall.normal = {-1, 0, 0};
  deck.boundary_conditions = {wall};
  Deck image = deck;
  image.initial_conditions[0].velocity[0] *= -1;
  wall.point[0] *= -1;
  wall.normal[0] *= -1;
  image.boundary_conditions = {wall};
  Model a = build_model(deck), b = build_model(image);
  ThreadTeam team(1);
  run(a, deck, team);
  run(b, image, team);
  EXPECT_GT(a.energy.internal, 0.1 * a.energy.kinetic_start);
  const auto matches = [&](const NodeRecord& p, const NodeRecord& q) {
    return std::abs(p.position[0] + q.position[0]) < 1e-9 && std::abs(p.position[1] - q.position[1]) < 1e-9 &&
           std::abs(p.position[2] - q.position[2]) < 1e-9;
  };
  for (const NodeRecord& p : a.nodes.record)
    EXPECT_TRUE(std::any_of(b.nodes.record.begin(), b.nodes.record.end(),
                            [&](const NodeRecord& q) { return matches(p, q); }));
}

// The whole of the stable step may be used; a tenth more feeds the fastest motions.
TEST_P(Particles, StableStepIsStableAndNotMuchBelowTheLimit) {
  const auto largest_kinetic_energy = [this](double scale) {
    Deck deck = spinning_block(elastic(0.3), inviscid(element()), 0);
    deck.initial_conditions = {moving("block", {1e-3, 0, 0})};
    deck.initial_conditions[0].where = {"", BoxRegion{{0.4, 0.3, 0.1}, {1, 1, 1}}, "block"};
    deck.time.end = 1;
    deck.numerics.energy_error_limit = 1e30;
    Model model = build_model(deck);
    ThreadTeam team(1);
    const double start = model.energy.kinetic_start;
    double largest = 0;
    run(model, deck.numerics.energy_error_limit, team, [&](Model& now) {
      now.times.next = scale * now.control.stable;
      largest = std::max(largest, now.energy.kinetic_half);
      return largest <= 1e6 * start && now.step < 2000;
    });
    return largest / start;
  };
  EXPECT_LE(largest_kinetic_energy(0.9), 1.5);
  EXPECT_LE(largest_kinetic_energy(1.0), 5);
  if (is_eulerian()) return;
  EXPECT_GT(largest_kinetic_energy(1.05), 1e6);
}

TEST_P(Particles, RigidWallSupportAndLoadsBalanceEnergyAndMomentum) {
  Deck deck = spinning_block(yielding(), element(), 0);
  deck.initial_conditions = {moving("block", {0, 0, -20})};
  RigidWall wall;
  wall.point = {0, 0, -0.26};
  wall.normal = {0, 0, 1};
  wall.friction = 0.2;
  PrescribedMotion held = fix("block.xmin", {0});
  Gravity gravity;
  gravity.acceleration = {100, 0, -500};
  NodalForce pull;
  pull.where.set = "block.xmax";
  pull.force = {2e3, 0, 0};
  deck.boundary_conditions = {wall, held};
  deck.loads = {gravity, pull};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team, [](Model& m) {
    const Momentum now = momentum(m.nodes);
    m.momentum.now = now.total;
    m.momentum.linear_scale = std::max(m.momentum.linear_scale, now.linear_size);
    m.momentum.angular_scale = std::max(m.momentum.angular_scale, now.angular_size);
    EXPECT_LT(m.momentum.linear_imbalance(), 1e-12);
    EXPECT_LT(m.momentum.angular_imbalance(), 1e-11);
  });
  EXPECT_GT(model.energy.internal, 0.1 * model.energy.kinetic_start);
  EXPECT_LT(model.energy.error_max, 5e-3);
}

TEST_P(Particles, StepAllocatesNothing) {
  const Deck deck = spinning_block(yielding(), element(), 30);
  for (const int threads : {1, 2}) {
    Model model = build_model(deck);
    ThreadTeam team(threads);
    make_steps(model, 3, deck.numerics.energy_error_limit, team);
    const AllocationCount allocations;
    make_steps(model, 50, deck.numerics.energy_error_limit, team);
    EXPECT_EQ(allocations.count(), 0u) << threads;
  }
}

TEST_P(Particles, MassIsThatOfTheShape) {
  ParticleMesh ring, ball;
  ring.cylinder = ParticleCylinder{0.04, 0.01, 0.002, 0.03};
  ball.sphere = ParticleSphere{0.5, 0.09};
  for (const auto& [mesh, volume] : {std::pair{ring, 3.14159265358979 * 7e-4 * 0.01},
                                     std::pair{ball, 4.0 / 3 * 3.14159265358979 * 0.125}}) {
    Deck deck;
    deck.materials = {{"material", elastic()}};
    deck.parts = {particles("part", mesh, element())};
    deck.time.end = 1e-6;
    EXPECT_NEAR(build_model(deck).parts[0].mass, 1000 * volume, 1e-12 * 1000 * volume);
  }
}

// A bar whose halves move apart is separated by deletion; mass, momentum and energy balance.
TEST_P(Particles, TornBarBalancesMassMomentumAndEnergy) {
  ElasticPlastic law = yielding();
  law.failure = Failure{};
  law.failure->strain = 0.1;
  law.failure->opening_strain = 0.02;
  Deck deck;
  deck.materials = {{"material", law}};
  deck.parts = {particles("bar", box_of_particles({2, 0.5, 0.5}, 0.125), element())};
  InitialCondition left = moving("", {-30, 0, 0}), right = moving("", {30, 0, 0});
  left.where = {"", BoxRegion{{-2, -1, -1}, {0, 1, 1}}, "bar"};
  right.where = {"", BoxRegion{{0, -1, -1}, {2, 1, 1}}, "bar"};
  deck.initial_conditions = {left, right};
  deck.time.end = 0.03;
  Model model = build_model(deck);
  const Momentum start = momentum(model.nodes);
  ThreadTeam team(2);
  const double energy_error = largest_energy_error(model, deck, team);
  ASSERT_TRUE(model.erosion);
  EXPECT_GT(model.erosion->total_deleted(), 15);
  EXPECT_LT(model.erosion->total_deleted(), 120);
  const Momentum end = momentum(model.nodes);
  expect_kept(end.total.linear, start.total.linear, start.linear_size, 1e-12);
  expect_kept(end.total.angular, start.total.angular, start.angular_size, 1e-12);
  EXPECT_LT(energy_error, 1e-2);
  // The ends are apart.
  EXPECT_GT(mean_velocity(model, 0, 0), -1e-9);
  double gap = 0;
  std::vector<double> x;
  for (const NodeRecord& record : model.nodes.record) x.push_back(record.position[0]);
  std::sort(x.begin(), x.end());
  for (std::size_t i = 1; i < x.size(); ++i) gap = std::max(gap, x[i] - x[i - 1]);
  EXPECT_GT(gap, 0.15);
}

TEST_P(Particles, RefusesSinglePrecision) {
  Deck deck = spinning_block(elastic(), element(), 0);
  deck.numerics.precision = Precision::single_precision;
  EXPECT_THROW(build_model(deck), BuildError);
}

INSTANTIATE_TEST_SUITE_P(Kernel, Particles, testing::ValuesIn(kernels), [](const auto& kernel) {
  return std::string(named_values(kernel.param)[index(kernel.param)].word);
});

}  // namespace
}  // namespace brio
