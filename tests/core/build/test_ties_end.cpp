// Ties at rigid walls, and ties that end: because elements are deleted, or by force.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/core/build/tied_scene.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

void expect_balanced(Model& model, double tolerance) {
  model.momentum.now = momentum(model.nodes).total;
  ASSERT_LT(model.momentum.linear_imbalance(), tolerance);
  ASSERT_LT(model.momentum.angular_imbalance(), tolerance);
}

// ---- walls

/// A block that falls onto a wall with its tied part first.
Deck falling(double thickness, double friction) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("coarse", {1, 1, 0.5}, {2, 2, 2}, {0, 0, 0.5}, hex8()),
                plate("fine", {0.9, 0.9}, {5, 5}, {0, 0, 0.25 - 0.5 * thickness}, thickness)};
  deck.connections = {tied("fine", "coarse", thickness)};
  deck.initial_conditions = {moving("coarse", {3, 0, -10}), moving("fine", {3, 0, -10})};
  RigidWall floor;
  floor.normal = {0, 0, 1};
  floor.friction = friction;
  deck.boundary_conditions = {floor};
  deck.time.end = 0.04;
  return deck;
}

TEST(TiesAtWalls, HeldNodesReboundWithWhatHoldsThem) {
  for (const double friction : {0.0, 0.3})
    for (const double thickness : {0.02, 0.2}) {
      const Deck deck = falling(thickness, friction);
      Model model = build_model(deck);
      ThreadTeam team(1);
      double lowest = 0;
      run(model, deck, team, [&](Model& m) {
        expect_balanced(m, 1e-12);
        for (const NodeRecord& record : m.nodes.record) lowest = std::min(lowest, record.position[2]);
      });
      EXPECT_GT(lowest, -1e-3);
      // The bare block of so few elements rebounds with 0.45 of its velocity.
      EXPECT_GT(momentum_of(model)[2], 0.3 * 10 * (500 + 810 * thickness));
      EXPECT_LT(model.energy.error_max, 2e-3);
      EXPECT_LT(model.energy.contact_added_max, 1e-3 * model.energy.kinetic_start);
      if (friction > 0) {
        EXPECT_LT(model.energy.friction.at_step(), 0);
      }
    }
}

TEST(TiesAtWalls, SupportsOfTheCornersAreAccountedFor) {
  Deck deck = falling(0.02, 0.3);
  deck.boundary_conditions.insert(deck.boundary_conditions.begin(), fix("coarse.zmin", {0}));
  deck.time.step_scale = 0.45;
  deck.initial_conditions = {moving("coarse", {0, 0, -10}), moving("fine", {0, 0, -10})};
  deck.initial_conditions[0].spin = deck.initial_conditions[1].spin = Spin{{0, 0, 0.25}, {0.5, 0, 0}};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team, [](Model& m) { expect_balanced(m, 1e-12); });
  EXPECT_GT(momentum_of(model)[2], 0);
  EXPECT_LT(model.energy.error_max, 1e-3);
}

// ---- deletion

ElasticPlastic soft() {
  return {.density = 1000,
          .youngs_modulus = 1e9,
          .poissons_ratio = 0.3,
          .yield_stress = 1e6,
          .hardening_modulus = 1e7};
}

/// Two tied blocks, one of them soft, pulled until the soft one has gone.
Deck torn(const std::string& soft_part, FreeNodes free_nodes, bool contact) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}, {"soft", soft()}};
  const bool coarse = soft_part == "coarse";
  deck.parts = {box("coarse", {1, 1, 0.5}, {2, 2, coarse ? 1 : 2}, {0, 0, -0.25}, hex8()),
                box("fine", {1, 1, 0.5}, {3, 3, coarse ? 2 : 1}, {0, 0, 0.25}, hex8())};
  Part& weak = deck.parts[coarse ? 0 : 1];
  weak.material = "soft";
  weak.deletion.emplace().plastic_strain = 0.02;
  weak.deletion->free_nodes = free_nodes;
  deck.connections = {tied("fine.zmin", "coarse")};
  deck.boundary_conditions = {fix("coarse.zmin", {0, 1, 2})};
  PrescribedMotion pull = fix("fine.zmax", {2});
  pull.components[0].curve.points = {{0, 5}};
  deck.boundary_conditions.push_back(pull);
  if (contact) deck.contact.emplace();
  deck.time.end = 0.02;
  return deck;
}

double kinetic(const Nodes& nodes) {
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    sum += 0.5 * nodes.mass[i] * squared_norm(velocity(nodes, static_cast<int>(i)));
  return sum;
}

double total_mass(const Model& model) {
  double sum = 0;
  for (double mass : model.nodes.mass) sum += mass;
  return sum;
}

TEST(TiesThatEnd, AreReleasedWithEnergyAndMomentumBalanced) {
  for (const char* part : {"coarse", "fine"})
    for (const FreeNodes free_nodes : {FreeNodes::keep, FreeNodes::drop})
      for (const bool contact : {false, true}) {
        SCOPED_TRACE(std::string(part) + (free_nodes == FreeNodes::drop ? " drop" : " keep") +
                     (contact ? " contact" : ""));
        const Deck deck = torn(part, free_nodes, contact);
        Model model = build_model(deck);
        const auto held = static_cast<std::int64_t>(model.ties.node.size());
        EXPECT_EQ(held, 16);
        ThreadTeam team(1);
        bool partly = false;
        run(model, deck, team, [&](Model& m) {
          expect_balanced(m, 1e-10);
          partly = partly || (!m.ties.empty() && m.ties.released > 0);
          ASSERT_NEAR(total_mass(m) + m.erosion->dropped_mass, 1000, 1e-9);
        });
        EXPECT_TRUE(model.ties.empty());
        EXPECT_EQ(model.ties.released, held);
        EXPECT_LT(model.energy.error_max, 1e-2);
        EXPECT_EQ(observe_end(model).ties->released, held);
        if (free_nodes == FreeNodes::keep) {
          EXPECT_EQ(model.erosion->dropped_mass, 0);
        }
      }
}

TEST(TiesThatEnd, LeaveTheOthersAsTheyAre) {
  const Deck deck = two_boxes({2, 2, 2}, {3, 3, 3}, 0.1);
  Model model = build_model(deck);
  const Tensor<double> gradient{{{5, -20, 3}, {10, 4, -6}, {7, 8, -9}}};
  set_velocities(model, {1, 2, 3}, gradient);
  const Momentum before = momentum(model.nodes);
  const double energy_before = kinetic(model.nodes);
  const int gone = model.ties.node[3].tie.node;
  model.ties.node[3].released = true;
  const NodeMotion lost = release(model.ties, model.nodes);
  const Momentum after = momentum(model.nodes);
  EXPECT_EQ(model.ties.node.size(), 15u);
  EXPECT_FALSE(model.ties.is_tied(gone));
  EXPECT_NEAR(model.nodes.mass[index(gone)], 1000.0 / 27 / 4, 1e-9);
  EXPECT_NEAR(total_mass(model), 2000, 1e-9);
  EXPECT_NEAR(lost.energy, energy_before - kinetic(model.nodes), 1e-9 * energy_before);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(before.total.linear[i] - after.total.linear[i], lost.linear[i], 1e-9);
    EXPECT_NEAR(before.total.angular[i] - after.total.angular[i], lost.angular[i], 1e-9);
  }
  // Put back, everything is as it was.
  for (const TiedNode& tied : model.ties.node) EXPECT_TRUE(model.ties.is_tied(tied.tie.node));
  Model again = build_model(deck);
  for (TiedNode& tied : again.ties.node) tied.released = true;
  release(again.ties, again.nodes);
  EXPECT_TRUE(again.ties.empty());
  EXPECT_EQ(again.ties.step_share, 1);
  Deck apart = deck;
  apart.connections.clear();
  const Model untied = build_model(apart);
  for (std::size_t i = 0; i < untied.nodes.size(); ++i)
    EXPECT_NEAR(again.nodes.mass[i], untied.nodes.mass[i], 1e-12);
}

// ---- failure by force

/// Two boxes of an element each, tied by four nodes; the lower one stands.
Deck failing(const TieFailure& failure) {
  Deck deck = two_boxes({1, 1, 1}, {1, 1, 1}, 0, 0);
  std::get<TieToSurface>(deck.connections[0]).failure = failure;
  deck.boundary_conditions = {fix("coarse.zmin", {0, 1, 2})};
  deck.time.end = 0.4;
  return deck;
}

/// On the upper side, growing to `force` a node at the end of the run.
Deck pulled(const TieFailure& failure, Vector3d force) {
  Deck deck = failing(failure);
  NodalForce pull;
  pull.where.set = "fine.zmax";
  pull.force = force;
  pull.factor = Curve{{{0, 0}, {deck.time.end, 1}}};
  deck.loads = {pull};
  return deck;
}

/// Time at which the first tie failed; negative: none did.
double time_of_failure(const Deck& deck, Model& model) {
  ThreadTeam team(1);
  double time = -1;
  run(model, deck, team, [&](Model& m) {
    expect_balanced(m, 1e-10);
    if (time < 0 && m.ties.failed > 0) time = m.times.time;
  });
  EXPECT_LT(model.energy.error_max, 1e-2);
  return time;
}

TEST(TiesThatFail, ComeOffAtTheirTensionOrShear) {
  const double end = failing({}).time.end;
  for (const bool contact : {false, true})
    for (const auto& [failure, force] : {std::pair(TieFailure{.normal_force = 6e3}, Vector3d{0, 0, 1e4}),
                                         std::pair(TieFailure{.shear_force = 6e3}, Vector3d{1e4, 0, 0})}) {
      SCOPED_TRACE(std::to_string(force[0]) + (contact ? " contact" : ""));
      Deck deck = pulled(failure, force);
      if (contact) deck.contact.emplace();
      Model model = build_model(deck);
      const double mass = total_mass(model);  // but what contact takes for its gap
      EXPECT_NEAR(mass, 2000, contact ? 5 : 1e-9);
      EXPECT_NEAR(time_of_failure(deck, model), 0.6 * end, 0.02 * end);
      EXPECT_TRUE(model.ties.empty());
      const Summary summary = observe_end(model);
      EXPECT_EQ(summary.ties->failed, 4);
      EXPECT_EQ(summary.ties->released, 4);
      EXPECT_NEAR(total_mass(model), mass, 1e-9);
    }
}

TEST(TiesThatFail, HoldWhatPresses) {
  const Deck deck = pulled({.normal_force = 1e3}, {0, 0, -1e4});
  Model model = build_model(deck);
  EXPECT_LT(time_of_failure(deck, model), 0);
  EXPECT_EQ(model.ties.node.size(), 4u);
}

// A base that falls ever faster draws the upper box along: each tied node carries its own inertia and that of
// the node above, 250 together.
TEST(TiesThatFail, FeelTheInertiaOfTiedNodes) {
  const double largest = 100, force = 0.5 * 250 * largest;
  Deck deck = failing({.normal_force = force});
  PrescribedMotion fall;
  fall.where.set = "coarse.zmin";
  fall.kind = MotionKind::acceleration;
  fall.components = {{2, Curve{{{0, 0}, {deck.time.end, -largest}}}}};
  deck.boundary_conditions = {fix("coarse.zmin", {0, 1}), fall};
  Model model = build_model(deck);
  EXPECT_NEAR(time_of_failure(deck, model), 0.5 * deck.time.end, 0.02 * deck.time.end);
}

}  // namespace
}  // namespace brio
