#pragma once
/// What the impulses of rows did in a step: work, reactions of supports and walls.

#include <span>

#include "contact/enforcement/constraint_row.hpp"

namespace brio {

/// What a block is, for the books.
struct BlockPlace {
  Vector3<double> position{0, 0, 0};  ///< of a translation, at the beginning of the step
  bool turns = false;                 ///< a rotation: its reactions are couples
  /// Of a rigid body of which some rotations are prescribed and others free; else not needed.
  const SymmetricTensor<double>* inertia = nullptr;
};

/// Work is that of all impulses J on all blocks, J.v with the velocities before and after the step; the mean
/// of both is what motion gained (negative: lost).
struct RowWork {
  double normal_before = 0;
  double normal_after = 0;
  double friction_before = 0;
  double friction_after = 0;
  /// Of the supports of prescribed components: what they do to keep these as they are.
  double support_before = 0;
  double support_after = 0;
  Vector3<double> support_impulse{0, 0, 0};
  Vector3<double> support_moment{0, 0, 0};  ///< about the origin
};

/// What rows gave a wall.
struct PushOnWall {
  Vector3<double> impulse{0, 0, 0};
  Vector3<double> moment{0, 0, 0};  ///< about the origin
  double work = 0;                  ///< of the wall on what it pushes
};

/// Sets the normal work of rows as well.
/// \param before velocities of the blocks before the step's impulses, at the half step before.
/// \param after the blocks with their velocities at the end.
/// \param walls by number; sums are added to what they hold.
RowWork book(ConstraintRows& rows, std::span<const Vector3<double>> before,
             std::span<const VelocityBlock> after, std::span<const BlockPlace> places,
             std::span<PushOnWall> walls);

}  // namespace brio
