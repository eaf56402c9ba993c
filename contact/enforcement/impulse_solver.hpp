#pragma once
/// Impulses of all constraint rows at once, by the accelerated projected gradient method.
///
/// Each row requires of the velocities at the end of the step that
///     u_n >= target,   impulse >= 0,   one of both an equality,
/// and Coulomb friction: the tangential impulse lies within the disk of radius friction coefficient times
/// impulse and opposes sliding on its rim. The disk is that of the impulse just found, so that sliding causes
/// no separation (no associated cone).
///
/// An iteration takes the velocities v = v_free + M^-1 G^T y of extrapolated impulses y, and
///     impulse <- max(0, y_n - (u_n - target) / D),   friction <- disk(y_t - u_t / D),
/// then extrapolates anew (Nesterov 1983; for contact Mazhar, Heyn, Negrut and Tasora 2015), without momentum
/// where the step turned against the gradient (restart of O'Donoghue and Candes 2015). The result does not
/// depend on the order of rows (unlike Gauss-Seidel), so mirror-symmetric scenes stay symmetric; impulses
/// reach a block by a gather in the order of rows, so bits do not depend on threads.
///
/// D is a majorant: for any impulses J, J . A J <= sum D_i |J_i|^2 with A = G M^-1 G^T. Let B_e be the entry
/// e of row i(e), a map of a block's velocity, W the inverse mass of the block, s_i c_e >= |W^(1/2) B_e^T|
/// with any scale s_i of the row. By Cauchy and Schwarz, over the entries of one block,
///     |sum W^(1/2) B_e^T J_i(e)|^2 <= (sum c_e s_i(e) |J_i(e)|)^2 <= S sum c_e s_i(e)^2 |J_i(e)|^2,
/// where S = sum c_e, and the sum over blocks gives D_i = s_i^2 sum over the entries of row i of c_e S: row
/// sums of the matrix scaled by s. With the root of the row's own inverse mass as
/// scale all c_e are at most one, and a row is not slowed down by others of far larger mass at the same
/// block. A step is stable whatever the number of rows at a block, and changes impulses by a symmetric matrix
/// times the residual: an unfinished iteration only dissipates energy. The extrapolation may overshoot: where
/// the impulses of an island would add energy beyond the target velocities, they are scaled down until they
/// add none.
///
/// Rows that share no block that can move, nor are joined by others, are islands: each has its own momentum,
/// restarts and convergence, so that they do not affect each other, and an island at rest costs one
/// check. Small ones are solved in parallel, each by one thread. Where few rows of an island still change,
/// they are solved alone, the others fixed, as islands of their own with majorants of their own; then all
/// rows are iterated again: an island has converged once an iteration of all its rows changes none.

#include <cstddef>
#include <span>
#include <vector>

#include "contact/enforcement/constraint_row.hpp"
#include "contact/enforcement/entry_lists.hpp"
#include "contact/enforcement/islands.hpp"
#include "contact/enforcement/row_pack.hpp"
#include "src/base/parallel.hpp"

namespace brio {

struct SolveOptions {
  int max_iterations = 50;
  /// Converged once no relative velocity changes by more than this fraction of the largest that corresponds
  /// to an impulse.
  double tolerance = 1e-4;
};

/// Of all islands together.
struct SolveReport {
  int iterations = 0;  ///< most of an island
  int restarts = 0;
  double residual = 0;          ///< largest change of a relative velocity in the last iteration
  double largest_velocity = 0;  ///< corresponding to an impulse
  bool converged = true;
  int islands = 0;
  std::size_t row_iterations = 0;  ///< iterations times rows, summed over islands
};

class ImpulseSolver {
 public:
  /// Solve for the impulses, starting from those of the rows, and add their effect to the velocities of the
  /// blocks.
  SolveReport solve(const SolveOptions& options, ConstraintRows& rows, std::span<VelocityBlock> blocks,
                    ThreadTeam& team);

  /// The same after rows, or blocks, have been added to those of the last solve: from the impulses so far,
  /// with the free velocities of then (of new blocks: those that they have).
  SolveReport solve_further(const SolveOptions& options, ConstraintRows& rows,
                            std::span<VelocityBlock> blocks, ThreadTeam& team);

 private:
  static constexpr std::uint32_t no_row = ~std::uint32_t{0};
  static constexpr std::uint32_t lanes = lane_count<double>;
  /// Rows, packs and blocks of a task: whatever the number of threads.
  static constexpr std::size_t rows_a_task = 512, packs_a_task = 64, blocks_a_task = 512;
  /// How a row is worked on.
  enum Kind : std::uint8_t { normal_only, with_friction, general, kinds };
  /// Rows of about as many entries are put side by side, kind after kind.
  enum Class : std::uint8_t {
    sliding,
    sliding_turning,
    rubbing,
    one_turning_2,  ///< one rotation (a rigid body), up to two translations
    one_turning_3,
    one_turning,
    some_turning,  ///< up to three rotations
    turning,
    tilting_5,  ///< up to five translations
    tilting_8,
    tilting,
    with_matrix,
    classes
  };
  static Class class_of(const ConstraintRow& row, bool tilted);
  static constexpr Kind kind_of(std::uint8_t row_class) {
    return row_class == with_matrix ? general : row_class >= rubbing ? with_friction : normal_only;
  }
  static constexpr bool tilts(std::uint8_t row_class) { return row_class >= tilting_5; }
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

  /// Slots are eight a pack, of one kind and island.
  struct Pack {
    Kind kind;
    std::uint32_t place;  ///< among those of its kind
  };
  struct Island {
    std::uint32_t pack_begin, pack_end;
    std::uint32_t block_begin, block_end;  ///< in block_order_
    std::uint32_t rows;
    double tolerated = -1;  ///< change of a relative velocity; negative: as the options say
    bool has_new = true;    ///< impulses that no iteration of all rows has seen
  };
  /// A step of an iteration.
  struct Step {
    double momentum = 0;
    double counted = 0;  ///< squared change of relative velocity from which on rows are counted
  };
  /// Rows that are solved without the others.
  struct Unconverged;

  void prepare(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void measure_blocks(std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void measure_rows(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void assign_slots(const ConstraintRows& rows);
  void order_blocks(std::size_t blocks);
  void list_entries(const ConstraintRows& rows, std::size_t blocks, ThreadTeam& team);
  void sum_block_norms(const ConstraintRows& rows, std::size_t blocks, ThreadTeam& team);
  void fill_rows(const ConstraintRows& rows, ThreadTeam& team);
  void reserve_entries(const ConstraintRows& rows, ThreadTeam& team);
  template <bool friction>
  void fill_lane(std::vector<RowPack<friction>>& packs, const ConstraintRows& rows, std::uint32_t slot);
  void clear_entries(const ConstraintRows& rows, std::size_t pack, EntryRange translation, EntryRange tilt,
                     EntryRange rotation);
  template <bool friction>
  void fill_pack(std::vector<RowPack<friction>>& packs, const ConstraintRows& rows, std::uint32_t pack);
  void fill_general(const ConstraintRows& rows, std::uint32_t slot);

  static void velocity_of(const ConstraintRows& rows, const ConstraintRow& row,
                          const std::vector<BlockVelocity>& blocks, double (&velocity)[3]);
  void change_general(const ConstraintRows& rows, const Step& step, std::uint32_t pack, Sums& sums);
  Sums change_packs(const ConstraintRows& rows, const Step& step, std::uint32_t begin, std::uint32_t end);
  Sums change_impulses(const ConstraintRows& rows, const Island& island, const Step& step, ThreadTeam* team);
  void store_given(const ConstraintRows& rows, std::uint32_t pack);
  Row4 given_to(const ConstraintRows& rows, std::size_t block) const;
  void gather(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, const Island& island,
              double momentum, ThreadTeam* team);
  void iterate(const SolveOptions& options, const ConstraintRows& rows, std::span<const VelocityBlock> blocks,
               std::size_t island, ThreadTeam* team);
  void iterate_islands(const SolveOptions& options, const ConstraintRows& rows,
                       std::span<const VelocityBlock> blocks, ThreadTeam& team);
  bool solve_unconverged(const SolveOptions& options, const ConstraintRows& rows,
                         std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void select_unconverged(const SolveOptions& options, const ConstraintRows& rows,
                          std::span<const VelocityBlock> blocks, Unconverged& unconverged);
  void solve_alone(const SolveOptions& options, ConstraintRows& rows, std::span<VelocityBlock> blocks,
                   std::span<const double> tolerated, ThreadTeam& team);
  void take_over(const ConstraintRows& rows, const Unconverged& unconverged);
  double tolerated(const SolveOptions& options, std::size_t island) const;
  bool goes_on(const SolveOptions& options, std::size_t island) const;
  void add_free(std::span<const VelocityBlock> blocks);
  void begin(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, ThreadTeam& team);
  /// `visit(unknown, lane)`.
  template <class Visit>
  void at_slot(std::uint32_t slot, Visit&& visit);
  template <class VisitPack, class VisitRow>
  void each_row(const ConstraintRows& rows, const Island& island, const VisitPack& visit_pack,
                const VisitRow& visit_row);
  void take_excess(const ConstraintRows& rows, const Island& island);
  void store(ConstraintRows& rows, std::span<VelocityBlock> blocks, ThreadTeam& team) const;

  std::vector<RowPack<false>> normal_packs_;
  std::vector<RowPack<true>> friction_packs_;
  std::vector<RowUnknowns<double, true>> general_;  ///< as many as lanes a pack
  PackEntries entries_;
  std::vector<Pack> pack_;
  std::vector<Island> island_;
  std::vector<RowImpulse> given_;  ///< by slot

  std::vector<std::uint8_t> class_;  ///< by row
  std::vector<std::uint32_t> slot_;  ///< by row
  std::vector<std::uint32_t> row_of_slot_;
  std::vector<std::uint32_t> mover_;  ///< by row: a block that it moves, then its island
  std::uint32_t packs_of_kind_[kinds] = {};
  std::vector<double> squared_scale_;  ///< s^2 of each row
  IslandFinder finder_;
  std::vector<std::uint32_t> count_;        ///< rows by island and class, then the next slot
  std::vector<std::uint32_t> block_order_;  ///< blocks that rows move, island by island

  EntryLists<TranslationItem> translation_;
  EntryLists<TiltedItem> tilted_;  ///< of rows with tilt, and of general ones
  EntryLists<OtherItem> rotation_, matrix_;
  std::vector<double> norm_;         ///< c of each entry: translations, rotations, matrices
  std::vector<double> block_norm_;   ///< S of each block
  std::vector<double> block_bound_;  ///< bound of |W|; negative where W is not a multiple of one

  std::vector<BlockVelocity> free_, now_, extrapolated_;  ///< by block
  std::vector<Sums> sums_;                                ///< by task of a large island
  std::vector<SolveReport> report_;                       ///< by island
  std::vector<std::uint32_t> small_;                      ///< first of each group of small islands
  std::vector<Unconverged> unconverged_;                  ///< none or one
};

struct ImpulseSolver::Unconverged {
  void clear();
  /// A copy of the row, with the impulses that it has. \param velocities of the blocks.
  void add(const ConstraintRows& from, std::uint32_t row, const double (&impulse)[3], double tolerated,
           std::span<const VelocityBlock> blocks, std::span<const BlockVelocity> velocities);
  /// Without what the rows do to the velocities of the blocks.
  void take_impulses_off();

  ConstraintRows rows;
  std::vector<std::uint32_t> row;  ///< which they are
  std::vector<double> tolerated;   ///< by row
  std::vector<VelocityBlock> blocks;
  std::vector<std::uint32_t> block;   ///< which they are
  std::vector<std::uint32_t> number;  ///< of each block, or none
  ImpulseSolver solver;
};

}  // namespace brio
