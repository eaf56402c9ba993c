#include "src/domains/domain_exchange.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Elements times nodes of an element, about what a sweep costs. Domains in order, to ranks in order: what
// is beside each other stays together.
std::vector<int> deal(const SweepSchedule& schedule, std::span<const Block> blocks, int ranks) {
  std::vector<double> cost(schedule.domain_count(), 0);
  std::vector<int> rank(schedule.domain_count(), 0);
  for (const DomainPiece& piece : schedule.pieces) {
    const Block& block = blocks[piece.block];
    if (block.cloud)
      rank[piece.domain] = Ranks::everyone;
    else
      cost[piece.domain] += static_cast<double>(piece.element_count) * nodes_per_element(block.element);
  }
  double all = 0;
  for (const double one : cost) all += one;
  double before = 0;
  for (std::size_t d = 0; d < cost.size(); ++d) {
    if (rank[d] != Ranks::everyone)
      rank[d] = std::min(static_cast<int>(ranks * ((before + 0.5 * cost[d]) / all)), ranks - 1);
    before += cost[d];
  }
  return rank;
}

// Whether nodes are of domains of several ranks.
std::vector<char> are_between_ranks(const std::vector<std::vector<int>>& nodes_of_domain,
                                    std::span<const int> rank_of_domain, int ranks) {
  std::size_t count = 0;
  for (const std::vector<int>& nodes : nodes_of_domain)
    if (!nodes.empty()) count = std::max(count, index(nodes.back()) + 1);
  std::vector<int> seen(count, ranks);  // rank that was seen first
  std::vector<char> between(count, 0);
  for (std::size_t d = 0; d < nodes_of_domain.size(); ++d)
    for (const int node : nodes_of_domain[d]) {
      int& first = seen[index(node)];
      if (first == ranks) first = rank_of_domain[d];
      if (first != rank_of_domain[d]) between[index(node)] = 1;
    }
  return between;
}

}  // namespace

DomainExchange::DomainExchange(Ranks& ranks, const SweepSchedule& schedule, std::span<const Block> blocks,
                               const std::vector<int>* wanted)
    : ranks_(ranks), rank_of_domain_(deal(schedule, blocks, ranks.count())) {
  const std::vector<std::vector<int>> nodes = nodes_of_domains(schedule.pieces, blocks);
  const std::vector<char> between = are_between_ranks(nodes, rank_of_domain_, ranks.count());
  const auto is_sent = [&](int node) {
    return wanted == nullptr || between[index(node)] != 0 || std::ranges::binary_search(*wanted, node);
  };
  const DomainSums& sums = schedule.sums;
  for (int rank = 0; rank < ranks.count(); ++rank) {
    entry_first_.push_back(entries_.size());
    for (std::size_t d = 0; d < nodes.size(); ++d) {
      if (rank_of_domain_[d] != rank) continue;
      for (const int node : nodes[d])
        if (is_sent(node) && !std::ranges::binary_search(sums.node, node)) entries_.push_back(node);
      for (std::size_t s = sums.domain_first[d]; s < sums.domain_first[d + 1]; ++s)
        if (is_sent(sums.slots[s].node)) entries_.push_back(-1 - sums.slots[s].number);
    }
  }
  entry_first_.push_back(entries_.size());
  const bool turning =
      std::ranges::any_of(blocks, [](const Block& block) { return has_rotations(block.element); });
  rows_ = AlignedBuffer<NodeVector>(entries_.size() * (turning ? 2 : 1));
}

void DomainExchange::exchange_rows(DomainSums& sums, const NodalRows& rows) {
  const std::size_t width = rows.angular != nullptr ? 2 : 1;
  const auto linear = [&](int entry) -> NodeVector& {
    return entry < 0 ? sums.linear[index(-1 - entry)] : rows.linear[entry];
  };
  const auto angular = [&](int entry) -> NodeVector& {
    return entry < 0 ? sums.angular[index(-1 - entry)] : rows.angular[entry];
  };
  first_.clear();
  for (const std::size_t entry : entry_first_) first_.push_back(entry * width * sizeof(NodeVector));
  const std::size_t own = entry_first_[index(ranks_.number())];
  const std::size_t end = entry_first_[index(ranks_.number()) + 1];
  for (std::size_t k = own; k < end; ++k) {
    rows_[k * width] = linear(entries_[k]);
    if (width == 2) rows_[k * width + 1] = angular(entries_[k]);
  }
  ranks_.gather(std::as_writable_bytes(std::span(rows_.data(), entries_.size() * width)), first_);
  const auto take = [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      linear(entries_[k]) = rows_[k * width];
      if (width == 2) angular(entries_[k]) = rows_[k * width + 1];
    }
  };
  take(0, own);
  take(end, entries_.size());
}

void DomainExchange::note_packs(int rank, Block& block, std::size_t first, std::size_t last) {
  ranks_.note(rank, block.state.data() + first * block.pack_bytes, (last - first) * block.pack_bytes);
  const std::size_t held = 2 * index(block.lanes);
  if (block.loses_elements) ranks_.note(rank, block.held.data() + first * held, (last - first) * held);
}

void DomainExchange::share_listed(const SweepSchedule& schedule, std::span<const SweepResult> results,
                                  std::span<Block> blocks, std::size_t SweepResult::*count,
                                  AlignedBuffer<int> Block::*list) {
  const auto for_each = [&](const auto& of_task) {
    for (std::size_t t = 0; t < schedule.tasks.size(); ++t) {
      const SweepTask& task = schedule.tasks[t];
      Block& block = blocks[task.block];
      if (const std::size_t listed = results[t].*count; listed > 0)
        of_task(rank_of(schedule, task), block,
                std::span((block.*list).data() + task.chunk.first_pack * index(block.lanes), listed));
    }
  };
  for_each([&](int rank, Block& /*block*/, std::span<int> places) {
    ranks_.note(rank, places.data(), places.size());
  });
  if (!ranks_.has_noted()) return;
  ranks_.share();
  for_each([&](int rank, Block& block, std::span<int> places) {
    for (const int place : places) {
      const std::size_t pack = index(place) / index(block.lanes);
      note_packs(rank, block, pack, pack + 1);
      if (!block.mass_gain.empty()) ranks_.note(rank, &block.mass_gain[index(place)], 1);
    }
  });
  ranks_.share();
}

void DomainExchange::exchange_results(const SweepSchedule& schedule, std::span<SweepResult> results,
                                      std::span<Block> blocks) {
  for (std::size_t t = 0; t < schedule.tasks.size(); ++t)
    ranks_.note(rank_of(schedule, schedule.tasks[t]), &results[t], 1);
  ranks_.share();
  share_listed(schedule, results, blocks, &SweepResult::lost, &Block::lost);
  share_listed(schedule, results, blocks, &SweepResult::scaled, &Block::scaled);
}

void DomainExchange::exchange_elements(const SweepSchedule& schedule, std::span<Block> blocks) {
  for (const DomainPiece& piece : schedule.pieces)
    note_packs(rank_of_domain_[piece.domain], blocks[piece.block], piece.first_pack, piece.last_pack);
  ranks_.share();
}

}  // namespace brio
