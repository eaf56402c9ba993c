// Deletion of elements: what stands where afterwards, and how much is touched.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "src/base/index.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/core/sweep/erosion_scene.hpp"

namespace brio {
namespace {

using namespace test;

Model living_block(std::array<int, 3> elements, const Deck& base) {
  Deck deck = base;
  deck.parts.resize(1);
  std::get<BoxMesh>(deck.parts[0].mesh).elements = elements;
  deck.parts[0].deletion->inverted = true;
  Model model = build_model(deck);
  ThreadTeam team(1);
  make_steps(model, 4, 1, team);
  update_positions(model, team);  // which clears the forces
  return model;
}

/// Each living element of the model is where the part says, with the state and nodes it has in `before`.
void expect_same_elements(const Model& model, const Model& before) {
  const PartInModel& part = model.parts[0];
  std::size_t living = 0;
  for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
    if (part.element_slot[e] < 0) continue;
    ++living;
    const auto place = index(part.element_slot[e]);
    const auto old_place = index(before.parts[0].element_slot[e]);
    ASSERT_EQ(part.element_order[place], static_cast<int>(e));
    for (int corner = 0; corner < 8; ++corner)
      ASSERT_EQ(model.blocks[0].node(place, corner), before.blocks[0].node(old_place, corner));
    const ElementSample now = model.blocks[0].kernel.sample(model.blocks[0], model.nodes, place, true);
    const ElementSample then =
        before.blocks[0].kernel.sample(before.blocks[0], before.nodes, old_place, true);
    ASSERT_EQ(now.stress.xx, then.stress.xx);
    ASSERT_EQ(now.internal_energy, then.internal_energy);
    ASSERT_EQ(held_energy(model.blocks[0], place).internal,
              held_energy(before.blocks[0], old_place).internal);
  }
  EXPECT_EQ(living, model.blocks[0].element_count);
  std::size_t scheduled = 0;
  for (const SweepTask& task : model.schedule.tasks) scheduled += task.chunk.element_count;
  EXPECT_EQ(living, scheduled);
}

TEST(Erosion, ElementsKeepTheirStateThroughDeletionAndPackingAnew) {
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    Deck deck = torn_block();
    deck.numerics.precision = precision;
    const Model before = living_block({13, 12, 11}, deck);
    Model model = before;
    const auto sum = [&] { return model.energy.internal + model.energy.hourglass + model.energy.deleted; };
    const double energy = sum();
    for (int round = 2; round < 40; ++round) {
      delete_by_hand(model, 0, [&](int e) { return (e * 7919 + round) % 5 == 0; });
      EXPECT_NEAR(sum(), energy, 1e-12 * energy);
      expect_same_elements(model, before);
      if (!is_sparse(model.schedule, model.blocks)) continue;
      repack(model.schedule, model.blocks, model.parts, model.nodes.size());
      expect_same_elements(model, before);
      EXPECT_FALSE(is_sparse(model.schedule, model.blocks));
    }
    EXPECT_LT(model.blocks[0].element_count, 200u);
    delete_by_hand(model, 0, [](int) { return true; });
    EXPECT_EQ(model.blocks[0].element_count, 0u);
    repack(model.schedule, model.blocks, model.parts, model.nodes.size());
    EXPECT_TRUE(model.schedule.tasks.empty());
  }
}

TEST(Erosion, SweepAfterDeletionGivesTheForcesOfTheElementsThatAreLeft) {
  Model model = living_block({9, 9, 9}, torn_block());
  delete_by_hand(model, 0, [](int e) { return e % 3 != 0; });
  // Forces of each element alone.
  std::vector<Vector3d> expected(model.nodes.size());
  const Model still = model;
  for (std::size_t e = 0; e < 729; e += 3) {
    Model alone = still;
    delete_by_hand(alone, 0, [&](int other) { return other != static_cast<int>(e); });
    for (const SweepTask& task : alone.schedule.tasks)
      alone.blocks[0].kernel.sweep(alone.blocks[0], task.chunk, alone.nodes, 1e-6);
    for (int corner = 0; corner < 8; ++corner) {
      const auto place = index(alone.parts[0].element_slot[e]);
      const auto node = index(alone.blocks[0].node(place, corner));
      for (std::size_t i = 0; i < 3; ++i) expected[node][i] += alone.nodes.force[node].component[i];
    }
    if (e > 60) break;
  }
  for (const SweepTask& task : model.schedule.tasks)
    model.blocks[0].kernel.sweep(model.blocks[0], task.chunk, model.nodes, 1e-6);
  double largest = 0;
  std::set<int> others;  // nodes of elements that were not summed
  for (std::size_t e = 0; e < 729; ++e)
    if (e > 63 && model.parts[0].element_slot[e] >= 0)
      for (int corner = 0; corner < 8; ++corner)
        others.insert(model.blocks[0].node(index(model.parts[0].element_slot[e]), corner));
  for (std::size_t node = 0; node < model.nodes.size(); ++node) {
    if (others.count(static_cast<int>(node)) > 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      largest = std::max(largest, std::abs(expected[node][i]));
      EXPECT_NEAR(model.nodes.force[node].component[i], expected[node][i], 1e-9 * (1 + largest));
    }
  }
  EXPECT_GT(largest, 1);
}

// A million elements, a hundred deletions: no more than two hundred places change.
TEST(ErosionSlow, DeletionTouchesAsMuchAsItDeletes) {
  Deck deck = torn_block();
  deck.numerics.precision = Precision::single_precision;
  deck.parts.resize(1);
  std::get<BoxMesh>(deck.parts[0].mesh).elements = {100, 100, 100};
  deck.parts[0].deletion->inverted = true;
  Model model = build_model(deck);
  const std::vector<int> order = model.parts[0].element_order;
  std::vector<std::byte> state(model.blocks[0].state.begin(), model.blocks[0].state.end());
  std::size_t changed_before = 0;
  for (int step = 1; step <= 3; ++step) {
    const AllocationCount allocations;
    std::vector<SweepResult> results(model.schedule.tasks.size());
    for (int k = 0; k < 100; ++k) {
      SweepResult& result = results[index(k) % results.size()];
      const Chunk chunk = model.schedule.tasks[index(k) % results.size()].chunk;
      const std::size_t first = chunk.first_pack * 16;
      model.blocks[0].lost[first + result.lost] = static_cast<int>(first + 997 * (result.lost + 1));
      ++result.lost;
    }
    model.energy += erode(*model.erosion, model.schedule, results, model.blocks, model.parts);
    EXPECT_LE(allocations.count(), 1u);  // that of `results`
    EXPECT_EQ(model.erosion->deleted.size(), 100u);
    EXPECT_FALSE(is_sparse(model.schedule, model.blocks));
    std::size_t changed = 0, changed_bytes = 0;
    for (std::size_t place = 0; place < order.size(); ++place)
      changed += model.parts[0].element_order[place] != order[place] ? 1 : 0;
    for (std::size_t i = 0; i < state.size(); ++i)
      changed_bytes += state[i] != model.blocks[0].state[i] ? 1 : 0;
    EXPECT_LE(changed - changed_before, 200u);
    EXPECT_LE(changed_bytes, changed * model.blocks[0].pack_bytes / 16);
    changed_before = changed;
  }
  EXPECT_EQ(model.blocks[0].element_count, 1000000u - 300u);
}

}  // namespace
}  // namespace brio
