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

/// Rank of each domain. \param cost of each; empty: by its elements
std::vector<int> deal(const SweepSchedule& schedule, std::span<const Block> blocks, int ranks,
                      std::vector<double> cost);

/// Largest load of a rank over the mean of all.
double unbalance(std::span<const int> rank_of_domain, std::span<const double> cost, int ranks);

class DomainExchange {
 public:
  /// \param ranks outlive this \param wanted nodes that every rank follows, ascending; null: all
  /// \param cost of each domain; empty: by its elements
  DomainExchange(Ranks& ranks, const SweepSchedule& schedule, std::span<const Block> blocks,
                 const std::vector<int>* wanted, std::vector<double> cost = {});

  bool is_own(std::size_t domain) const { return ranks_.is_own(rank_of_domain_[domain]); }
  Ranks& ranks() { return ranks_; }

  /// Wall time of a task; those of a sweep may come at the same time.
  void note_seconds(std::size_t task, double seconds) { seconds_[task] = seconds; }
  /// Wall time of each domain so far, known to all ranks.
  std::vector<double> measured_costs();
  std::span<const int> rank_of_domain() const { return rank_of_domain_; }

  /// Before the sweep: what stands on a node is of the rank that sweeps its first domain.
  void begin_rows(const SweepSchedule& schedule, const NodalRows& rows);
  /// After all own domains: rows of followed nodes inside of others' domains, and partial sums on borders.
  void exchange_rows(SweepSchedule& schedule, const NodalRows& rows);
  /// Before the sweep: what it finds rides with its rows.
  void note_results(const SweepSchedule& schedule, std::span<SweepResult> results);
  /// After the sweep: the elements that are deleted or get mass, where there are any.
  void exchange_lists(const SweepSchedule& schedule, std::span<const SweepResult> results,
                      std::span<Block> blocks);
  /// The state of elements to be deleted that every rank has listed: it takes out their energy and mass.
  void exchange_deleted(const SweepSchedule& schedule, std::span<const SweepResult> results,
                        std::span<Block> blocks);
  /// The state of all elements, where others than the sweep read it. \param to_all ranks, or to the first
  void exchange_elements(const SweepSchedule& schedule, std::span<Block> blocks, bool to_all);

 private:
  void note_packs(int rank, Block& block, std::size_t first, std::size_t last);
  /// Places that tasks list, and what stands there.
  void share_lists(const SweepSchedule& schedule, std::span<const SweepResult> results,
                   std::span<Block> blocks, std::size_t SweepResult::*count, AlignedBuffer<int> Block::*list);
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
  std::vector<double> seconds_;            ///< of each task of the present sweep
  std::vector<double> seconds_of_domain_;  ///< of all sweeps
};

}  // namespace brio
