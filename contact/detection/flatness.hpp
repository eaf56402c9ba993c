#pragma once
/// How flat the faces are: diagonals of a flat face are no features of their own.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "contact/detection/feature_motion.hpp"
#include "contact/detection/features.hpp"

namespace brio {

/// What a face is flat for: pairs that keep two skins, and so all; pairs that keep their radii; none.
enum class Flatness : std::uint8_t { all, radii, none };

/// Thickness of the hull of a face below which it is flat.
inline double flat_thickness(const SurfaceFeatures& features, std::size_t face, Flatness flatness) {
  constexpr double share_of_skin = 0.1, share_of_radius = 0.03;
  const double for_all = share_of_skin * features.skin;
  return flatness == Flatness::all ? for_all
                                   : std::max(for_all, share_of_radius * features.face_radius[face]);
}

/// How far every corner of a quadrilateral may move until it is not convex or its hull, between both
/// diagonals, is thicker than that; negative: it is.
inline double flat_slack(const std::array<Eigen::Vector3d, 4>& at, double thickness) {
  const Eigen::Vector3d a = at[2] - at[0], b = at[3] - at[1];
  const Eigen::Vector3d across = a.cross(b);
  const double area = across.norm();
  if (!(area > 0)) return -1;
  const double hull = std::abs((at[1] - at[0]).dot(across)) / area;
  // Of each corner from the other diagonal, in the mean plane.
  const auto beside = [&](const Eigen::Vector3d& diagonal, const Eigen::Vector3d& arm) {
    return diagonal.cross(arm).dot(across) / (diagonal.norm() * area);
  };
  const double convex = std::min({beside(a, at[3] - at[0]), -beside(a, at[1] - at[0]),
                                  beside(b, at[0] - at[1]), -beside(b, at[2] - at[1])});
  return std::min(0.5 * (thickness - hull), 0.25 * convex);
}

}  // namespace brio
