#pragma once
/// What ranks that sweep different domains tell each other, so that every rank goes on with the same bits:
/// sums of nodal rows, results of chunks, and the state of elements where it is read outside of the sweep.
/// Domains of particles are swept by all.

#include <cstddef>
#include <span>
#include <vector>

#include "src/domains/ranks.hpp"
#include "src/domains/schedule.hpp"

namespace brio {

class DomainExchange {
 public:
  /// \param ranks outlive this \param wanted nodes that every rank follows, ascending; null: all
  DomainExchange(Ranks& ranks, const SweepSchedule& schedule, std::span<const Block> blocks,
                 const std::vector<int>* wanted);

  bool is_own(std::size_t domain) const { return ranks_.is_own(rank_of_domain_[domain]); }
  int rank_of(std::size_t domain) const { return rank_of_domain_[domain]; }
  Ranks& ranks() { return ranks_; }

  /// Before the sweep: what stands on a node is of the rank that sweeps its first domain.
  void begin_rows(const NodalRows& rows) const;
  /// After all own domains: rows of followed nodes inside of others' domains, and partial sums on borders.
  void exchange_rows(DomainSums& sums, const NodalRows& rows);
  /// After the sweep: what it found, with the elements that are deleted or get mass.
  void exchange_results(const SweepSchedule& schedule, std::span<SweepResult> results,
                        std::span<Block> blocks);
  /// The state of all elements, where others than the sweep read it. \param to_all ranks, or to the first
  void exchange_elements(const SweepSchedule& schedule, std::span<Block> blocks, bool to_all);

 private:
  void note_packs(int rank, Block& block, std::size_t first, std::size_t last);
  void share_listed(const SweepSchedule& schedule, std::span<const SweepResult> results,
                    std::span<Block> blocks, std::size_t SweepResult::*count,
                    AlignedBuffer<int> Block::*list);
  int rank_of(const SweepSchedule& schedule, const SweepTask& task) const {
    return rank_of_domain_[schedule.pieces[task.piece].domain];
  }

  /// Rows that this rank sends to another, or gets from it.
  struct Entries {
    std::vector<int> entry;  ///< nodes, and slots as -1 - slot
    AlignedBuffer<NodeVector> rows;
  };

  Ranks& ranks_;
  std::vector<int> rank_of_domain_;
  std::vector<int> begun_elsewhere_;  ///< nodes on borders whose first domain is of another rank
  std::vector<Entries> out_, in_;     ///< by rank
  std::vector<Ranks::Message> messages_;
};

}  // namespace brio
