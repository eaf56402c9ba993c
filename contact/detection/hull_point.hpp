#pragma once
#include <limits>
#include "contact/closest_point.hpp"
namespace brio {
struct HullPoint {
  Eigen::Vector3d offset;
  std::array<double, 4> weights{};
  double squared_distance = 0;
};
inline HullPoint closest_on_hull(const Eigen::Vector3d& x, const FaceVertices& at) {
  constexpr std::size_t corner[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  HullPoint best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  const std::size_t triangles = is_triangle(at) ? 1 : 4;
  for (std::size_t t = 0; t < triangles; ++t) {
    const TrianglePoint p =
        closest_point_on_triangle(x, {at[corner[t][0]], at[corner[t][1]], at[corner[t][2]]});
    if (!(p.squared_distance < best.squared_distance)) continue;
    best.squared_distance = p.squared_distance;
    best.offset = -p.offset;
    best.weights = {};
    for (std::size_t k = 0; k < 3; ++k) best.weights[corner[t][k]] = p.weights[k];
  }
  return best;
}
}  // namespace brio
