#pragma once
/// Geometry of one tie: a node constrained to a point of a face.
///
/// The point has fixed coordinates in the face, bilinear in a quadrilateral, linear in a triangle. The
/// distance of the node from it is constant relative to the face:
///
///   on a face without rotations          x = sum w_k x_k + gap n(x_1 .. x_4), n the unit normal there;
///   on a face with rotations (shells)    x = sum w_k x_k + arm, the arm rotating with sum w_k omega_k.
///
/// A force on the node goes to the corners by the transpose of the derivative of this map, so that virtual
/// power is the same; and since a rigid motion of all corners moves the node rigidly, force and moment are
/// the same too.

#include <array>
#include <optional>

#include "contact/geometry/closest_point.hpp"
#include "src/base/tensor.hpp"

namespace brio {

struct Tie {
  int node = 0;                             ///< global
  std::array<int, 4> corner{};              ///< global; a triangle repeats its third, with no weight
  std::array<double, 4> weight{};           ///< their sum is 1
  std::array<double, 4> along{}, across{};  ///< derivatives of the weights by the coordinates in the face
  double gap = 0;                           ///< along the normal; 0 where there is an arm
  Vector3d arm{};                           ///< from the point to the node; 0 where there is a gap
  bool turning = false;                     ///< constrained to the rotations of the corners as well

  bool has_arm() const { return turning && !is_zero(arm); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(node, corner, weight, along, across, gap, arm, turning);
  }
};

/// Tolerance beyond an edge of a face, in coordinates of the face from 0 to 1, so that nodes at a rim or over
/// a ridge are found in spite of rounding and facets.
inline constexpr double beyond_edge = 0.05;

/// Weights, derivatives and gap of the point of a face whose normal passes through a node.
/// \returns nothing where that point lies outside of the face.
std::optional<Tie> project(const Vector3d& node, const FaceVertices& face);

/// Unit normal of the face at the point.
Vector3d normal_at(const Tie& tie, const FaceVertices& face);

/// Rate of the normal by the velocities of the corners.
Vector3d normal_rate(const Tie& tie, const FaceVertices& face, const FaceVertices& velocity);

/// The point of the face.
Vector3d point_on(const Tie& tie, const FaceVertices& face);

/// Position of the tied node.
Vector3d tied_position(const Tie& tie, const FaceVertices& face);

/// Forces on the corners with the power of a force on the node.
/// \pre not turning: an arm adds a moment on the corners, arm x force times each weight
std::array<Vector3d, 4> spread(const Tie& tie, const FaceVertices& face, const Vector3d& force);

/// Bounds of the speed of the node for a unit velocity of each corner.
std::array<double, 4> largest_share(const Tie& tie, const FaceVertices& face);

/// A vector turned by a rotation vector.
Vector3d turned_by(const Vector3d& rotation, const Vector3d& vector);

}  // namespace brio
