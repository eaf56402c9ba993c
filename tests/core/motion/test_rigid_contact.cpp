// Rigid bodies in contact: with deformable parts, with each other, with friction.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "src/base/index.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;
using std::numbers::pi;

Momentum momentum_with_rigid(const Model& model) {
  Momentum sum = momentum(model.nodes);
  add_momentum(model.rigid, sum);
  return sum;
}

struct Imbalance {
  double linear = 0, angular = 0;
};
Imbalance imbalance(const Model& model) {
  const Momentum now = momentum_with_rigid(model);
  Imbalance worst;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto miss = [&](Vector3d Impulse::*kind) {
      return std::abs((now.total.*kind)[i] - (model.momentum.start.*kind)[i] -
                      (model.momentum.supports.*kind)[i] - (model.momentum.loads.*kind)[i]);
    };
    worst.linear = std::max(worst.linear, miss(&Impulse::linear) / now.linear_size);
    worst.angular = std::max(worst.angular, miss(&Impulse::angular) / now.angular_size);
  }
  return worst;
}

// A spinning rigid box meets a deformable one askew, in units, with friction.
struct Units {
  double length = 1, time = 1, mass = 1;
};
Deck askew(const Units& units = {}) {
  const double speed = units.length / units.time;
  Elastic law = elastic(0.3);
  law.density *= units.mass / (units.length * units.length * units.length);
  law.youngs_modulus *= units.mass / (units.length * units.time * units.time);
  const auto scaled = [](const Vector3d& v, double factor) {
    return Vector3d{v[0] * factor, v[1] * factor, v[2] * factor};
  };
  Deck deck;
  deck.materials = {{"material", law}};
  deck.parts = {box("soft", scaled({0.5, 0.25, 0.25}, units.length), {8, 4, 4},
                    scaled({-0.26, 0, 0}, units.length), hex8()),
                box("hard", scaled({0.25, 0.5, 0.25}, units.length), {2, 4, 2},
                    scaled({0.16, 0.1, 0.05}, units.length), Rigid{})};
  deck.parts[1].placement.rotate = Rotation{{0, 0, 1}, 10};
  InitialCondition hard = moving("hard", scaled({-10, 2, 1}, speed));
  hard.spin = Spin{scaled({0.16, 0.1, 0.05}, units.length), scaled({8, -5, 20}, 1 / units.time)};
  deck.initial_conditions = {moving("soft", scaled({10, 0, 0}, speed)), hard};
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 8e-3 * units.time;
  return deck;
}

TEST(RigidContact, KeepsMomentumToRoundingAndEnergy) {
  const Deck deck = askew();
  Model model = build_model(deck);
  ThreadTeam team(1);
  int active = 0;
  Imbalance worst;
  run(model, deck, team, [&](Model& m) {
    active += m.contacts[0].step.active;
    const Imbalance now = imbalance(m);
    worst = {std::max(worst.linear, now.linear), std::max(worst.angular, now.angular)};
  });
  EXPECT_GT(active, 100);
  EXPECT_LT(model.energy.friction.at_step(), 0);
  EXPECT_LE(worst.linear, 1e-13);
  EXPECT_LE(worst.angular, 1e-13);
  EXPECT_LE(model.energy.error_max, 1e-3);
  EXPECT_LE(model.energy.contact_added_max, 1e-3 * model.energy.kinetic_start);
  EXPECT_GT(std::abs(model.rigid.motion[0].angular_velocity[2] - 20), 1) << "it was hit beside its centre";
}

TEST(RigidContact, BitsDoNotDependOnTheNumberOfThreads) {
  const Deck deck = askew();
  std::vector<Model> models;
  for (int threads : {1, 2, 4}) {
    models.push_back(build_model(deck));
    ThreadTeam team(threads);
    run(models.back(), deck, team);
  }
  for (std::size_t i = 1; i < models.size(); ++i)
    ASSERT_EQ(std::memcmp(models[0].nodes.record.data(), models[i].nodes.record.data(),
                          models[0].nodes.size() * sizeof(NodeRecord)),
              0);
}

TEST(RigidContact, PowersOfTwoInLengthTimeAndMassGiveTheSameBits) {
  const auto end_of = [](const Units& units) {
    const Deck deck = askew(units);
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    return model;
  };
  const Model reference = end_of({});
  for (const Units& units : {Units{1024, 1, 1}, Units{0.0009765625, 0.125, 0.00048828125}}) {
    const Model other = end_of(units);
    ASSERT_EQ(reference.step, other.step);
    for (std::size_t i = 0; i < reference.nodes.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        ASSERT_EQ(reference.nodes.record[i].position[axis] * units.length,
                  other.nodes.record[i].position[axis]);
  }
}

TEST(RigidContact, AllocatesNothingInTheStep) {
  Deck deck = askew();
  RigidWall wall;
  wall.normal = {0, 0, 1};
  wall.point = {0, 0, -0.22};
  wall.friction = 0.2;
  deck.boundary_conditions = {wall};
  for (Vector3d* velocity : {&deck.initial_conditions[0].velocity, &deck.initial_conditions[1].velocity})
    (*velocity)[2] = -10;
  Model model = build_model(deck);
  ThreadTeam team(2);
  const auto advance = [&](int steps) { make_steps(model, steps, deck.numerics.energy_error_limit, team); };
  const Model start = model;
  advance(100);
  model.step = start.step;
  model.times = start.times;
  model.nodes = start.nodes;
  model.blocks = start.blocks;
  model.energy = start.energy;
  model.rigid = start.rigid;
  advance(10);
  std::size_t allocated = 0;  // in steps without a search
  int active = 0;
  for (int step = 10; step < 100; ++step) {
    const AllocationCount allocations;
    advance(1);
    if (!model.contacts[0].step.searched) allocated += allocations.count();
    active += model.contacts[0].step.active;
  }
  EXPECT_EQ(allocated, 0u);
  EXPECT_GT(active, 0);
}

// ---- bar on a heavy rigid block, against bar on a wall

struct Rebound {
  double speed = 0;
  double parted_at = 0;
};

Deck bar_along_x(int across) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("bar", {1, 0.05, 0.05}, {20, across, across}, {0.5, 0, 0}, hex8())};
  deck.initial_conditions = {moving("bar", {-1, 0, 0})};
  deck.time.end = 3e-3;
  return deck;
}

TEST(BarOnAHeavyRigidBlock, ReboundsAsFromAWall) {
  for (const std::array<int, 2>& mesh : {std::array{2, 2}, std::array{2, 3}, std::array{4, 1}}) {
    SCOPED_TRACE(testing::Message() << mesh[0] << " and " << mesh[1]);
    Deck on_wall = bar_along_x(mesh[0]);
    RigidWall wall;
    wall.normal = {1, 0, 0};
    on_wall.boundary_conditions = {wall};
    Model reference = build_model(on_wall);
    ThreadTeam team(1);
    Rebound expected;
    Vector3d last{};
    run(reference, on_wall, team, [&](Model& m) {
      if (m.momentum.walls.linear != last) expected.parted_at = m.times.time;
      last = m.momentum.walls.linear;
    });
    expected.speed = mean_velocity(reference, 0, 0);

    Deck on_block = bar_along_x(mesh[0]);
    Rigid heavy;
    heavy.mass = 1e9;
    on_block.parts.push_back(box("block", {0.1, 0.1, 0.1}, {1, mesh[1], mesh[1]}, {-0.05, 0, 0}, heavy));
    on_block.contact.emplace();
    Model model = build_model(on_block);
    Rebound found;
    run(model, on_block, team, [&](Model& m) {
      if (m.contacts[0].step.active > 0) found.parted_at = m.times.time;
    });
    found.speed = mean_velocity(model, 0, 0);
    EXPECT_GT(expected.speed, 0.92);
    EXPECT_NEAR(found.speed, expected.speed, 2e-3);
    EXPECT_NEAR(found.parted_at, expected.parted_at, 0.02 * 2e-3);
    // The block has what the bar has lost.
    EXPECT_NEAR(model.rigid.motion[0].velocity[0] * 1e9, -model.parts[0].mass * (1 + found.speed), 1e-9);
  }
}

// A heavy rigid block on a light elastic bar is a mass on a spring: half a period of contact, full rebound.
TEST(RigidBlockOnALightBar, BouncesAsAMassOnASpring) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("bar", {0.1, 0.1, 1}, {2, 2, 20}, {0, 0, 0.5}, hex8())};
  Rigid heavy;
  heavy.mass = 1e4;  // 1000 times the bar
  deck.parts.push_back(box("block", {0.2, 0.2, 0.2}, {2, 2, 2}, {0, 0, 1.1}, heavy));
  deck.boundary_conditions = {fix("bar.zmin", {0, 1, 2})};
  deck.initial_conditions = {moving("block", {0, 0, -0.1})};
  deck.contact.emplace();
  // Rayleigh: a third of the bar swings along.
  const double stiffness = 1e9 * 0.01 / 1;
  const double half_period = pi * std::sqrt((1e4 + 10.0 / 3) / stiffness);
  deck.time.end = 1.3 * half_period;
  Model model = build_model(deck);
  ThreadTeam team(1);
  double first = 0, last = 0;
  run(model, deck, team, [&](Model& m) {
    if (m.contacts[0].step.active == 0) return;
    if (first == 0) first = m.times.time;
    last = m.times.time;
  });
  EXPECT_NEAR(last - first, half_period, 0.01 * half_period);
  EXPECT_NEAR(model.rigid.motion[0].velocity[2], 0.1, 0.003);
  EXPECT_LE(model.energy.error_max, 1e-5);
}

// ---- spin from a hit beside the centre

TEST(RigidPlate, HitBesideItsCentreSpinsByTheMomentOfTheImpulse) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("ball", {0.25, 0.25, 0.25}, {4, 4, 4}, {1, 0, 0.125 + 1e-4}, hex8()),
                box("plate", {4, 1, 0.5}, {8, 2, 1}, {0, 0, -0.25}, Rigid{})};
  deck.initial_conditions = {moving("ball", {0, 0, -2})};
  deck.contact.emplace();
  deck.time.end = 5e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  // Both begin a skin smaller than they are drawn.
  const double mass = model.parts[1].mass, inertia = mass * (16 + 0.25) / 12;
  EXPECT_NEAR(mass, 2000, 1);
  const double impulse = model.parts[0].mass * (mean_velocity(model, 0, 2) + 2);
  EXPECT_GT(impulse, 1000 * 0.015625 * 2);
  const RigidMotion& plate = model.rigid.motion[0];
  EXPECT_NEAR(plate.velocity[2], -impulse / mass, 1e-10);
  // The block touches from 0.875 to 1.125 about 1; the plate turns by 1e-5 meanwhile.
  EXPECT_NEAR(plate.angular_velocity[1], impulse * 1 / inertia, 1e-3 * impulse / inertia);
  EXPECT_LE(std::abs(plate.angular_velocity[0]), 1e-3 * impulse / inertia);
  EXPECT_LE(imbalance(model).angular, 1e-13);
}

// ---- friction

double sliding_distance(const Element& block, const Element& floor, double speed) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 1, 0.5}, {4, 4, 2}, {0, 0, 0.25}, block),
                box("floor", {3, 2, 0.25}, {11, 7, 1}, {0.5, 0, -0.125}, floor)};
  deck.boundary_conditions = {fix("floor", {0, 1, 2, 3, 4, 5})};
  if (!std::holds_alternative<Rigid>(floor)) deck.boundary_conditions = {fix("floor.zmin", {0, 1, 2})};
  deck.initial_conditions = {moving("block", {speed, 0, 0})};
  Gravity gravity;
  gravity.acceleration = {0, 0, -100};
  deck.loads = {gravity};
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 0.2;
  if (std::holds_alternative<Rigid>(block) && std::holds_alternative<Rigid>(floor)) deck.time.step = 1e-4;
  Model model = build_model(deck);
  const double start = model.nodes.record[index(model.parts[0].node[0])].position[0];
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_LE(model.energy.error_max, 1e-4);
  return model.nodes.record[index(model.parts[0].node[0])].position[0] - start;
}

TEST(RigidSlidingBlock, StopsAfterTheDistanceOfCoulomb) {
  for (double speed : {4., 5.}) {
    const double distance = speed * speed / (2 * 0.3 * 100);
    EXPECT_NEAR(sliding_distance(Rigid{}, hex8(), speed), distance, 0.01 * distance) << speed;
    EXPECT_NEAR(sliding_distance(hex8(), Rigid{}, speed), distance, 0.01 * distance) << speed;
    EXPECT_NEAR(sliding_distance(Rigid{}, Rigid{}, speed), distance, 0.01 * distance) << speed;
  }
}

// ---- prescribed blade, shells

// Drives a blade into a block, as a rigid part or as a deformable one with all of its nodes driven.
Model drive_blade(const Element& element) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {0.5, 0.5, 0.5}, {4, 4, 4}, {0, 0, 0}, hex8()),
                box("blade", {0.2, 0.3, 0.3}, {1, 1, 1}, {-0.35 - 1e-3, 0.02, 0.01}, element)};
  PrescribedMotion drive;
  drive.where.set = "blade";
  drive.kind = MotionKind::velocity;
  drive.components = {{0, Curve{{{0, 3}}}}};
  deck.boundary_conditions = {fix("blade", {1, 2, 3, 4, 5}), drive};
  deck.contact.emplace();
  deck.time.end = 1e-2;
  deck.time.step_bound = StepBound::elements;  // alike with and without elements of the blade
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  return model;
}

TEST(PrescribedBlade, PushesLikeADrivenPartAndItsSupportPays) {
  const Model model = drive_blade(Rigid{});
  EXPECT_NEAR(model.rigid.body[0].centre[0], -0.351 + 3e-2, 1e-12);
  EXPECT_GT(mean_velocity(model, 0, 0), 3);
  EXPECT_LE(imbalance(model).linear, 1e-12);
  EXPECT_LE(imbalance(model).angular, 1e-12);
  const Model driven = drive_blade(hex8());
  ASSERT_EQ(model.step, driven.step);
  const double energy = driven.energy.kinetic;
  EXPECT_NEAR(mean_velocity(model, 0, 0), mean_velocity(driven, 0, 0), 1e-9);
  EXPECT_NEAR(model.energy.kinetic, energy, 1e-9 * energy);
  EXPECT_NEAR(model.energy.contact.at_step(), driven.energy.contact.at_step(), 1e-9 * energy);
  EXPECT_NEAR(model.energy.external.at_step(), driven.energy.external.at_step(), 1e-9 * energy);
  EXPECT_NEAR(model.energy.relative_error(), driven.energy.relative_error(), 1e-9);
}

TEST(RigidShell, HoldsABlockAtHalfItsThickness) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Rigid sheet;
  sheet.thickness = 0.04;
  deck.parts = {box("block", {0.5, 0.5, 0.25}, {3, 3, 2}, {0.01, 0, 0.1451}, hex8()),
                {"sheet", PlateMesh{{1, 1}, {4, 4}}, {}, sheet, "material"}};
  deck.boundary_conditions = {fix("sheet", {0, 1, 2, 3, 4, 5})};
  deck.initial_conditions = {moving("block", {0, 0, -0.5})};
  deck.contact.emplace();
  deck.contact->options.audit = true;
  deck.time.end = 3e-3;
  Model model = build_model(deck);
  EXPECT_NEAR(model.parts[1].mass, 40, 1e-12);
  ThreadTeam team(1);
  double lowest = 1;
  run(model, deck, team, [&](Model& m) {
    for (int node : m.parts[0].node) lowest = std::min(lowest, m.nodes.record[index(node)].position[2]);
  });
  audit_contacts(model, team);
  EXPECT_NEAR(lowest, 0.02 + model.contacts[0].features.skin, 1e-5);
  EXPECT_GT(mean_velocity(model, 0, 2), 0.2);
  ASSERT_TRUE(model.contact_audits);
  EXPECT_EQ(model.contact_audits->found.missed(), 0);
}

// The faces of a rigid body never meet its own nodes, however they lie.
TEST(RigidContact, ABodyDoesNotTouchItself) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Rigid sheet;
  sheet.thickness = 0.5;  // more than the radius
  deck.parts = {{"roll", CylinderMesh{0.2, 1, {12, 4}}, {}, sheet, "material"},
                box("other", {1, 1, 1}, {1, 1, 1}, {5, 0, 0}, hex8())};
  deck.initial_conditions = {moving("roll", {1, 0, 0})};
  deck.contact.emplace();
  deck.contact->options.audit = true;
  deck.time.end = 1e-2;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team, [](Model& m) { EXPECT_EQ(m.contacts[0].step.contacts, 0); });
  audit_contacts(model, team);
  ASSERT_TRUE(model.contact_audits);
  EXPECT_EQ(model.contact_audits->found.missed(), 0);
}

}  // namespace
}  // namespace brio
