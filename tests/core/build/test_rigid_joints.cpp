// Parts that deform, joined to rigid parts by shared nodes or by ties.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "src/output/result_order.hpp"
#include "tests/core/build/tied_scene.hpp"

namespace brio {
namespace {

using namespace test;

enum class Joint { merged, tied };

Connection joint_of(Joint joint, std::string nodes, std::string rigid) {
  if (joint == Joint::merged) return Merge{{std::move(rigid), std::move(nodes)}, 1e-6, "deck.yaml:3:5"};
  return tied(std::move(nodes), std::move(rigid));
}

/// A spring of one element, 1e9 and masses of 500 at both ends, with a rigid mass of 1000 on one.
Deck loaded_spring(Joint joint, double velocity) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("spring", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, inviscid_hex8()),
                box("mass", {1, 1, 1}, {1, 1, 1}, {1, 0, 0}, Rigid{})};
  deck.connections = {joint_of(joint, "spring", "mass")};
  deck.boundary_conditions = {fix("spring.xmin", {0, 1, 2}), fix("mass", {1, 2, 3, 4, 5})};
  InitialCondition moves = moving("spring.xmax", {velocity, 0, 0});
  deck.initial_conditions = {moving("mass", {velocity, 0, 0}), moves};
  deck.time.step = 1e-6;
  return deck;
}

TEST(RigidJoints, AMassOnASpringOscillatesAsTheClosedFormSays) {
  const double velocity = 0.01, frequency = std::sqrt(1e9 / 1500);
  for (const Joint joint : {Joint::merged, Joint::tied}) {
    Deck deck = loaded_spring(joint, velocity);
    deck.time.end = 12 / frequency;
    Model model = build_model(deck);
    EXPECT_EQ(model.rigid.body[0].joint.size(), 4u);
    EXPECT_NEAR(model.rigid.body[0].mass, 1500, 1e-9);
    EXPECT_NEAR(model.parts[0].mass + model.parts[1].mass, 2000, 1e-9);
    ThreadTeam team(1);
    const double start = model.rigid.body[0].centre[0];
    double error = 0;
    run(model, deck, team, [&](Model& m) {
      const double exact = velocity / frequency * std::sin(frequency * m.times.time);
      error = std::max(error, std::abs(m.rigid.body[0].centre[0] - start - exact));
    });
    EXPECT_LE(error, 5e-5 * velocity / frequency);  // strains of 1e-5
    EXPECT_LE(model.energy.error_max, 1e-5);
    EXPECT_NEAR(model.energy.kinetic_start, 0.5 * 1500 * velocity * velocity, 1e-12);
  }
}

/// A soft bar with a rigid block at its end, thrown and spinning.
Deck thrown_hammer(Joint joint, bool contact) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("handle", {0.5, 0.5, 3}, {2, 2, 12}, {0, 0, 0}, hex8()),
                box("head", {1, 1, 1}, {2, 2, 2}, {0, 0, 2}, Rigid{})};
  deck.connections = {joint == Joint::merged ? Connection(Merge{{"head", "handle"}, 1e-6, ""})
                                             : Connection(tied("handle.zmax", "head"))};
  if (joint == Joint::merged) deck.parts[1] = box("head", {0.5, 0.5, 1}, {2, 2, 2}, {0, 0, 2}, Rigid{});
  for (const char* part : {"handle", "head"}) {
    InitialCondition condition = moving(part, {3, 2, 1});
    condition.spin = Spin{{0, 0, 1}, {12, -5, 20}};
    deck.initial_conditions.push_back(condition);
  }
  if (contact) deck.contact.emplace();
  deck.time.end = 0.2;
  return deck;
}

TEST(RigidJoints, ConserveMomentumAndEnergyInFlight) {
  for (const Joint joint : {Joint::merged, Joint::tied})
    for (const bool contact : {false, true}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(joint)) + (contact ? " contact" : ""));
      const Deck deck = thrown_hammer(joint, contact);
      Model model = build_model(deck);
      const RigidBody& head = model.rigid.body[0];
      ThreadTeam team(1);
      const double energy = model.energy.kinetic_start;
      double farthest = 0;
      run(model, deck, team, [&](Model& m) {
        balance_momentum(m, momentum(m.nodes));
        ASSERT_LE(m.momentum.linear_imbalance(), 1e-12);
        ASSERT_LE(m.momentum.angular_imbalance(), 1e-12);
        const Tensor<double> turn = rotation_matrix(head.attitude);
        for (const std::size_t i : head.joint) {
          const Vector3d x = vector_at(m.nodes.record[index(head.node[i])].position);
          farthest = std::max(farthest, norm(x - head.centre - turn * head.arm[i]));
        }
      });
      EXPECT_LE(farthest, 1e-14);
      EXPECT_GT(2 * std::acos(std::abs(head.attitude.w)), 0.5);
      EXPECT_LE(model.energy.error_max, 2e-3);
      EXPECT_LE(std::abs(model.energy.internal), 0.1 * energy);
      EXPECT_EQ(observe_end(model).contact.last_resort_uses, 0);
    }
}

// Nodes of elements that go round with a rigid part strain by nothing but the centrifugal force, whatever the
// time step is.
TEST(RigidJoints, TurningAddsNoStrain) {
  std::vector<double> energies;
  for (const double step : {2e-5, 5e-6}) {
    Deck deck;
    deck.materials = {{"material", elastic(0)}};
    deck.parts = {box("hub", {0.5, 0.5, 0.5}, {1, 1, 1}, {0, 0, 0}, Rigid{}),
                  box("blade", {0.5, 0.5, 0.5}, {1, 1, 1}, {0.5, 0, 0}, hex8())};
    deck.connections = {Merge{{"hub", "blade"}, 1e-6, ""}};
    PrescribedMotion turning;
    turning.where.set = "hub";
    turning.components = {{5, Curve{{{0, 0}, {0.3, 60}}}}};
    deck.boundary_conditions = {fix("hub", {0, 1, 2, 3, 4}), turning};
    deck.time.end = 0.6;
    deck.time.step = step;
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    EXPECT_GT(model.times.time * 60, 20);  // radians
    energies.push_back(model.energy.internal + model.energy.hourglass);
  }
  // The outer half of its mass, 62.5, at its radius, 0.75: F = 62.5 w^2 0.75, energy F^2 / 2k, k = EA/L.
  const double force = 62.5 * 60 * 60 * 0.75;
  EXPECT_NEAR(energies[1], force * force / (2 * 0.5e9), 0.02 * energies[1]);
  EXPECT_NEAR(energies[0], energies[1], 0.01 * energies[1]);
}

// A shell that shares its edge with a rigid part that stands is a shell whose edge is clamped.
TEST(RigidJoints, AShellIsClampedToARigidPart) {
  const auto strip = [](bool by_rigid) {
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {plate("strip", {1, 0.2}, {10, 2}, {0, 0, 0}, 0.02)};
    std::vector<int> all{0, 1, 2, 3, 4, 5};
    if (by_rigid) {
      Rigid rigid;
      rigid.thickness = 0.02;
      deck.parts.push_back({"wall", PlateMesh{{0.2, 0.2}, {2, 2}}, {}, rigid, "material"});
      deck.parts[1].placement.translate = {-0.6, 0, 0};
      deck.connections = {Merge{{"wall", "strip"}, 1e-6, ""}};
      deck.boundary_conditions = {fix("wall", all)};
    } else {
      deck.boundary_conditions = {fix("strip.xmin", all)};
    }
    NodalForce force;
    force.where.set = "strip.xmax";
    force.force = {0, 0, 1};
    deck.loads = {force};
    deck.time.end = 0.05;
    deck.time.step_bound = StepBound::elements;  // that of the joined one
    return deck;
  };
  std::vector<double> heights;
  for (const bool by_rigid : {false, true}) {
    const Deck deck = strip(by_rigid);
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    double highest = 0;
    for (const NodeRecord& record : model.nodes.record) highest = std::max(highest, record.position[2]);
    heights.push_back(highest);
    EXPECT_LE(model.energy.error_max, 1e-3);
  }
  EXPECT_GT(heights[0], 1e-3);
  EXPECT_NEAR(heights[1], heights[0], 1e-9 * heights[0]);
}

/// A hammer hits the pad that a rigid block carries, from above or, on joined nodes, from the side.
Deck struck_pad(Joint joint, bool excluded, bool from_side) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  const Vector3d place = from_side ? Vector3d{0.75, 0.1, 0.3} : Vector3d{0.3, 0.1, 0.7};
  deck.parts = {box("block", {1, 1, 0.5}, {2, 2, 1}, {0, 0, 0}, Rigid{}),
                box("pad", {1, 1, 0.25}, {joint == Joint::merged ? 2 : 3, 2, 1}, {0, 0, 0.375}, hex8()),
                box("hammer", {0.3, 0.3, 0.3}, {2, 2, 2}, place, hex8())};
  deck.connections = {joint == Joint::merged ? Connection(Merge{{"block", "pad"}, 1e-6, ""})
                                             : Connection(tied("pad.zmin", "block"))};
  deck.initial_conditions = {moving("hammer", from_side ? Vector3d{-10, 1, 0} : Vector3d{0, 1, -10})};
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  if (excluded) deck.contact->exclude = {"block"};
  deck.time.end = 0.03;
  return deck;
}

// Impulses on its nodes reach the block, whether that is in contact itself or not.
TEST(RigidJoints, AnImpactOnJoinedElementsMovesTheRigidPart) {
  for (const Joint joint : {Joint::merged, Joint::tied})
    for (const bool excluded : {false, true})
      for (const bool from_side : {false, true}) {
        SCOPED_TRACE(std::to_string(static_cast<int>(joint)) + (excluded ? " excluded" : "") +
                     (from_side ? " from the side" : ""));
        const Deck deck = struck_pad(joint, excluded, from_side);
        Model model = build_model(deck);
        ThreadTeam team(1);
        run(model, deck, team, [&](Model& m) {
          balance_momentum(m, momentum(m.nodes));
          ASSERT_LE(m.momentum.linear_imbalance(), 1e-12);
          ASSERT_LE(m.momentum.angular_imbalance(), 1e-12);
        });
        EXPECT_LT(model.rigid.motion[0].velocity[from_side ? 0 : 2], -0.3);
        EXPECT_GT(norm(model.rigid.motion[0].angular_velocity), 0.1);
        EXPECT_LE(model.energy.error_max, 1e-2);
      }
}

TEST(RigidJoints, SupportsOfJoinedNodesMustBeThoseOfTheBody) {
  Deck deck = loaded_spring(Joint::merged, 0);
  deck.time.end = 1e-4;
  deck.boundary_conditions.push_back(fix("spring.xmax", {1}));
  Model model = build_model(deck);  // the body has the same
  for (const PrescribedNodes& given : model.prescribed)
    for (const std::size_t i : model.rigid.body[0].joint)
      EXPECT_EQ(std::count(given.nodes.begin(), given.nodes.end(), model.rigid.body[0].node[i]), 0);
  deck.boundary_conditions.push_back(fix("spring.xmax", {0}));
  EXPECT_THROW(build_model(deck), BuildError);
}

TEST(RigidJoints, InitialVelocitiesMustAgree) {
  for (const Joint joint : {Joint::merged, Joint::tied}) {
    Deck deck = loaded_spring(joint, 1);
    deck.initial_conditions.pop_back();
    deck.time.end = 1e-4;
    EXPECT_THROW(build_model(deck), BuildError);
  }
}

TEST(RigidJoints, DoNotGoWithMassScaling) {
  Deck deck = loaded_spring(Joint::merged, 1);
  deck.time.step.reset();
  deck.time.end = 1e-3;
  deck.time.mass_scaling = MassScaling{.step = 1e-3};
  EXPECT_THROW(build_model(deck), BuildError);
}

}  // namespace
}  // namespace brio
