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
  /// \param ranks outlive this
  DomainExchange(Ranks& ranks, const SweepSchedule& schedule, std::span<const Block> blocks);

  bool is_own(std::size_t domain) const {
    const int rank = rank_of_domain_[domain];
    return rank == ranks_.number() || rank == everyone;
  }

  /// After all own domains: rows of nodes inside of others' domains, and their partial sums on borders.
  void exchange_rows(DomainSums& sums, const NodalRows& rows);
  /// After the sweep: what it found, with the elements that are deleted or get mass.
  void exchange_results(const SweepSchedule& schedule, std::span<SweepResult> results,
                        std::span<Block> blocks);
  /// The state of all elements, where others than the sweep read it.
  void exchange_elements(const SweepSchedule& schedule, std::span<Block> blocks);

 private:
  static constexpr int everyone = -1;

  /// Memory that is the same on all ranks once it was exchanged.
  struct Shared {
    int rank;  ///< that has it
    std::byte* data;
    std::size_t bytes;
  };
  template <class T>
  void share(int rank, T* data, std::size_t count);
  void share_packs(int rank, Block& block, std::size_t first, std::size_t last);
  void share_listed(const SweepSchedule& schedule, std::span<const SweepResult> results,
                    std::span<Block> blocks, std::size_t SweepResult::*count,
                    AlignedBuffer<int> Block::*list);
  int rank_of(const SweepSchedule& schedule, const SweepTask& task) const {
    return rank_of_domain_[schedule.pieces[task.piece].domain];
  }
  /// All that is listed, and forget it.
  void exchange();

  Ranks& ranks_;
  std::vector<int> rank_of_domain_;
  std::vector<int> entries_;              ///< by rank: nodes, and slots as -1 - slot
  std::vector<std::size_t> entry_first_;  ///< of each rank
  AlignedBuffer<NodeVector> rows_;
  std::vector<Shared> shared_;
  std::vector<std::byte> bytes_;
  std::vector<std::size_t> first_, next_;  ///< of each rank in what is exchanged
};

}  // namespace brio
