// The pieces of the step by themselves: order and colours of chunks, loads, curves, times of output.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "src/base/index.hpp"
#include "src/output/output_schedule.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

Deck two_blocks() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("a", {3, 1, 1}, {30, 10, 9}, {0, 0, 0}, hex8()),
                box("b", {1, 1, 1}, {5, 6, 7}, {4, 0, 0}, hex8())};
  deck.time.end = 1;
  return deck;
}

TEST(Schedule, NoTwoChunksOfAColourShareANodeAndEveryPackIsSweptOnce) {
  const Model model = build_model(two_blocks());
  const SweepSchedule& schedule = model.schedule;
  std::vector<std::size_t> packs(model.blocks.size(), 0);
  for (std::size_t colour = 0; colour + 1 < schedule.colour_first.size(); ++colour) {
    std::set<int> seen;
    for (std::size_t t = schedule.colour_first[colour]; t < schedule.colour_first[colour + 1]; ++t) {
      const Block& block = model.blocks[schedule.tasks[t].block];
      const Chunk chunk = schedule.tasks[t].chunk;
      packs[schedule.tasks[t].block] += chunk.last_pack - chunk.first_pack;
      const auto width = index(block.lanes);
      std::set<int> own;
      for (std::size_t e = chunk.first_pack * width;
           e < std::min(chunk.last_pack * width, block.element_count); ++e)
        for (int corner = 0; corner < 8; ++corner) own.insert(block.node(e, corner));
      for (int node : own) EXPECT_TRUE(seen.insert(node).second) << "colour " << colour << ", node " << node;
    }
  }
  for (std::size_t b = 0; b < model.blocks.size(); ++b) EXPECT_EQ(packs[b], model.blocks[b].pack_count);
  for (std::size_t stage = 0; stage + 1 < schedule.stage_first.size(); ++stage)
    EXPECT_LE(schedule.stage_first[stage + 1] - schedule.stage_first[stage], 4u);  // slabs
}

TEST(Schedule, LocalityOrderIsAPermutationWhateverTheInputNumbering) {
  Mesh mesh = generate_mesh(two_blocks().parts[0].mesh, {});
  const std::vector<int> order = locality_order(mesh.position, mesh.connectivity, 8);
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], static_cast<int>(i));
}

// Element and node numbers of the input do not matter: energies of a run agree to round-off.
TEST(Schedule, ShuffledInputGivesTheSameRun) {
  Deck deck = two_blocks();
  deck.parts.pop_back();
  deck.initial_conditions = {moving("a.xmax", {20, 5, 0})};
  deck.time.end = 5e-4;
  Mesh mesh = generate_mesh(deck.parts[0].mesh, {});
  Mesh shuffled = mesh;
  std::vector<int> node_of(mesh.position.size());
  for (std::size_t i = 0; i < node_of.size(); ++i) node_of[i] = static_cast<int>(i);
  std::mt19937 random(7);
  std::shuffle(node_of.begin(), node_of.end(), random);
  for (std::size_t i = 0; i < node_of.size(); ++i) shuffled.position[index(node_of[i])] = mesh.position[i];
  for (int& node : shuffled.connectivity) node = node_of[index(node)];
  for (auto& [name, set] : shuffled.node_sets) {
    for (int& node : set) node = node_of[index(node)];
    std::sort(set.begin(), set.end());
  }
  ThreadTeam team(1);
  Model first = build(deck, {&mesh, 1});
  Model second = build(deck, {&shuffled, 1});
  run(first, deck, team);
  run(second, deck, team);
  EXPECT_GT(first.energy.internal, 0);
  EXPECT_NEAR(first.energy.internal, second.energy.internal, 1e-10 * first.energy.kinetic_start);
  EXPECT_NEAR(first.energy.kinetic, second.energy.kinetic, 1e-10 * first.energy.kinetic_start);
}

TEST(Loads, PressureOnAClosedSurfaceHasNoResultant) {
  Deck deck = two_blocks();
  deck.parts.pop_back();
  const Curve one{{{0, 1}}};
  for (const char* side : {"a.xmin", "a.xmax", "a.ymin", "a.ymax", "a.zmin", "a.zmax"})
    deck.loads.push_back(Pressure{side, one});
  Model model = build_model(deck);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(-0.03, 0.03);
  for (NodeRecord& record : model.nodes.record)
    for (int axis = 0; axis < 3; ++axis) record.position[axis] += jitter(random);
  Impulse sum;
  for (ActiveLoad& load : model.loads) {
    apply(load, 0, model.nodes);
    sum += resultant(load, model.nodes);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum.linear[axis], 0, 1e-12);
    EXPECT_NEAR(sum.angular[axis], 0, 1e-12);
  }
}

TEST(Loads, PressureOnASideIsItsAreaAgainstItsNormal) {
  Deck deck = two_blocks();
  deck.loads = {Pressure{"a.xmax", Curve{{{0, 2}}}}};
  Model model = build_model(deck);
  apply(model.loads[0], 0, model.nodes);
  EXPECT_NEAR(resultant(model.loads[0], model.nodes).linear[0], -2.0, 1e-12);
}

TEST(Curve, IsLinearBetweenItsPointsAndConstantBeyond) {
  const Curve curve{{{1, 10}, {2, 20}, {4, 0}}};
  EXPECT_EQ(curve(0), 10);
  EXPECT_EQ(curve(1.5), 15);
  EXPECT_EQ(curve(3), 10);
  EXPECT_EQ(curve(5), 0);
  EXPECT_EQ(curve.slope(1.5), 10);
  EXPECT_EQ(curve.slope(3), -10);
  EXPECT_EQ(curve.slope(9), 0);
}

TEST(OutputSchedule, IsDueAtTheStartThenOncePerInterval) {
  OutputSchedule schedule = OutputSchedule::every(0.1);
  EXPECT_TRUE(schedule.due(0));
  EXPECT_FALSE(schedule.due(0.05));
  EXPECT_TRUE(schedule.due(0.1));
  EXPECT_FALSE(schedule.due(0.11));
  EXPECT_TRUE(schedule.due(0.45));  // several intervals in one step count once
  EXPECT_FALSE(schedule.due(0.49));
  EXPECT_TRUE(schedule.due(0.5));
}

// The time is that which was asked for, in the step that reaches it; at its end it waits for the next step.
TEST(OutputSchedule, IsDueInTheStepThatReachesATime) {
  OutputSchedule schedule = OutputSchedule::every(0.1);
  EXPECT_EQ(schedule.due_within(0, 0.04), 0);
  EXPECT_EQ(schedule.due_within(0.04, 0.04), std::nullopt);
  EXPECT_EQ(schedule.due_within(0.08, 0.04), 0.1);
  EXPECT_EQ(schedule.due_within(0.12, 0.08), std::nullopt);
  EXPECT_EQ(schedule.due_within(0.2, 0.04), 0.2);
  EXPECT_EQ(schedule.due_within(0.24, 0.3), 0.1 * 3);  // several in one step count once
  EXPECT_EQ(schedule.due_within(0.54, 0.04), std::nullopt);
  OutputSchedule given = OutputSchedule::at({0.3, 0.1});
  EXPECT_EQ(given.due_within(0, 0.1), 0);
  EXPECT_EQ(given.due_within(0.1, 0.1), 0.1);
  EXPECT_EQ(given.due_within(0.2, 0.11), 0.3);
  EXPECT_EQ(given.due_within(0.31, 9), std::nullopt);
}

// Of steps whose sum is rounded, and of very many in an interval.
TEST(OutputSchedule, EachTimeIsDueOnceInStepsOfAnySize) {
  for (const double step : {0.1, 0.1 / 3, 1e-3 / 7, 1e-6}) {
    OutputSchedule schedule = OutputSchedule::every(0.1);
    double time = 0;
    int count = 0;
    while (time < 0.95) {
      if (const auto asked = schedule.due_within(time, step)) {
        EXPECT_NEAR(*asked, 0.1 * count, 1e-12);
        EXPECT_LE(*asked - time, step);
        ++count;
      }
      time += step;
    }
    EXPECT_EQ(count, 10) << step;
  }
}

TEST(OutputSchedule, GivenTimesAreMetInOrder) {
  OutputSchedule schedule = OutputSchedule::at({0.3, 0.1});
  EXPECT_TRUE(schedule.due(0));
  EXPECT_FALSE(schedule.due(0.05));
  EXPECT_TRUE(schedule.due(0.1));
  EXPECT_FALSE(schedule.due(0.2));
  EXPECT_TRUE(schedule.due(0.31));
  EXPECT_FALSE(schedule.due(9));
}

}  // namespace
}  // namespace brio
