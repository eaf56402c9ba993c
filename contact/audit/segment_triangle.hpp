#pragma once
/// Does a segment cross a triangle, and by how much: the predicate of the audit. It knows no sides.

#include <array>

#include "src/base/tensor.hpp"

namespace brio {

/// Where the surface continues beyond a triangle, within 20 degrees: what goes through there goes through the
/// surface. Elsewhere it has a sharp edge or an end.
struct Continuation {
  std::array<bool, 3> edge{};    ///< across the edge from corner k to the next
  std::array<bool, 3> corner{};  ///< across every edge around corner k
};

/// A triangle of the surface with its plane.
struct SurfaceTriangle {
  std::array<Vector3d, 3> corner;
  Continuation continues;
  Vector3d area{};       ///< normal, of twice the area of the triangle
  Vector3d permanent{};  ///< that of the absolute values, for error bounds
  double twice_area = 0;

  SurfaceTriangle() = default;
  SurfaceTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Continuation& continues);

  /// Six times the volume over the triangle, positive on the side of the normal, with its error bound.
  struct Volume {
    double value = 0;
    double error = 0;
  };
  Volume volume(const Vector3d& x) const {
    const Vector3d from = x - corner[0];
    return {dot(from, area), 0x1p-50 * dot(absolute(from), permanent)};
  }
};

/// Whether the open segment crosses the triangle, as in exact arithmetic: its ends lie on different sides of
/// the plane, neither in it, and it passes the triangle inside, or through an edge or corner across which the
/// surface continues. A touch of an end, an edge or a corner of the surface is no crossing.
bool crosses(const Vector3d& from, const Vector3d& to, const SurfaceTriangle& triangle);

/// Length of the shortest translation that ends a crossing: past an end of the segment, or past an edge or
/// corner of the triangle where the surface does not continue. \pre crosses(from, to, triangle)
double crossing_depth(const Vector3d& from, const Vector3d& to, const SurfaceTriangle& triangle);

}  // namespace brio
