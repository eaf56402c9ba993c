#pragma once
/// Closest point of a face as a feature: of its hull, or among neighbours of one piece of its two triangles.

#include "contact/geometry/closest_on_hull.hpp"
#include "contact/geometry/closest_point.hpp"
#include "src/base/tensor.hpp"

namespace brio {

struct HullPoint {
  Vector3d offset;                  ///< node minus closest point
  std::array<double, 4> weights{};  ///< of the corners
  double squared_distance = 0;      ///< 0 inside of the hull
};

inline HullPoint closest_on_face(const Vector3d& x, const FaceVertices& at, bool as_hull) {
  if (as_hull) {
    const ClosestOnHull<double> found = closest_on_hull<double>(x, {at[0], at[1], at[2], at[3]});
    return {found.offset, found.weights, found.squared_distance};
  }
  const TrianglePoint first = closest_point_on_triangle(x, {at[0], at[1], at[2]});
  const TrianglePoint second = closest_point_on_triangle(x, {at[0], at[2], at[3]});
  if (is_triangle(at) || first.squared_distance <= second.squared_distance)
    return {-first.offset, {first.weights[0], first.weights[1], first.weights[2], 0}, first.squared_distance};
  return {
      -second.offset, {second.weights[0], 0, second.weights[1], second.weights[2]}, second.squared_distance};
}

}  // namespace brio
