// Blocks that rest on each other under gravity: no creep, no energy from nowhere.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double weight = 100;  // acceleration of gravity: a cube of edge 1 is compressed by 5e-5

// Cubes of edge 1 on each other from z = 0, edges aligned; the lowest is fixed at its bottom. `order` lists
// the floors in the order in which their parts are made.
Deck stack(const std::vector<int>& order, double friction) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  for (int floor : order)
    deck.parts.push_back(
        box("cube" + std::to_string(floor), {1, 1, 1}, {2, 2, 2}, {0, 0, 0.5 + floor}, hex8()));
  deck.boundary_conditions = {fix("cube0.zmin", {0, 1, 2})};
  Gravity gravity;
  gravity.acceleration = {0, 0, -weight};
  gravity.factor = Curve{{{0, 0}, {0.1, 1}}};
  deck.loads = {gravity};
  deck.contact.emplace();
  deck.contact->options.friction = friction;
  deck.time.step_bound = StepBound::elements;  // constant: a change gives and takes 1e-8 of the energy
  return deck;
}

// Ten bricks of stone, each a quarter of its length beside the one below, as in inputs/resting_stack.yaml.
Deck bricks(int elements) {
  Deck deck;
  Elastic stone;
  stone.density = 2000;
  stone.youngs_modulus = 10e9;
  stone.poissons_ratio = 0.2;
  deck.materials = {{"material", stone}};
  for (int floor = 0; floor < 10; ++floor)
    deck.parts.push_back(box("cube" + std::to_string(floor), {0.2, 0.1, 0.1},
                             {2 * elements, elements, elements}, {0.05 * (floor % 2), 0, 0.1 * floor + 0.05},
                             hex8()));
  deck.boundary_conditions = {fix("cube0.zmin", {0, 1, 2})};
  Gravity gravity;
  gravity.acceleration = {0, 0, -9.81};
  gravity.factor = Curve{{{0, 0}, {1, 1}}};
  deck.loads = {gravity};
  deck.contact.emplace();
  deck.contact->options.friction = 0.5;
  return deck;
}

struct Rest {
  double drift = 0;           ///< largest change of any node's position over the second half, in edges
  double kinetic = 0;         ///< largest over the last quarter, over m g h of a cube
  double kinetic_before = 0;  ///< the same over the third quarter
  double added = 0;           ///< most that contact has added, over m g h
  double error = 0;           ///< of the energy balance, over m g h
};

/// \param unit  m g h of a cube falling by its edge \param edge  its length
Rest rest(const Deck& deck, int steps, double unit, double edge) {
  Deck endless = deck;
  endless.time.end = 1e3;
  Model model = build_model(endless);
  ThreadTeam team(1);
  Rest result;
  std::vector<NodeRecord> middle;
  look_at_steps(model, steps, 1e9, team, [&](int step) {
    if (step == steps / 2) middle.assign(model.nodes.record.begin(), model.nodes.record.end());
    const double kinetic = model.energy.kinetic_half / unit;
    if (step > 3 * steps / 4) {
      result.kinetic = std::max(result.kinetic, kinetic);
    } else if (step > steps / 2) {
      result.kinetic_before = std::max(result.kinetic_before, kinetic);
    }
  });
  for (std::size_t i = 0; i < middle.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      result.drift = std::max(
          result.drift, std::abs(model.nodes.record[i].position[axis] - middle[i].position[axis]) / edge);
  result.added = model.energy.contact_added_max / unit;
  result.error = (model.energy.sum() - model.energy.external.at_step()) / unit;
  return result;
}

void expect_rest(const Rest& result) {
  EXPECT_LE(result.drift, 1e-3);
  EXPECT_LE(result.kinetic, 1e-7);
  EXPECT_LE(result.kinetic, result.kinetic_before);
  EXPECT_LE(result.added, 1e-3);
  EXPECT_LE(std::abs(result.error), 1e-9);
}

TEST(RestingCube, StaysOnACubeWhicheverPartComesFirst) {
  for (const std::vector<int>& order : {std::vector<int>{0, 1}, {1, 0}})
    expect_rest(rest(stack(order, 0.3), 3000, 1000 * weight, 1));
}

TEST(RestingStackSlow, OfThreeCubesNeitherCreepsNorGainsEnergy) {
  for (const std::vector<int>& order : {std::vector<int>{0, 1, 2}, {2, 0, 1}})
    expect_rest(rest(stack(order, 0.3), 20000, 1000 * weight, 1));
}

// A hundred thousand steps, a third of them while gravity comes on; inputs/resting_stack.yaml is a million.
TEST(ExtremesRestSlow, OfTenBricksNeitherCreepsNorTiltsNorGainsEnergy) {
  const Rest result = rest(bricks(1), 100000, 2000 * 0.002 * 9.81 * 0.1, 0.1);
  EXPECT_LE(result.drift, 1e-6);
  EXPECT_LE(result.kinetic, 1e-9);
  EXPECT_LE(result.kinetic, result.kinetic_before);
  EXPECT_LE(result.added, 1e-9);
  EXPECT_LE(std::abs(result.error), 1e-9);
}

// Softer, so that they sink in more, and with a face of two elements under each node: what swept forwards
// alone shakes itself.
TEST(RestingBricks, OneBesideTheOtherDoNotShakeThemselves) {
  Deck deck = stack({0, 1}, 0.3);
  deck.parts = {box("cube0", {2, 1, 1}, {2, 1, 1}, {0, 0, 0.5}, hex8()),
                box("cube1", {2, 1, 1}, {2, 1, 1}, {0.5, 0, 1.5}, hex8())};
  std::get<Gravity>(deck.loads[0]).factor = Curve{{{0, 0}, {1, 1}}};
  const Rest result = rest(deck, 10000, 2000 * weight, 1);
  expect_rest(result);
  EXPECT_LE(result.added, 1e-9);
}

}  // namespace
}  // namespace brio
