// Contact inside the step: bars that hit each other, what a scene without contact must not pay, threads.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// Two bars of length 1 along x that meet at x = 0 at `speed` each, `across` elements along each edge of their
// sections.
Deck two_bars(double speed, int left_across, int right_across, double gap = 0) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {
      box("left", {1, 0.05, 0.05}, {20, left_across, left_across}, {-0.5 - gap / 2, 0, 0}, hex8()),
      box("right", {1, 0.05, 0.05}, {20, right_across, right_across}, {0.5 + gap / 2, 0, 0}, hex8())};
  deck.initial_conditions = {moving("left", {speed, 0, 0}), moving("right", {-speed, 0, 0})};
  deck.contact.emplace();
  deck.time.end = 3e-3;
  return deck;
}

struct Collision {
  double stress = 0;     ///< along the bar, mean over the middle of the left one while the plateau lasts
  double parted_at = 0;  ///< last time at which contact pushed
  double left_speed = 0, right_speed = 0;
  double added = 0;  ///< most that contact has added, over the energy
  double momentum = 0;
};

Collision collide(const Deck& deck) {
  Model model = build_model(deck);
  ThreadTeam team(1);
  Collision result;
  double samples = 0;
  run(model, deck, team, [&](Model& m) {
    if (m.contacts[0].step.active > 0) result.parted_at = m.times.time;
    if (m.times.time < 0.8e-3 || m.times.time > 1.2e-3) return;
    const Block& block = m.blocks[0];
    for (std::size_t e = 0; e < block.element_count; ++e) {
      const double x = m.nodes.record[index(block.node(e, 0))].position[0];
      if (x < -0.56 || x > -0.49) continue;
      result.stress -= block.kernel.sample(block, m.nodes, e, true).stress.xx;
      ++samples;
    }
  });
  result.stress /= samples;
  result.left_speed = mean_velocity(model, 0, 0);
  result.right_speed = mean_velocity(model, 1, 0);
  result.added = model.energy.contact_added_max / model.energy.kinetic_start;
  const Vector3d now = momentum_of(model);
  const double scale = model.momentum.linear_scale;
  result.momentum = std::max({std::abs(now[0]), std::abs(now[1]), std::abs(now[2])}) / scale;
  return result;
}

TEST(TwoEqualBars, CarryTheWaveStressPartAfterTwoTransitsAndKeepMomentum) {
  const std::array<std::array<int, 2>, 4> meshes{{{1, 1}, {2, 2}, {4, 3}, {3, 4}}};
  for (const auto& [left, right] : meshes) {
    SCOPED_TRACE(testing::Message() << left << " and " << right << " elements across");
    const Collision collision = collide(two_bars(1, left, right));
    EXPECT_NEAR(collision.stress, 1e6, 0.01e6);
    EXPECT_NEAR(collision.parted_at, 2e-3, 0.05 * 2e-3);
    EXPECT_GE(-collision.left_speed, 0.92);
    EXPECT_LE(-collision.left_speed, 1.0);
    EXPECT_NEAR(collision.left_speed, -collision.right_speed, 1e-3);
    EXPECT_LE(collision.added, 1e-3);
    EXPECT_LE(collision.momentum, 1e-12);
  }
}

TEST(TwoEqualBars, GapsOfZeroOneUlpAndMoreAreTheSameImpact) {
  const Collision touching = collide(two_bars(1, 1, 1, 0));
  for (double gap : {1e-17, 2.3e-16, 1e-12, 1e-9, 1e-6}) {
    SCOPED_TRACE(gap);
    const Collision apart = collide(two_bars(1, 1, 1, gap));
    EXPECT_NEAR(apart.left_speed, touching.left_speed, 2e-3);
    EXPECT_NEAR(apart.parted_at, touching.parted_at, 5e-5);
  }
}

TEST(ContactStep, BitsDoNotDependOnTheNumberOfThreads) {
  Deck deck = two_bars(60, 4, 3, 0.001);
  deck.contact->options.friction = 0.3;
  deck.parts[1].placement.translate[1] = 0.01;
  deck.initial_conditions[1].velocity = {-60, -10, 5};
  deck.time.end = 1e-3;
  std::vector<Model> models;
  for (int threads : {1, 2, 4}) {
    models.push_back(build_model(deck));
    ThreadTeam team(threads);
    run(models.back(), deck, team);
    EXPECT_LT(models.back().energy.friction.at_step(), 0);
  }
  for (std::size_t i = 1; i < models.size(); ++i)
    ASSERT_EQ(std::memcmp(models[0].nodes.record.data(), models[i].nodes.record.data(),
                          models[0].nodes.size() * sizeof(NodeRecord)),
              0);
}

TEST(ContactStep, SceneWithoutContactBuildsAndTimesNone) {
  Deck deck = two_bars(1, 2, 2, 0.1);
  deck.contact.reset();
  deck.time.end = 1e-4;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_TRUE(model.contacts.empty());
  EXPECT_TRUE(model.nodes.velocity_before.empty());
  EXPECT_EQ(model.stages[Stage::contact], 0);
  EXPECT_EQ(model.stages[Stage::constraints], 0);
  EXPECT_GT(model.stages[Stage::elements], 0);
}

// A blade of 8 degrees falls flat on the floor. At its edge the mean of its surfaces looks along the floor.
TEST(ContactStep, SharpEdgeThatLooksAlongAFloorDoesNotSinkIn) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  WedgeMesh blade;
  blade.half_angle = 4;
  blade.height = 1;
  blade.thickness = 2 * std::tan(4 * std::numbers::pi / 180);
  blade.length = 0.5;
  blade.elements = {2, 8, 3};
  Placement flat;  // the lower flank on z = 0, the edge at x = 0
  flat.rotate = Rotation{{0, 1, 0}, -86};
  deck.parts = {{"blade", blade, flat, hex8(), "material"},
                box("floor", {2, 1, 0.1}, {1, 1, 1}, {-0.4, 0, -0.051}, hex8())};
  deck.boundary_conditions = {fix("floor", {0, 1, 2})};
  deck.initial_conditions = {moving("blade", {0, 0, -2})};
  deck.contact.emplace();
  deck.time.end = 3e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  double lowest = 0;
  run(model, deck, team, [&](Model& m) {
    for (int node : m.parts[0].node) lowest = std::min(lowest, m.nodes.record[index(node)].position[2]);
  });
  EXPECT_GT(mean_velocity(model, 0, 2), -1);
  EXPECT_NEAR(lowest, -1e-3 + 2 * model.contacts[0].features.skin, 1e-5);
}

}  // namespace
}  // namespace brio
