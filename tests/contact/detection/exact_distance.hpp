#pragma once
/// Distances of points, triangles, hulls and segments without rounding: the given doubles are rational
/// numbers, the squares of distances are fractions of integers.

#include <array>
#include <vector>

#include "contact/geometry/closest_point.hpp"
#include "contact/geometry/closest_segments.hpp"
#include "tests/contact/geometry/exact_geometry.hpp"

namespace brio::exact {

/// The square of a distance in the unit of `scaled`; the denominator is positive.
struct SquaredDistance {
  Integer numerator, denominator;
  Scaled scaled;

  bool at_most(double distance) const;  // the distance itself; never for a negative one
  bool at_least(double distance) const;
};

SquaredDistance to_triangle(const Vector3d& node, const std::array<Vector3d, 3>& vertices);
/// To the nearest of the four triangles: for a node inside of the hull that to its surface.
SquaredDistance to_hull_surface(const Vector3d& node, const FaceVertices& vertices);
SquaredDistance between_segments(const Segment& a, const Segment& b);

/// Strictly inside of the hull, with volumes of the node and each triangle above `share` of the cube of the
/// largest component of a difference between the node and a vertex.
bool is_inside_hull(const Vector3d& node, const FaceVertices& vertices, double share = 0);

/// min over pairs of d . (p - q) >= value.
bool separated_by(const Vector3d& d, const std::vector<Vector3d>& first, const std::vector<Vector3d>& second,
                  double value);

}  // namespace brio::exact
