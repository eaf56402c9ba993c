#pragma once
/// Which nodes a shell face surely has nothing to do with in a step: those farther from a box around the
/// face, turned with it, than contact reaches. Heights over the face and distances beside it count together,
/// so that a node that rests on one face is not compared with all those around it.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact/closest_point.hpp"

namespace brio {

/// A box around a face at the beginning of a step and what bounds the motion of the face.
struct ShellExtent {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> along;  ///< orthonormal: two directions in the face, its normal
  double half[3];            ///< half the size of the box; infinite where the face has hardly any area
  Eigen::Vector3d velocity;  ///< mean of the corners
  double spread;             ///< no corner's velocity differs more from the mean
  double margin;             ///< distance from the face beyond which a node of no radius at rest is no matter
};

/// Sine of the angle between the diagonals below which directions in the face are not trusted.
inline constexpr double least_sine_of_diagonals = 1e-4;

inline ShellExtent shell_extent(const FaceVertices& vertices, const FaceVertices& velocities, double margin) {
  ShellExtent extent;
  extent.margin = margin;
  extent.centre = vertices[0] + 0.25 * ((vertices[1] - vertices[0]) + (vertices[2] - vertices[0]) +
                                        (vertices[3] - vertices[0]));
  extent.velocity = 0.25 * (velocities[0] + velocities[1] + velocities[2] + velocities[3]);
  double spread = 0;
  for (const Eigen::Vector3d& v : velocities) spread = std::max(spread, (v - extent.velocity).squaredNorm());
  extent.spread = std::sqrt(spread);
  const Eigen::Vector3d first = vertices[2] - vertices[0];
  const Eigen::Vector3d second = vertices[3] - vertices[1];
  const Eigen::Vector3d area = first.cross(second);
  const double length = area.norm();
  const double size = std::sqrt(first.squaredNorm() * second.squaredNorm());
  if (!(length > least_sine_of_diagonals * size)) {
    std::fill_n(extent.half, 3, std::numeric_limits<double>::infinity());
    extent.along.fill(Eigen::Vector3d::Zero());
    return extent;
  }
  extent.along[2] = area / length;
  extent.along[0] = (first - second).normalized();
  extent.along[1] = extent.along[2].cross(extent.along[0]);
  for (int axis = 0; axis < 3; ++axis) {
    extent.half[axis] = 0;
    for (const Eigen::Vector3d& x : vertices)
      extent.half[axis] = std::max(
          extent.half[axis], std::abs(extent.along[static_cast<std::size_t>(axis)].dot(x - extent.centre)));
  }
  return extent;
}

/// True only where the node stays farther from the face than the margin and its radius even if the distance
/// between any point of the face and the node shrank by their greatest relative velocity times `ahead`.
/// \param radius, ahead  of the node, length; time
inline bool surely_out_of_reach(const ShellExtent& extent, const Eigen::Vector3d& position,
                                const Eigen::Vector3d& velocity, double radius, double ahead) {
  constexpr double slack = 1 + 1e-9;  // rounding, here and in the exact distance
  const double travel = ahead * ((velocity - extent.velocity).norm() + extent.spread);
  const double reach = slack * (extent.margin + radius + travel);
  const Eigen::Vector3d to = position - extent.centre;
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double beside =
        std::max(std::abs(extent.along[static_cast<std::size_t>(axis)].dot(to)) - extent.half[axis], 0.0);
    squared += beside * beside;
  }
  return squared > reach * reach;
}

}  // namespace brio
