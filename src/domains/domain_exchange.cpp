#include "src/domains/domain_exchange.hpp"

#include <algorithm>
#include <cstring>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Elements times nodes of an element, about what a sweep costs. Domains in order, to ranks in order: what
// is beside each other stays together.
std::vector<int> deal(const SweepSchedule& schedule, std::span<const Block> blocks, int ranks, int everyone) {
  std::vector<double> cost(schedule.domain_count(), 0);
  std::vector<int> rank(schedule.domain_count(), 0);
  for (const DomainPiece& piece : schedule.pieces) {
    const Block& block = blocks[piece.block];
    if (block.cloud)
      rank[piece.domain] = everyone;
    else
      cost[piece.domain] += static_cast<double>(piece.element_count) * nodes_per_element(block.element);
  }
  double all = 0;
  for (const double one : cost) all += one;
  double before = 0;
  for (std::size_t d = 0; d < cost.size(); ++d) {
    if (rank[d] != everyone)
      rank[d] = std::min(static_cast<int>(ranks * ((before + 0.5 * cost[d]) / all)), ranks - 1);
    before += cost[d];
  }
  return rank;
}

}  // namespace

DomainExchange::DomainExchange(Ranks& ranks, const SweepSchedule& schedule, std::span<const Block> blocks)
    : ranks_(ranks), rank_of_domain_(deal(schedule, blocks, ranks.count(), everyone)) {
  const std::vector<std::vector<int>> nodes = nodes_of_domains(schedule.pieces, blocks);
  const DomainSums& sums = schedule.sums;
  for (int rank = 0; rank < ranks.count(); ++rank) {
    entry_first_.push_back(entries_.size());
    for (std::size_t d = 0; d < nodes.size(); ++d) {
      if (rank_of_domain_[d] != rank) continue;
      for (const int node : nodes[d])
        if (!std::ranges::binary_search(sums.node, node)) entries_.push_back(node);
      for (std::size_t s = sums.domain_first[d]; s < sums.domain_first[d + 1]; ++s)
        entries_.push_back(-1 - sums.slots[s].number);
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

template <class T>
void DomainExchange::share(int rank, T* data, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (rank != everyone && count > 0)
    shared_.push_back({rank, reinterpret_cast<std::byte*>(data), count * sizeof(T)});
}

void DomainExchange::exchange() {
  first_.assign(index(ranks_.count()) + 1, 0);
  for (const Shared& one : shared_) first_[index(one.rank) + 1] += one.bytes;
  for (std::size_t rank = 0; rank + 1 < first_.size(); ++rank) first_[rank + 1] += first_[rank];
  bytes_.resize(first_.back());
  next_ = first_;
  for (const Shared& one : shared_)
    if (one.rank == ranks_.number()) {
      std::memcpy(bytes_.data() + next_[index(one.rank)], one.data, one.bytes);
      next_[index(one.rank)] += one.bytes;
    }
  ranks_.gather(bytes_, first_);
  next_ = first_;
  for (const Shared& one : shared_) {
    if (one.rank != ranks_.number()) std::memcpy(one.data, bytes_.data() + next_[index(one.rank)], one.bytes);
    next_[index(one.rank)] += one.bytes;
  }
  shared_.clear();
}

void DomainExchange::share_packs(int rank, Block& block, std::size_t first, std::size_t last) {
  share(rank, block.state.data() + first * block.pack_bytes, (last - first) * block.pack_bytes);
  const std::size_t held = 2 * index(block.lanes);
  if (block.loses_elements) share(rank, block.held.data() + first * held, (last - first) * held);
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
  for_each(
      [&](int rank, Block& /*block*/, std::span<int> places) { share(rank, places.data(), places.size()); });
  if (shared_.empty()) return;
  exchange();
  for_each([&](int rank, Block& block, std::span<int> places) {
    for (const int place : places) {
      const std::size_t pack = index(place) / index(block.lanes);
      share_packs(rank, block, pack, pack + 1);
      if (!block.mass_gain.empty()) share(rank, &block.mass_gain[index(place)], 1);
    }
  });
  exchange();
}

void DomainExchange::exchange_results(const SweepSchedule& schedule, std::span<SweepResult> results,
                                      std::span<Block> blocks) {
  for (std::size_t t = 0; t < schedule.tasks.size(); ++t)
    share(rank_of(schedule, schedule.tasks[t]), &results[t], 1);
  exchange();
  share_listed(schedule, results, blocks, &SweepResult::lost, &Block::lost);
  share_listed(schedule, results, blocks, &SweepResult::scaled, &Block::scaled);
}

void DomainExchange::exchange_elements(const SweepSchedule& schedule, std::span<Block> blocks) {
  for (const DomainPiece& piece : schedule.pieces)
    share_packs(rank_of_domain_[piece.domain], blocks[piece.block], piece.first_pack, piece.last_pack);
  exchange();
}

}  // namespace brio
