#pragma once
/// Distances of the audit (Ericson 2005, "Real-time collision detection", 5.1).

#include <array>

#include "src/base/tensor.hpp"

namespace brio {

/// Of the contact distance (of nodes and faces: or the shortest edge, if that is less): what is less than
/// this too close does not count.
inline constexpr double tolerated_closeness = 0.1;

/// From a point to a triangle, squared.
double squared_distance_to_triangle(const Vector3d& x, const Vector3d& a, const Vector3d& b,
                                    const Vector3d& c);

/// From a point to a face: of a quadrilateral, to the four triangles around its mean.
/// \param corners 3 or 4
double distance_to_face(const Vector3d& x, const std::array<Vector3d, 4>& face, int corners);

/// Closest points of two segments.
struct SegmentDistance {
  double distance = 0;
  std::array<double, 2> parameter{};  ///< along each, from 0 to 1

  bool inside(std::size_t segment) const { return parameter[segment] > 0 && parameter[segment] < 1; }
};
/// \param first, second ends; the same twice: a point
SegmentDistance distance_of_segments(const std::array<Vector3d, 2>& first,
                                     const std::array<Vector3d, 2>& second);

}  // namespace brio
