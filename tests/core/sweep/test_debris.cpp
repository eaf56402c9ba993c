// Nodes left without elements, in contact: those that are dropped are gone from it at once, those that are
// kept go on as points with a radius.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

ElasticPlastic soft_column() {
  return {.density = 1000,
          .youngs_modulus = 1e9,
          .poissons_ratio = 0.3,
          .yield_stress = 1e6,
          .hardening_modulus = 1e7};
}

constexpr std::size_t column_part = 0, block_part = 1;

// A soft column comes down on a free block; its lowest element is crushed and deleted.
Deck crushed_column(FreeNodes free_nodes) {
  Deck deck;
  deck.materials = {{"material", soft_column()}, {"hard", elastic(0.3)}};
  deck.parts = {box("column", {0.1, 0.1, 0.3}, {1, 1, 3}, {0.013, 0.017, 0.2505}, hex8()),
                box("block", {0.4, 0.4, 0.2}, {4, 4, 2}, {0, 0, 0}, hex8(), "hard")};
  deck.parts[column_part].deletion.emplace().plastic_strain = 0.04;
  deck.parts[column_part].deletion->free_nodes = free_nodes;
  deck.initial_conditions = {moving("column", {0, 0, -10})};
  NodalForce force;
  force.where.set = "column.zmin";
  force.force = {3, 0, -20};
  deck.loads = {force};
  deck.contact.emplace();
  deck.time.end = 0.03;
  return deck;
}

Vector3d momentum_of_part(const Model& model, std::size_t part) {
  Vector3d sum{};
  for (const int entry : model.parts[part].node) {
    const auto node = index(entry);
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] += model.nodes.mass[node] * model.nodes.record[node].velocity[i];
  }
  return sum;
}

double distance(const Vector3d& a, const Vector3d& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(Debris, DroppedNodesAreOutOfContactInTheStepInWhichTheyAreFreed) {
  const Deck deck = crushed_column(FreeNodes::drop);
  Model model = build_model(deck);
  ThreadTeam team(1);
  Vector3d before = momentum_of_part(model, block_part);
  const double scale = 10 * model.parts[column_part].mass;
  int active_before = 0, freed_in_contact = 0, active_later = 0;
  std::vector<int> gone;
  run(model, deck, team, [&](Model& m) {
    const ContactScene& scene = m.contacts[0];
    gone.insert(gone.end(), m.erosion->freed.begin(), m.erosion->freed.end());
    std::sort(gone.begin(), gone.end());
    if (!m.erosion->freed.empty()) freed_in_contact += active_before;
    if (!gone.empty()) active_later += scene.step.active;
    for (const int node : gone) ASSERT_LT(scene.surface.slave(node), 0) << "step " << m.step;
    for (const Contact& contact : scene.contacts)
      for (const int slave : contact.node) {
        const int node = scene.surface.node[index(slave)];
        ASSERT_FALSE(std::binary_search(gone.begin(), gone.end(), node));
        ASSERT_GT(m.nodes.mass[index(node)], 0);
      }
    const Vector3d now = momentum_of_part(m, block_part);
    if (scene.step.active == 0) {
      ASSERT_LT(distance(now, before), 1e-12 * scale) << "step " << m.step;
    }
    before = now;
    active_before = scene.step.active;
  });
  EXPECT_GT(freed_in_contact, 0) << "nodes were freed while they pushed";
  EXPECT_GT(active_later, 0) << "the rest of the column came down";
  EXPECT_GE(gone.size(), 4u);
  EXPECT_LT(gone.size(), 16u);
  for (const int node : gone) EXPECT_EQ(model.nodes.mass[index(node)], 0);
  EXPECT_GT(momentum_of_part(model, block_part)[2], -scale);
  std::vector<double> row;
  observe_history(model, row);
  EXPECT_LT(model.momentum.linear_imbalance(), 1e-12);
  EXPECT_LT(model.momentum.angular_imbalance(), 1e-12);
  EXPECT_LT(model.energy.error_max, 0.02);
}

// The nodes of the crushed element are caught between the block and the rest of the column, which comes down
// on them; without a radius it comes down on the block itself.
TEST(Debris, WithARadiusIsCaughtBetweenWhatMeets) {
  constexpr double radius = 0.02;
  for (const bool with_radius : {false, true}) {
    Deck deck = crushed_column(FreeNodes::keep);
    if (with_radius) deck.parts[column_part].deletion->debris_radius = radius;
    Model model = build_model(deck);
    ThreadTeam team(1);
    std::vector<int> freed;
    int pushed = 0;
    double added = 0;
    run(model, deck, team, [&](Model& m) {
      const ContactScene& scene = m.contacts[0];
      freed.insert(freed.end(), m.erosion->freed.begin(), m.erosion->freed.end());
      for (const int node : freed) ASSERT_EQ(scene.surface.slave(node) >= 0, with_radius);
      for (const Contact& contact : scene.contacts)
        pushed +=
            contact.impulse > 0 && !contact.of_edges() && scene.surface.faces_of.of(contact.slave).empty();
      added = scene.totals.largest_normal_work;
    });
    EXPECT_GE(freed.size(), 4u);
    EXPECT_EQ(pushed > 0, with_radius);
    EXPECT_LT(added, 1e-3 * model.energy.reference);
    EXPECT_LT(model.energy.error_max, 0.02);
    std::vector<double> row;
    observe_history(model, row);
    EXPECT_LT(model.momentum.linear_imbalance(), 1e-12);
    EXPECT_LT(model.momentum.angular_imbalance(), 1e-12);
  }
}

TEST(Debris, RadiusIsOfPartsInContactOnly) {
  Deck deck = crushed_column(FreeNodes::keep);
  deck.parts[column_part].deletion->debris_radius = 0.02;
  deck.contact->exclude = {"column"};
  EXPECT_THROW(build_model(deck), BuildError);
  deck.contact.reset();
  EXPECT_THROW(build_model(deck), BuildError);
}

}  // namespace
}  // namespace brio
