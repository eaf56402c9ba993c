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
  /// One row in its frame (normal, two tangents).
  struct RowState {
    double impulse[3];
    double last[3];    ///< an iteration before
    double offset[3];  ///< relative velocity of the blocks that is asked for
    double majorant;   ///< 0: nothing can move
    double friction_coefficient;
  };
  /// Impulse of a row as blocks need it.
  struct alignas(64) RowImpulse {
    Vector3<double> force;
    double slope[2];  ///< components of the force along the tangents
    Vector3<double> normal;
  };
  struct BlockMotion {
    Vector3<double> free;
    Vector3<double> now;
    Vector3<double> extrapolated;
  };
  /// Entry of a row at its block.
  struct Incoming {
    std::uint32_t row;
    std::uint32_t entry;
  };
  /// Lists of entries by block, in the order of rows.
  struct IncomingLists {
    std::vector<std::uint32_t> first;
    std::vector<Incoming> item;
  };
  struct Sums {
    double turned = 0;
    double residual = 0;
    double largest = 0;
  };

  void prepare(ConstraintRows& rows, std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void find_majorants(ConstraintRows& rows, std::span<const VelocityBlock> blocks, ThreadTeam& team);
  void start_row(const ConstraintRow& row, RowState& state, RowImpulse& given) const;
  Sums change_impulses(const ConstraintRows& rows, double momentum, ThreadTeam& team);
  void gather(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, double momentum,
              ThreadTeam& team);
  SolveReport iterate(const SolveOptions& options, ConstraintRows& rows, std::span<VelocityBlock> blocks,
                      ThreadTeam& team);

  std::vector<RowState> state_;
  std::vector<RowImpulse> given_;
  std::vector<BlockMotion> motion_;
  IncomingLists translation_, rotation_, matrix_;
  std::vector<double> norm_;        ///< c of each entry: translations, rotations, matrices
  std::vector<double> block_norm_;  ///< S of each block
  std::vector<Sums> sums_;
};

}  // namespace brio
