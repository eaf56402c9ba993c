// Domains: neighbourhoods of elements with sums of their own.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "src/domains/sweep_domains.hpp"
#include "tests/core/scene.hpp"

namespace brio::test {

namespace {

/// Two boxes that share the nodes of a face, and some small ones.
Model boxes(std::size_t least_elements) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("a", {14, 5, 4}, {14, 5, 4}, {5, 2.5, 2}, hex8()),
                box("b", {3, 5, 4}, {3, 5, 4}, {13.5, 2.5, 2}, hex8())};
  for (int i = 0; i < 5; ++i)
    deck.parts.push_back(box("s" + std::to_string(i), {1, 1, 1}, {2, 2, 2}, {2.0 * i, 9, 0}, hex8()));
  Merge merge;
  merge.parts = {"a", "b"};
  merge.tolerance = 1e-6;
  deck.connections = {merge};
  deck.time.end = 1;
  Model model = build_model(deck);
  model.schedule = make_schedule(model.blocks, model.nodes.size(), least_elements);
  return model;
}

std::set<int> nodes_of(const SweepTask& task, std::span<const Block> blocks) {
  const Block& block = blocks[task.block];
  std::set<int> nodes;
  const std::size_t first = task.chunk.first_pack * index(block.lanes);
  for (std::size_t e = first; e < first + task.chunk.element_count; ++e)
    for (int corner = 0; corner < 8; ++corner) nodes.insert(block.node(e, corner));
  return nodes;
}

// What a task adds to a node: numbers whose sums depend on the order.
double share_of(std::size_t task, int node) { return 1.0 / (3.0 + 7.0 * static_cast<double>(task) + node); }

}  // namespace

TEST(Domains, EveryPackIsOfOneDomainAndSmallBlocksShareDomains) {
  const Model model = boxes(40);
  std::vector<std::vector<int>> owners(model.blocks.size());
  for (std::size_t b = 0; b < model.blocks.size(); ++b) owners[b].resize(model.blocks[b].pack_count);
  std::map<std::size_t, std::size_t> elements;
  for (const DomainPiece& piece : model.schedule.pieces) {
    elements[piece.domain] += piece.element_count;
    for (std::size_t pack = piece.first_pack; pack < piece.last_pack; ++pack) ++owners[piece.block][pack];
  }
  for (const auto& of_block : owners)
    for (const int count : of_block) EXPECT_EQ(count, 1);
  ASSERT_EQ(elements.size(), model.schedule.domain_count());
  EXPECT_EQ(elements.size(), 6u);  // four of `a`, one of `b`, one of all small ones
  for (const auto& [domain, count] : elements) EXPECT_GE(count, 40u) << domain;
}

TEST(Domains, NoTwoOfAStageShareANode) {
  const Model model = boxes(40);
  const SweepSchedule& schedule = model.schedule;
  ASSERT_GE(schedule.stage_first.size(), 3u);
  for (std::size_t stage = 0; stage + 1 < schedule.stage_first.size(); ++stage) {
    std::map<int, std::size_t> owner;
    for (std::size_t t = schedule.colour_first[schedule.stage_first[stage]];
         t < schedule.colour_first[schedule.stage_first[stage + 1]]; ++t) {
      const std::size_t domain = schedule.pieces[schedule.tasks[t].piece].domain;
      for (const int node : nodes_of(schedule.tasks[t], model.blocks)) {
        const auto [at, is_new] = owner.emplace(node, domain);
        EXPECT_EQ(at->second, domain) << "node " << node << " in stage " << stage;
      }
    }
  }
}

// The first domain that is swept adds to what stood on the node, then come the partial sums of the others.
TEST(Domains, SumsAreTakenDomainByDomain) {
  Model model = boxes(40);
  SweepSchedule& schedule = model.schedule;
  AlignedBuffer<NodeVector>& force = model.nodes.force;
  for (std::size_t i = 0; i < force.size(); ++i) force[i].component[1] = 1.0 / (1.0 + static_cast<double>(i));

  std::vector<std::map<std::size_t, double>> partial(force.size());  // in the order of the sweep
  std::vector<std::size_t> place(schedule.domain_count());
  for (std::size_t k = 0; k < place.size(); ++k) place[schedule.domain_of_stage[k]] = k;
  for (std::size_t t = 0; t < schedule.tasks.size(); ++t)
    for (const int node : nodes_of(schedule.tasks[t], model.blocks)) {
      std::map<std::size_t, double>& sums = partial[index(node)];
      const std::size_t at = place[schedule.pieces[schedule.tasks[t].piece].domain];
      if (sums.empty()) sums[at] = force[index(node)].component[1];
      sums[at] += share_of(t, node);
    }
  std::vector<double> expected(force.size());
  std::size_t on_borders = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    for (const auto& [at, sum] : partial[i]) expected[i] += sum;
    if (partial[i].size() > 1) ++on_borders;
  }
  EXPECT_EQ(on_borders, schedule.sums.node.size());
  EXPECT_GE(on_borders, 4u * 30u);  // four faces of 6 x 5 nodes

  for (const int threads : {1, 3}) {
    Model copy = model;
    ThreadTeam team(threads);
    AlignedBuffer<NodeVector>& row = copy.nodes.force;
    sweep_domains(copy.schedule, {row.data(), nullptr}, team, [&](std::size_t t) {
      for (const int node : nodes_of(schedule.tasks[t], model.blocks))
        row[index(node)].component[1] += share_of(t, node);
    });
    std::size_t same = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
      EXPECT_NEAR(row[i].component[1], expected[i], 1e-15);
      if (partial[i].size() > 1) same += row[i].component[1] == expected[i] ? 1 : 0;
    }
    EXPECT_EQ(same, on_borders);
  }
}

}  // namespace brio::test
