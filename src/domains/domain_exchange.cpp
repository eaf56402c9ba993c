#include "src/domains/domain_exchange.hpp"

#include <algorithm>
#include <utility>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Elements times nodes of an element.
std::vector<double> estimated_costs(const SweepSchedule& schedule, std::span<const Block> blocks) {
  std::vector<double> cost(schedule.domain_count(), 0);
  for (const DomainPiece& piece : schedule.pieces)
    cost[piece.domain] +=
        static_cast<double>(piece.element_count) * nodes_per_element(blocks[piece.block].element);
  return cost;
}

}  // namespace

// Domains in order, to ranks in order: what is beside each other stays together. Domains of particles are of
// all ranks.
std::vector<int> deal(const SweepSchedule& schedule, std::span<const Block> blocks, int ranks,
                      std::vector<double> cost) {
  if (cost.empty()) cost = estimated_costs(schedule, blocks);
  std::vector<int> rank(cost.size(), 0);
  for (const DomainPiece& piece : schedule.pieces) {
    if (!blocks[piece.block].cloud) continue;
    rank[piece.domain] = Ranks::everyone;
    cost[piece.domain] = 0;
  }
  double all = 0, before = 0;
  for (const double one : cost) all += one;
  for (std::size_t d = 0; d < cost.size(); ++d) {
    if (rank[d] != Ranks::everyone && all > 0)
      rank[d] = std::min(static_cast<int>(ranks * ((before + 0.5 * cost[d]) / all)), ranks - 1);
    before += cost[d];
  }
  return rank;
}

double unbalance(std::span<const int> rank_of_domain, std::span<const double> cost, int ranks) {
  std::vector<double> load(index(ranks), 0);
  double sum = 0;
  for (std::size_t d = 0; d < cost.size(); ++d) {
    if (rank_of_domain[d] == Ranks::everyone) continue;
    load[index(rank_of_domain[d])] += cost[d];
    sum += cost[d];
  }
  return sum > 0 ? std::ranges::max(load) * ranks / sum : 1;
}

DomainExchange::DomainExchange(Ranks& ranks, const SweepSchedule& schedule, std::span<const Block> blocks,
                               const std::vector<int>* wanted, std::vector<double> cost)
    : ranks_(ranks),
      rank_of_domain_(deal(schedule, blocks, ranks.count(), std::move(cost))),
      out_(index(ranks.count())),
      in_(index(ranks.count())),
      seconds_of_domain_(schedule.domain_count(), 0) {
  const std::vector<std::vector<int>> nodes = nodes_of_domains(schedule.pieces, blocks);
  const DomainSums& sums = schedule.sums;
  const bool turning =
      std::ranges::any_of(blocks, [](const Block& block) { return has_rotations(block.element); });
  // Of the domains of a rank what another follows.
  const auto list = [&](int from, int to, std::vector<int>& entries) {
    std::vector<int> followed = wanted != nullptr ? *wanted : std::vector<int>();
    for (std::size_t d = 0; d < nodes.size(); ++d)
      if (wanted != nullptr && rank_of_domain_[d] == to)
        followed.insert(followed.end(), nodes[d].begin(), nodes[d].end());
    std::ranges::sort(followed);
    const auto follows = [&](int node) {
      return wanted == nullptr || std::ranges::binary_search(followed, node);
    };
    for (std::size_t d = 0; d < nodes.size(); ++d) {
      if (rank_of_domain_[d] != from) continue;
      for (const int node : nodes[d])
        if (follows(node) && !std::ranges::binary_search(sums.node, node)) entries.push_back(node);
      for (std::size_t s = sums.domain_first[d]; s < sums.domain_first[d + 1]; ++s)
        if (follows(sums.slots[s].node)) entries.push_back(-1 - sums.slots[s].number);
    }
  };
  for (std::size_t d = 0; d < nodes.size(); ++d)
    for (std::size_t s = sums.domain_first[d]; s < sums.domain_first[d + 1]; ++s)
      if (sums.slots[s].number == sums.slots[s].first && !is_own(d))
        begun_elsewhere_.push_back(sums.slots[s].node);
  for (int other = 0; other < ranks.count(); ++other) {
    if (other == ranks.number()) continue;
    list(ranks.number(), other, out_[index(other)].entry);
    list(other, ranks.number(), in_[index(other)].entry);
    for (Entries* entries : {&out_[index(other)], &in_[index(other)]})
      entries->rows = AlignedBuffer<NodeVector>(entries->entry.size() * (turning ? 2 : 1));
  }
}

std::vector<double> DomainExchange::measured_costs() {
  std::vector<double> cost = seconds_of_domain_;
  for (std::size_t d = 0; d < cost.size(); ++d) ranks_.note(rank_of_domain_[d], &cost[d], 1);
  ranks_.share(Ranks::Kind::results);
  return cost;
}

void DomainExchange::begin_rows(const SweepSchedule& schedule, const NodalRows& rows) {
  seconds_.assign(schedule.tasks.size(), 0);
  for (const int node : begun_elsewhere_) {
    rows.linear[node] = {};
    if (rows.angular != nullptr) rows.angular[node] = {};
  }
}

void DomainExchange::exchange_rows(SweepSchedule& schedule, const NodalRows& rows) {
  for (std::size_t t = 0; t < seconds_.size(); ++t)
    seconds_of_domain_[schedule.pieces[schedule.tasks[t].piece].domain] += seconds_[t];
  DomainSums& sums = schedule.sums;
  const std::size_t width = rows.angular != nullptr ? 2 : 1;
  const auto linear = [&](int entry) -> NodeVector& {
    return entry < 0 ? sums.linear[index(-1 - entry)] : rows.linear[entry];
  };
  const auto angular = [&](int entry) -> NodeVector& {
    return entry < 0 ? sums.angular[index(-1 - entry)] : rows.angular[entry];
  };
  messages_.clear();
  for (std::size_t rank = 0; rank < out_.size(); ++rank) {
    Entries &out = out_[rank], &in = in_[rank];
    for (std::size_t k = 0; k < out.entry.size(); ++k) {
      out.rows[k * width] = linear(out.entry[k]);
      if (width == 2) out.rows[k * width + 1] = angular(out.entry[k]);
    }
    if (!out.entry.empty() || !in.entry.empty())
      messages_.push_back({static_cast<int>(rank),
                           std::as_bytes(std::span(out.rows.data(), out.entry.size() * width)),
                           std::as_writable_bytes(std::span(in.rows.data(), in.entry.size() * width))});
  }
  ranks_.swap(Ranks::Kind::rows, messages_);
  for (const Entries& in : in_)
    for (std::size_t k = 0; k < in.entry.size(); ++k) {
      linear(in.entry[k]) = in.rows[k * width];
      if (width == 2) angular(in.entry[k]) = in.rows[k * width + 1];
    }
}

void DomainExchange::note_packs(int rank, Block& block, std::size_t first, std::size_t last) {
  ranks_.note(rank, block.state.data() + first * block.pack_bytes, (last - first) * block.pack_bytes);
  const std::size_t held = 2 * index(block.lanes);
  if (block.loses_elements) ranks_.note(rank, block.held.data() + first * held, (last - first) * held);
}

namespace {

// Places that tasks list: of_task(task, block, places).
template <class OfTask>
void for_each_list(const SweepSchedule& schedule, std::span<const SweepResult> results,
                   std::span<Block> blocks, std::size_t SweepResult::*count, AlignedBuffer<int> Block::*list,
                   const OfTask& of_task) {
  for (std::size_t t = 0; t < schedule.tasks.size(); ++t) {
    const SweepTask& task = schedule.tasks[t];
    Block& block = blocks[task.block];
    if (const std::size_t listed = results[t].*count; listed > 0)
      of_task(task, block,
              std::span((block.*list).data() + task.chunk.first_pack * index(block.lanes), listed));
  }
}

}  // namespace

void DomainExchange::share_lists(const SweepSchedule& schedule, std::span<const SweepResult> results,
                                 std::span<Block> blocks, std::size_t SweepResult::*count,
                                 AlignedBuffer<int> Block::*list) {
  for_each_list(schedule, results, blocks, count, list,
                [&](const SweepTask& task, Block& /*block*/, std::span<int> places) {
                  ranks_.note(rank_of(schedule, task), places.data(), places.size());
                });
  if (ranks_.has_noted()) ranks_.share(Ranks::Kind::results);
}

void DomainExchange::share_listed(const SweepSchedule& schedule, std::span<const SweepResult> results,
                                  std::span<Block> blocks, std::size_t SweepResult::*count,
                                  AlignedBuffer<int> Block::*list) {
  for_each_list(schedule, results, blocks, count, list,
                [&](const SweepTask& task, Block& block, std::span<int> places) {
                  const int rank = rank_of(schedule, task);
                  for (const int place : places) {
                    const std::size_t pack = index(place) / index(block.lanes);
                    note_packs(rank, block, pack, pack + 1);
                    if (!block.mass_gain.empty()) ranks_.note(rank, &block.mass_gain[index(place)], 1);
                  }
                });
  if (ranks_.has_noted()) ranks_.share(Ranks::Kind::results);
}

void DomainExchange::exchange_deleted(const SweepSchedule& schedule, std::span<const SweepResult> results,
                                      std::span<Block> blocks) {
  share_listed(schedule, results, blocks, &SweepResult::lost, &Block::lost);
}

void DomainExchange::note_results(const SweepSchedule& schedule, std::span<SweepResult> results) {
  for (std::size_t t = 0; t < schedule.tasks.size(); ++t)
    ranks_.note(rank_of(schedule, schedule.tasks[t]), &results[t], 1);
}

void DomainExchange::exchange_lists(const SweepSchedule& schedule, std::span<const SweepResult> results,
                                    std::span<Block> blocks) {
  share_lists(schedule, results, blocks, &SweepResult::lost, &Block::lost);
  exchange_deleted(schedule, results, blocks);
  share_lists(schedule, results, blocks, &SweepResult::scaled, &Block::scaled);
  share_listed(schedule, results, blocks, &SweepResult::scaled, &Block::scaled);
}

void DomainExchange::exchange_elements(const SweepSchedule& schedule, std::span<Block> blocks, bool to_all) {
  for (const DomainPiece& piece : schedule.pieces) {
    const int rank = rank_of_domain_[piece.domain];
    if (rank == Ranks::everyone) continue;
    Block& block = blocks[piece.block];
    const std::size_t packs = piece.last_pack - piece.first_pack, held = 2 * index(block.lanes);
    ranks_.hand_over(Ranks::Kind::state, rank,
                     {block.state.data() + piece.first_pack * block.pack_bytes, packs * block.pack_bytes},
                     to_all);
    if (block.loses_elements)
      ranks_.hand_over(
          Ranks::Kind::state, rank,
          std::as_writable_bytes(std::span(block.held.data() + piece.first_pack * held, packs * held)),
          to_all);
  }
}

}  // namespace brio
