#pragma once
/// Work of the impulses of constraint rows in a step, and reactions of supports and walls.

#include <span>
#include <vector>

#include "contact/enforcement/constraint_row.hpp"

namespace brio {

/// Location of a velocity block, for moments and reactions.
struct BlockPlace {
  Vector3d position{0, 0, 0};  ///< of a translation, at the beginning of the step
  bool turns = false;          ///< a rotation: its reactions are couples
  /// Of a rigid body of which some rotations are prescribed and others free; else not needed.
  const SymmetricTensor<double>* inertia = nullptr;
  bool skew = false;  ///< supports are not along the global axes
  double mass = 0;    ///< where they are not: of the block, or its rotational inertia without a tensor of it
};

/// Work J.v of all impulses J on all blocks, with the velocities v before and after the step; the mean of
/// both is the change of kinetic energy.
struct RowWork {
  double normal_before = 0;
  double normal_after = 0;
  double friction_before = 0;
  double friction_after = 0;
  /// Of the supports of prescribed components: impulses that keep these unchanged.
  double support_before = 0;
  double support_after = 0;
  Vector3d support_impulse{0, 0, 0};
  Vector3d support_moment{0, 0, 0};  ///< about the origin
  double walls = 0;                  ///< of moving walls on the bodies

  RowWork& operator+=(const RowWork& other);
};

/// Impulse of all rows at a rigid wall.
struct ImpulseOnWall {
  Vector3d impulse{0, 0, 0};
  Vector3d moment{0, 0, 0};  ///< about the origin
};

/// Adds up work and reactions, and sets the normal work of each row.
/// \param before velocities of the blocks before the step's impulses, at the half step before.
/// \param after the blocks with their velocities at the end.
/// \param walls by number; their sums are increased. \param parts working space: sums of ranges of rows
RowWork account_work(ConstraintRows& rows, std::span<const Vector3d> before,
                     std::span<const VelocityBlock> after, std::span<const BlockPlace> places,
                     std::span<ImpulseOnWall> walls, std::vector<RowWork>& parts, ThreadTeam& team);

/// Reactions of supports block by block, of which `account_work` gives the sums. \param reaction one a block;
/// they are increased
void sum_reactions(const ConstraintRows& rows, std::span<const VelocityBlock> after,
                   std::span<const BlockPlace> places, std::span<Vector3d> reaction);

}  // namespace brio
