#pragma once
/// Impulses of all constraint rows at once, by accelerated projected gradients.
///
/// Each row requires of the velocities at the end of the step that
///     u_n >= target,   impulse >= 0,   one of both an equality,
/// and Coulomb's law of friction: the tangential impulse lies within the disk of radius friction coefficient
/// times impulse and opposes sliding on its rim. The disk is that of the impulse just found, so what slides
/// does not lift (no cone of associated flow).
///
/// An iteration takes the velocities v = v_free + M^-1 G^T y of extrapolated impulses y, and
///     impulse <- max(0, y_n - (u_n - target) / D),   friction <- disk(y_t - u_t / D),
/// then extrapolates anew (Nesterov 1983; for contact Mazhar, Heyn, Negrut and Tasora 2015), without momentum
/// where the step turned against the gradient (restart of O'Donoghue and Candes 2015). There is no order of
/// rows, so mirror-symmetric scenes stay symmetric; impulses reach a block by a gather in the order of rows,
/// so bits do not depend on threads.
///
/// D is a majorant: for any impulses J, J . A J <= sum D_i |J_i|^2 with A = G M^-1 G^T. Let B_e be the entry
/// e of row i(e), a map of a block's velocity, W the inverse mass of the block, s_i c_e >= |W^(1/2) B_e^T|
/// with any scale s_i of the row. By Cauchy and Schwarz, over the entries of one block,
///     |sum W^(1/2) B_e^T J_i(e)|^2 <= (sum c_e s_i(e) |J_i(e)|)^2 <= S sum c_e s_i(e)^2 |J_i(e)|^2,
/// where S = sum c_e, and the sum over blocks gives D_i = s_i^2 sum over the entries of row i of c_e S: row
/// sums of the matrix scaled by s. As scale serves the root of the row's own inverse mass, which makes all
/// c_e shares of one, so that a row whose block bears others of far more weight is not slowed down by them.
/// A step is stable whatever the number of rows at a block, and changes impulses by a symmetric matrix times
/// what is missing: a lag only takes energy.

#include <cstddef>
#include <span>
#include <vector>

#include "contact/enforcement/constraint_row.hpp"
#include "contact/enforcement/entry_lists.hpp"
#include "contact/enforcement/row_pack.hpp"
#include "src/base/parallel.hpp"

namespace brio {

struct SolveOptions {
  int max_iterations = 50;
  /// Converged once no relative velocity changes by more than this share of the largest that an impulse
  /// stands for.
  double tolerance = 1e-4;
};

struct SolveReport {
  int iterations = 0;
  int restarts = 0;
  double residual = 0;          ///< largest change of a relative velocity in the last iteration
  double largest_velocity = 0;  ///< that an impulse stands for
  bool converged = true;
};

class ImpulseSolver {
 public:
  /// Start from the impulses of the rows, find those that the rows require and add what they do to the
  /// velocities of the blocks.
  SolveReport solve(const SolveOptions& options, ConstraintRows& rows, std::span<VelocityBlock> blocks,
                    ThreadTeam& team);

  /// The same after rows, or blocks, have been added to those of the last solve: from the impulses so far,
  /// with the free velocities of then (of new blocks: those that they have).
  SolveReport solve_further(const SolveOptions& options, ConstraintRows& rows,
                            std::span<VelocityBlock> blocks, ThreadTeam& team);

 private:
  /// How a row is worked on; slots are given to one kind after the other.
  static constexpr std::uint32_t no_row = ~std::uint32_t{0};
  static constexpr std::size_t slots_a_task = 512;
  enum Kind : std::uint8_t { normal_only, with_friction, with_tilt, general, kinds };
  using Sums = RowSums<double>;

  struct alignas(32) BlockVelocity {
    double component[4];
  };
  /// An entry at its block, with the slot of its row.
  struct TranslationItem {
    std::uint32_t slot;
    std::uint32_t entry;
    double weight;
  };
  struct TiltedItem {
    std::uint32_t slot;
    std::uint32_t entry;
    double weight;
    double tilt[2];
  };
  struct OtherItem {
    std::uint32_t slot;
    std::uint32_t entry;
  };

  void prepare(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void measure_blocks(std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void measure_rows(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void assign_slots(const ConstraintRows& rows, ThreadTeam& team);
  void list_entries(const ConstraintRows& rows, std::size_t blocks, ThreadTeam& team);
  void sum_block_norms(const ConstraintRows& rows, std::size_t blocks, ThreadTeam& team);
  void fill_rows(const ConstraintRows& rows, ThreadTeam& team);
  template <bool friction, bool tilt>
  void fill_lane(std::vector<RowPack<friction, tilt>>& packs, const ConstraintRows& rows, std::size_t row);

  void fill_general(const ConstraintRows& rows, std::size_t row);
  void store_given(const ConstraintRows& rows, Kind kind, std::size_t begin, std::size_t end);

  std::size_t slot_ranges() const;
  /// `visit(kind, begin, end, range)` for ranges of slots of one kind, from and to whole packs.
  template <class Visit>
  void each_slot_range(ThreadTeam& team, Visit&& visit) const;
  Sums change_general(const ConstraintRows& rows, double momentum, std::size_t begin, std::size_t end);
  Sums change_impulses(const ConstraintRows& rows, double momentum, ThreadTeam& team);
  void gather(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, double momentum,
              ThreadTeam& team);
  void store(ConstraintRows& rows, std::span<VelocityBlock> blocks, ThreadTeam& team) const;

  std::vector<RowPack<false, false>> normal_packs_;
  std::vector<RowPack<true, false>> friction_packs_;
  std::vector<RowPack<true, true>> tilt_packs_;
  std::vector<RowUnknowns<double, true>> general_;
  std::size_t first_slot_[kinds + 1] = {};
  std::vector<RowImpulse> given_;  ///< by slot

  std::vector<Kind> kind_;           ///< by row
  std::vector<std::uint32_t> slot_;  ///< by row
  std::vector<std::uint32_t> row_of_slot_;
  std::vector<double> scale_;  ///< s of each row
  std::vector<std::uint32_t> kind_count_;

  EntryLists<TranslationItem> translation_;
  EntryLists<TiltedItem> tilted_;  ///< of rows with tilt, and of general ones
  EntryLists<OtherItem> rotation_, matrix_;
  std::vector<double> norm_;        ///< c of each entry: translations, rotations, matrices
  std::vector<double> block_norm_;  ///< S of each block
  std::vector<double> block_root_;  ///< bound of |W^(1/2)|; negative where W is not a multiple of one

  std::vector<BlockVelocity> free_, now_, extrapolated_;  ///< by block
  std::vector<Sums> sums_;                                ///< by range of slots
};

inline std::size_t ImpulseSolver::slot_ranges() const {
  std::size_t ranges = 0;
  for (std::size_t kind = 0; kind < kinds; ++kind)
    ranges += (first_slot_[kind + 1] - first_slot_[kind] + slots_a_task - 1) / slots_a_task;
  return ranges;
}

template <class Visit>
void ImpulseSolver::each_slot_range(ThreadTeam& team, Visit&& visit) const {
  team.for_each(slot_ranges(), [&](std::size_t range) {
    std::size_t own = range;
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const std::size_t last = first_slot_[kind + 1];
      const std::size_t ranges = (last - first_slot_[kind] + slots_a_task - 1) / slots_a_task;
      if (own < ranges) {
        const std::size_t begin = first_slot_[kind] + own * slots_a_task;
        visit(static_cast<Kind>(kind), begin, begin + slots_a_task < last ? begin + slots_a_task : last,
              range);
        return;
      }
      own -= ranges;
    }
  });
}

}  // namespace brio
