// Ties beside contact: what is held does not meet what holds it, and meets all else with the masses that hold
// it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/surface/face_geometry.hpp"
#include "tests/core/build/tied_scene.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// ---- parts that are tied do not meet where they are

void expect_no_contact(Deck deck, double rate) {
  const Tensor<double> gradient{{{0.2 * rate, -rate, 0.3 * rate},
                                 {rate, 0.1 * rate, -0.5 * rate},
                                 {-0.3 * rate, 0.5 * rate, -0.2 * rate}}};
  std::vector<Vector3d> reference;
  for (const bool contact : {false, true}) {
    if (contact) deck.contact.emplace();
    Model model = build_model(deck);
    set_velocities(model, {1, 2, 3}, gradient);
    ThreadTeam team(1);
    run(model, deck, team);
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
      const Vector3d x = position(model.nodes, static_cast<int>(i));
      if (contact)
        EXPECT_EQ(norm(x - reference[i]), 0);
      else
        reference.push_back(x);
    }
    if (!contact) continue;
    EXPECT_TRUE(model.initial_overlaps.empty());
    EXPECT_EQ(model.contacts[0].totals.most_contacts, 0);
  }
}

TEST(TiesInContact, SolidsDoNotMeetWhereTheyAreTied) {
  expect_no_contact(two_boxes({2, 2, 2}, {3, 3, 3}), 20);
  expect_no_contact(two_boxes({3, 3, 3}, {2, 2, 2}), 20);
  expect_no_contact(two_boxes({2, 2, 2}, {4, 4, 4}, 0.01), 20);
  Deck deck = two_boxes({4, 4, 2}, {3, 3, 3});
  deck.parts[1] = box("fine", {0.5, 0.6, 0.4}, {3, 3, 3}, {0.05, 0, 0.2}, inviscid_hex8());
  expect_no_contact(deck, 20);
}

TEST(TiesInContact, ShellOnASolidDoesNotMeetIt) {
  Deck deck = two_boxes({2, 2, 2}, {1, 1, 1});
  for (const double height : {0.05, 0.03, 0.0}) {
    deck.parts[1] = plate("fine", {0.9, 0.8}, {5, 3}, {0, 0, height}, 0.1);
    deck.connections = {tied("fine", "coarse", 0.06)};
    expect_no_contact(deck, 20);
  }
}

TEST(TiesInContactSlow, StiffenersDoNotMeetThePanelThatHoldsThem) {
  for (const double height : {0.03, 0.02, 0.0}) {
    Deck deck = stiffened_panel(height);
    expect_no_contact(deck, 2);
  }
  // A plate on edge: its second row of nodes lies within the thickness of the panel.
  Deck deck = stiffened_panel();
  deck.parts[1] = plate("stiffener", {1, 0.1}, {20, 16}, {0, 0, 0.05}, 0.02);
  deck.parts[1].placement.rotate = Rotation{{1, 0, 0}, 90};
  deck.connections = {tied("stiffener", "panel", 0.001)};
  expect_no_contact(deck, 2);
}

// ---- impact on tied nodes

struct Hit {
  Model model;
  double linear = 0, angular = 0, added = 0, energy = 0;
};

/// A box falls on the middle of the scene.
Hit hit(Deck deck, Vector3d centre, Vector3d velocity, int threads = 1) {
  Part ball = box("ball", {0.3, 0.3, 0.3}, {2, 2, 2}, centre, hex8());
  ball.placement.rotate = Rotation{{1, 2, 0}, 20};
  deck.parts.push_back(ball);
  deck.contact.emplace();
  InitialCondition moves = moving("ball", velocity);
  deck.initial_conditions = {moves};
  Hit found{build_model(deck)};
  ThreadTeam team(threads);
  Momentum start;
  run(found.model, deck, team, [&](Model& m) {
    const Momentum now = momentum(m.nodes);
    if (m.step == 0) start = now;
    for (std::size_t i = 0; i < 3; ++i) {
      found.linear =
          std::max(found.linear, std::abs(now.total.linear[i] - start.total.linear[i]) / start.linear_size);
      found.angular = std::max(found.angular,
                               std::abs(now.total.angular[i] - start.total.angular[i]) / start.angular_size);
    }
  });
  found.added = found.model.energy.contact_added_max / found.model.energy.kinetic_start;
  found.energy = found.model.energy.error_max;
  return found;
}

double mean_up(const Model& model) { return mean_velocity(model, 2, 2); }

/// A block covered by a shell with all nodes tied.
Deck covered_block(double thickness) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("coarse", {1, 1, 0.5}, {3, 3, 2}, {0, 0, -0.25}, hex8()),
                plate("fine", {0.9, 0.9}, {7, 7}, {0, 0, 0.5 * thickness}, thickness)};
  deck.connections = {tied("fine", "coarse", thickness)};
  deck.time.end = 6e-3;
  return deck;
}

TEST(TiesInContact, BallReboundsFromAHeldShellAsFromTheBlockBelow) {
  constexpr double thickness = 0.02;
  const Hit held = hit(covered_block(thickness), {0.05, 0.03, 0.25 + thickness}, {0, 0, -20});
  EXPECT_LT(held.linear, 1e-12);
  EXPECT_LT(held.angular, 1e-12);
  EXPECT_LT(held.added, 1e-3);
  EXPECT_LT(held.energy, 2e-3);
  EXPECT_GT(held.model.contacts[0].totals.most_contacts, 0);
  EXPECT_LT(held.model.contacts[0].totals.deepest_overlap, 1e-3);
  Deck bare = covered_block(thickness);
  bare.parts[1] = plate("fine", {0.9, 0.9}, {7, 7}, {0, 0, 9}, thickness);
  bare.connections.clear();
  const Hit reference = hit(bare, {0.05, 0.03, 0.25}, {0, 0, -20});
  EXPECT_GT(mean_up(reference.model), -10);
  EXPECT_NEAR(mean_up(held.model), mean_up(reference.model), 0.3);
}

TEST(TiesInContact, HeldNodesThatAreRubbedKeepMomentum) {
  Deck deck = covered_block(0.1);
  deck.contact.emplace().options.friction = 0.3;
  Part ball = box("ball", {0.3, 0.3, 0.3}, {2, 2, 2}, {0, 0, 0.3}, hex8());
  ball.placement.rotate = Rotation{{1, 2, 0}, 20};
  deck.parts.push_back(ball);
  deck.initial_conditions = {moving("ball", {15, 0, -20})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  double linear = 0;
  const Vector3d start = momentum_of(model);
  run(model, deck, team, [&](Model& m) {
    const Vector3d now = momentum_of(m);
    for (std::size_t i = 0; i < 3; ++i) linear = std::max(linear, std::abs(now[i] - start[i]));
  });
  EXPECT_LT(linear, 1e-12 * 1000 * 0.027 * 25);
  EXPECT_LT(model.energy.friction.at_step(), 0);
  EXPECT_LT(model.energy.error_max, 2e-3);
}

TEST(TiesInContact, WhatHoldsMayStayOutsideOfContact) {
  Deck deck = covered_block(0.02);
  deck.parts.push_back(box("ball", {0.3, 0.3, 0.3}, {2, 2, 2}, {0, 0, 0.18}, hex8()));
  deck.contact.emplace().exclude = {"coarse"};
  deck.initial_conditions = {moving("ball", {0, 0, -20})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_GT(mean_up(model), 0);
  EXPECT_LT(model.energy.contact_added_max, 1e-3 * model.energy.kinetic_start);
  EXPECT_LT(model.energy.error_max, 2e-3);
}

TEST(TiesInContact, SupportsUnderTiedNodesAreAccountedFor) {
  Deck deck = covered_block(0.02);
  deck.boundary_conditions = {fix("coarse.zmax", {0, 1, 2})};
  deck.parts.push_back(box("ball", {0.3, 0.3, 0.3}, {2, 2, 2}, {0, 0, 0.18}, hex8()));
  deck.contact.emplace();
  deck.initial_conditions = {moving("ball", {0, 0, -20})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team, [&](Model& m) {
    m.momentum.now = momentum(m.nodes).total;
    ASSERT_LT(m.momentum.linear_imbalance(), 1e-12);
    ASSERT_LT(m.momentum.angular_imbalance(), 1e-12);
  });
  EXPECT_GT(mean_up(model), 0);
  EXPECT_LT(model.energy.error_max, 2e-3);
}

TEST(TiesInContact, RigidBallReboundsFromAHeldShell) {
  Deck deck = covered_block(0.02);
  Part ball = box("ball", {0.3, 0.3, 0.3}, {2, 2, 2}, {0, 0, 0.25}, Rigid{});
  ball.placement.rotate = Rotation{{1, 2, 0}, 20};
  deck.parts.push_back(ball);
  deck.contact.emplace();
  deck.initial_conditions = {moving("ball", {0, 0, -20})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team, [&](Model& m) {
    Momentum now = momentum(m.nodes);
    add_momentum(m.rigid, now);
    m.momentum.now = now.total;
    ASSERT_LT(m.momentum.linear_imbalance(), 1e-12);
    ASSERT_LT(m.momentum.angular_imbalance(), 1e-12);
  });
  EXPECT_GT(model.rigid.motion[0].velocity[2], -10);
  EXPECT_LT(model.energy.contact_added_max, 1e-3 * model.energy.kinetic_start);
  EXPECT_LT(model.energy.error_max, 2e-3);
}

TEST(TiesInContact, AreTheSameBitsForAnyNumberOfThreads) {
  const Hit reference = hit(covered_block(0.02), {0.05, 0.03, 0.27}, {3, 0, -20});
  for (int threads : {2, 4}) {
    const Hit other = hit(covered_block(0.02), {0.05, 0.03, 0.27}, {3, 0, -20}, threads);
    for (std::size_t i = 0; i < reference.model.nodes.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_EQ(other.model.nodes.record[i].position[axis], reference.model.nodes.record[i].position[axis]);
  }
}

}  // namespace
}  // namespace brio
