#pragma once
/// How often a closed surface winds around a point: 1 inside, 0 outside, whatever its faces look like.

#include <cmath>
#include <numbers>

#include "contact/geometry/closest_point.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// Deeper than this share of an edge something is inside; overlaps are removed to rounding.
inline constexpr double deep_share = 0.1;

/// Signed solid angle of a triangle, as a share of the full sphere (Van Oosterom and Strackee 1983).
inline double solid_angle_share(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = norm(a), lb = norm(b), lc = norm(c);
  const double volume = dot(a, cross(b, c));
  const double sum = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return std::atan2(volume, sum) / (2 * std::numbers::pi);
}

/// What one face adds to the winding number of a point.
inline double winding_share(const FaceVertices& v, const Vector3d& x) {
  if (is_triangle(v)) return solid_angle_share(v[0] - x, v[1] - x, v[2] - x);
  const Vector3d middle = 0.25 * ((v[0] - x) + (v[1] - x) + (v[2] - x) + (v[3] - x));
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += solid_angle_share(middle, v[k] - x, v[(k + 1) % 4] - x);
  return sum;
}

}  // namespace brio
