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

  /// After all own domains: rows of followed nodes inside of others' domains, and partial sums on borders.
  void exchange_rows(DomainSums& sums, const NodalRows& rows);
  /// After the sweep: what it found, with the elements that are deleted or get mass.
  void exchange_results(const SweepSchedule& schedule, std::span<SweepResult> results,
                        std::span<Block> blocks);
  /// The state of all elements, where others than the sweep read it.
  void exchange_elements(const SweepSchedule& schedule, std::span<Block> blocks);
  /// Bytes that the rows of a sweep take.
  std::size_t bytes_of_rows() const { return rows_.size() * sizeof(NodeVector); }

 private:
  void note_packs(int rank, Block& block, std::size_t first, std::size_t last);
  void share_listed(const SweepSchedule& schedule, std::span<const SweepResult> results,
                    std::span<Block> blocks, std::size_t SweepResult::*count,
                    AlignedBuffer<int> Block::*list);
  int rank_of(const SweepSchedule& schedule, const SweepTask& task) const {
    return rank_of_domain_[schedule.pieces[task.piece].domain];
  }

  Ranks& ranks_;
  std::vector<int> rank_of_domain_;
  std::vector<int> entries_;              ///< by rank: nodes, and slots as -1 - slot
  std::vector<std::size_t> entry_first_;  ///< of each rank
  AlignedBuffer<NodeVector> rows_;
  std::vector<std::size_t> first_;  ///< byte of each rank in `rows_`
};

}  // namespace brio
