#pragma once
/// A quarter of a ball of hexahedra that are small where it will touch.

#include <cmath>

#include "io/mesh/sphere_mesh.hpp"
#include "src/base/index.hpp"
#include "src/deck/mesh.hpp"

namespace brio::test {

/// Ball about the origin whose elements at its lowest point are `fineness` times those of an even mesh: the
/// ball is taken to a half space by an inversion about its highest point, which keeps angles; there distances
/// from what was the lowest point are shrunk, near it by `fineness`; and back. Sets `xmin` and `ymin` are the
/// planes of symmetry.
inline Mesh quarter_of_graded_ball(double radius, int across, double fineness) {
  Mesh ball = sphere_mesh(radius, across, false);
  for (auto& [x, y, z] : ball.position) {
    // From the highest point; inverted, so that the surface is the plane at depth 1/2 and the lowest point
    // its origin.
    const auto invert = [](Vector3d p) {
      const double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
      return Vector3d{p[0] / square, p[1] / square, p[2] / square};
    };
    if (z > (1 - 1e-12) * radius) continue;
    Vector3d p = invert({x / radius, y / radius, z / radius - 1});
    p[2] += 0.5;
    const double distance = 2 * std::hypot(p[0], p[1], p[2]);  // 1 at the equator
    const double grading = std::pow(distance / 0.8, 4);
    const double shrink = (fineness + grading) / (1 + grading);
    for (double& component : p) component *= shrink;
    p[2] -= 0.5;
    p = invert(p);
    x = radius * p[0];
    y = radius * p[1];
    z = radius * (p[2] + 1);
  }
  Mesh quarter;
  std::vector<int> number(ball.position.size(), -1);
  for (std::size_t e = 0; e < ball.element_count(); ++e) {
    const int* node = &ball.connectivity[8 * e];
    bool inside = true;
    for (int k = 0; k < 8; ++k)
      for (std::size_t axis = 0; axis < 2; ++axis)
        inside = inside && ball.position[index(node[k])][axis] > -1e-9 * radius;
    if (!inside) continue;
    for (int k = 0; k < 8; ++k) {
      int& at = number[index(node[k])];
      if (at < 0) {
        at = static_cast<int>(quarter.position.size());
        Vector3d p = ball.position[index(node[k])];
        for (std::size_t axis = 0; axis < 2; ++axis) {
          if (std::abs(p[axis]) > 1e-9 * radius) continue;
          p[axis] = 0;
          quarter.node_sets[axis == 0 ? "xmin" : "ymin"].push_back(at);
        }
        quarter.position.push_back(p);
      }
      quarter.connectivity.push_back(at);
    }
  }
  for (int n = 0; n < static_cast<int>(quarter.position.size()); ++n) quarter.node_sets["all"].push_back(n);
  return quarter;
}

}  // namespace brio::test
