// Contact by distances: what starts apart never crosses, whatever the speed, and energy balances.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "contact/audit/audit.hpp"
#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double wave_speed = 1000;  // of the material of the scenes

ContactSection with_friction(double friction) {
  ContactSection contact;
  contact.options.friction = friction;
  return contact;
}

struct LookedAt {
  std::int64_t crossings = 0;  ///< at all looks together
  std::uint64_t unresolved = 0;
  double energy_error = 0;
  double momentum_error = 0;  ///< linear, less what walls gave, over the sum of sizes
  double farthest = 0;        ///< coordinate of any node
  std::int64_t deleted_by_distortion = 0;
  int looks = 0;
};

LookedAt run_looking(Deck& deck, int steps_between_looks = 10, int threads = 1) {
  Model model = build_model(deck);
  ThreadTeam team(threads);
  const Momentum before = momentum(model.nodes);
  LookedAt outcome;
  int step = 0;
  run(model, deck, team, [&](Model& m) {
    if (step++ % steps_between_looks != 0) return;
    outcome.crossings += audit(m.contacts[0], m.nodes, team).crossings;
    ++outcome.looks;
    for (std::size_t n = 0; n < m.nodes.size(); ++n)
      for (double x : std::span(m.nodes.record[n].position, 3))
        outcome.farthest = std::max(outcome.farthest, std::abs(x));
  });
  const Momentum after = momentum(model.nodes);
  for (std::size_t axis = 0; axis < 3; ++axis)
    outcome.momentum_error = std::max(
        outcome.momentum_error,
        std::abs(after.total.linear[axis] - before.total.linear[axis] - model.momentum.walls.linear[axis]) /
            std::max(before.linear_size, 1e-300));
  outcome.energy_error = std::abs(model.energy.relative_error());
  outcome.unresolved = model.contacts[0].unresolved.steps;
  if (model.erosion)
    outcome.deleted_by_distortion = model.erosion->deleted_by_cause[index(DeletionCause::distortion)];
  return outcome;
}

/// Cubes in a heap that is thrown together, each turned at random.
Deck thrown_cubes(int elements, double speed) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(-1, 1);
  for (int i = 0; i < 27; ++i) {
    const Vector3d place{1.9 * (i % 3 - 1), 1.9 * (i / 3 % 3 - 1), 1.9 * (i / 9 - 1)};
    Part cube = box("cube" + std::to_string(i), {1, 1, 1}, {elements, elements, elements}, {0, 0, 0}, hex8());
    cube.placement.translate = place;
    cube.placement.rotate = Rotation{{share(random), share(random), share(random) + 2}, 40 * share(random)};
    Vector3d velocity{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      velocity[axis] = speed * (-place[axis] / 1.9 + 0.5 * share(random));
    deck.parts.push_back(cube);
    deck.initial_conditions.push_back(moving(cube.name, velocity));
  }
  deck.contact = with_friction(0.1);
  deck.time.end = 3.0 / speed;
  deck.time.step_scale = 0.6;
  return deck;
}

class ThrownCubes : public ::testing::TestWithParam<std::pair<int, double>> {};

TEST_P(ThrownCubes, NeverCross) {
  const auto [elements, share] = GetParam();
  Deck deck = thrown_cubes(elements, share * wave_speed);
  const LookedAt outcome = run_looking(deck);
  EXPECT_GT(outcome.looks, 5);
  EXPECT_EQ(outcome.crossings, 0);
  EXPECT_EQ(outcome.unresolved, 0u);
  EXPECT_LT(outcome.momentum_error, 1e-12);
  EXPECT_LT(outcome.energy_error, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Speeds, ThrownCubes,
                         ::testing::Values(std::pair(1, 0.03), std::pair(1, 0.1), std::pair(1, 0.2),
                                           std::pair(2, 0.1), std::pair(2, 0.2)));

// The heap in a box of rigid walls with friction, from which it springs back and meets again.
void expect_box_holds(int elements, double share) {
  Deck deck = thrown_cubes(elements, share * wave_speed);
  constexpr double half = 3.2;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (double side : {-1.0, 1.0}) {
      RigidWall wall;
      wall.point[axis] = side * half;
      wall.normal[axis] = -side;
      wall.friction = 0.2;
      deck.boundary_conditions.push_back(wall);
    }
  deck.time.end = 8 / (share * wave_speed);
  const LookedAt outcome = run_looking(deck);
  EXPECT_EQ(outcome.crossings, 0);
  EXPECT_EQ(outcome.unresolved, 0u);
  EXPECT_GT(outcome.farthest, 0.99 * half) << "walls are met";
  EXPECT_LT(outcome.farthest, half * (1 + 1e-6));
  EXPECT_LT(outcome.momentum_error, 1e-12);
  EXPECT_LT(outcome.energy_error, 0.01);
}

class ShakenBox : public ::testing::TestWithParam<std::pair<int, double>> {};
TEST_P(ShakenBox, HoldsCubesThatNeverCross) { expect_box_holds(GetParam().first, GetParam().second); }
INSTANTIATE_TEST_SUITE_P(Speeds, ShakenBox,
                         ::testing::Values(std::pair(1, 0.1), std::pair(1, 0.2), std::pair(1, 0.3),
                                           std::pair(2, 0.1)));
class ShakenBoxSlow : public ShakenBox {};
TEST_P(ShakenBoxSlow, HoldsCubesThatNeverCross) { expect_box_holds(GetParam().first, GetParam().second); }
INSTANTIATE_TEST_SUITE_P(Speeds, ShakenBoxSlow, ::testing::Values(std::pair(2, 0.2), std::pair(2, 0.3)));

Deck block_on_sheet(double thickness, double speed) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Part block = box("block", {1, 1, 1}, {3, 3, 3}, {0.03, 0.07, 0.6}, hex8());
  block.placement.rotate = Rotation{{1, 0.3, 0}, 20};
  block.placement.translate = {0.03, 0.07, 0.95};
  PlateMesh mesh;
  mesh.size = {4, 4};
  mesh.elements = {20, 20};
  Shell4 element;
  element.thickness = thickness;
  deck.parts = {block, {"sheet", mesh, {}, element, "material"}};
  deck.boundary_conditions = {fix("sheet.boundary", {0, 1, 2})};
  deck.initial_conditions = {moving("block", {0, 0, -speed})};
  deck.contact = with_friction(0);
  deck.time.end = 1.5 / speed;
  return deck;
}

class BlockOnSheet : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(BlockOnSheet, DoesNotGoThrough) {
  const auto [thickness, share] = GetParam();
  Deck deck = block_on_sheet(thickness, share * wave_speed);
  const LookedAt outcome = run_looking(deck, 2);
  EXPECT_GT(outcome.looks, 3);
  EXPECT_EQ(outcome.crossings, 0);
  EXPECT_EQ(outcome.unresolved, 0u);
  EXPECT_LT(outcome.energy_error, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Speeds, BlockOnSheet,
                         ::testing::Values(std::pair(0.02, 0.05), std::pair(0.02, 0.3), std::pair(0.005, 0.3),
                                           std::pair(0.02, 1.0)));

// Faces of the block are crushed until opposite sides of them meet.
TEST(CrushedBlock, DoesNotCrossItself) {
  Deck deck;
  deck.materials = {{"material", ElasticPlastic{.density = 7800,
                                                .youngs_modulus = 2e11,
                                                .poissons_ratio = 0.3,
                                                .yield_stress = 3e8,
                                                .hardening_modulus = 1e9}}};
  Part block = box("block", {0.02, 0.02, 0.02}, {4, 4, 4}, {0, 0, 0}, hex8());
  block.placement.rotate = Rotation{{1, 0.3, 0}, 12};
  block.placement.translate = {0.001, 0.0005, 0.016};
  PlateMesh mesh;
  mesh.size = {0.1, 0.1};
  mesh.elements = {20, 20};
  Shell4 element;
  element.thickness = 2e-3;
  deck.parts = {block, {"sheet", mesh, {}, element, "material"}};
  deck.boundary_conditions = {fix("sheet.boundary", {0, 1, 2, 3, 4, 5})};
  deck.initial_conditions = {moving("block", {0, 0, -1500})};
  deck.contact = with_friction(0.2);
  deck.time.end = 2.6e-5;
  const LookedAt outcome = run_looking(deck, 1);
  EXPECT_GT(outcome.looks, 100);
  EXPECT_EQ(outcome.crossings, 0);
  EXPECT_EQ(outcome.unresolved, 0u);
  EXPECT_LT(outcome.energy_error, 0.01);
}

// What has been crushed inside of a tile crosses once a deletion lays it open: it is deleted too.
class BrittleTile : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(BrittleTile, DoesNotCrossItselfWhereItBreaks) {
  const auto [speed, degrees] = GetParam();
  Deck deck;
  deck.materials = {{"material", ElasticPlastic{.density = 2700,
                                                .youngs_modulus = 7e10,
                                                .poissons_ratio = 0.3,
                                                .yield_stress = 1e8,
                                                .hardening_modulus = 2e8}}};
  Part anvil = box("anvil", {0.06, 0.06, 0.06}, {2, 2, 2}, {0, 0, 0}, Rigid{});
  anvil.placement.rotate = Rotation{{1, 0.3, 0.2}, 40};
  Part tile = box("tile", {0.1, 0.1, 0.01}, {6, 6, 3}, {0, 0, 0}, hex8());
  tile.deletion.emplace().plastic_strain = 0.3;
  tile.placement.rotate = Rotation{{0.2, 1, 0}, degrees};
  tile.placement.translate = {0.003, 0.002, 0.08};
  deck.parts = {anvil, tile};
  deck.boundary_conditions = {fix("anvil.all", {0, 1, 2, 3, 4, 5})};
  deck.initial_conditions = {moving("tile", {0, 0, -speed})};
  deck.contact = with_friction(0);
  deck.time.end = 0.15 / speed;
  const LookedAt outcome = run_looking(deck, 5);
  EXPECT_GT(outcome.looks, 20);
  EXPECT_GT(outcome.deleted_by_distortion, 0);
  EXPECT_EQ(outcome.crossings, 0);
  EXPECT_EQ(outcome.unresolved, 0u);
  EXPECT_LT(outcome.energy_error, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Speeds, BrittleTile,
                         ::testing::Values(std::pair(400.0, 20.0), std::pair(700.0, 5.0)));

// A block that slides without friction over a floor of facets of random shapes meets nothing at their edges.
TEST(FacetsOfAFloor, DoNotStopABlock) {
  Deck deck;
  deck.materials = {{"material", elastic(0.0)}};
  Part block = box("block", {1, 1, 1}, {2, 2, 2}, {0.0, 0.0, 0.53}, hex8());
  Part floor = box("floor", {12, 4, 0.06}, {41, 13, 1}, {3, 0, 0}, hex8());
  floor.placement.rotate = Rotation{{0, 0, 1}, 7};
  deck.parts = {block, floor};
  deck.boundary_conditions = {fix("floor.all", {0, 1, 2})};
  deck.initial_conditions = {moving("block", {10, 1, 0})};
  deck.contact = with_friction(0);
  deck.time.end = 0.3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team, [](Model&) {});
  EXPECT_NEAR(mean_velocity(model, 0, 0), 10, 1e-5);
  EXPECT_NEAR(mean_velocity(model, 0, 1), 1, 1e-5);
}

}  // namespace
}  // namespace brio
