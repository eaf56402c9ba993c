#pragma once
/// Pairs without a separating plane over a time step: whether they come into contact, by the velocity checks,
/// which have no false negatives (velocity_check.hpp, edge_check.hpp), and the constraints that prevent it.

#include <optional>

#include "contact/detection/crossing_guard.hpp"

namespace brio {

/// Distance that pairs keep over a time step, over the smallest edge: without one they have no direction in
/// which they could be parted (an edge that a rigid wall lays on another in its plane) ...
inline constexpr double least_distance_share = 1e-6;
/// ... of edges that are points, this fraction of the sum of their radii ...
inline constexpr double floor_of_points = 0.5;
/// ... or this one of the distance at the start, where that is less.
inline constexpr double floor_at_start = 0.9;

class CrossingCheck {
 public:
  CrossingCheck(const SurfaceFeatures& features, const Surface& surface, const ContactOptions& options,
                const FeaturePairs& pairs, const FeatureMotion& motion)
      : features_(features),
        surface_(surface),
        options_(options),
        pairs_(pairs),
        motion_(motion),
        floor_(least_distance_share * features.smallest_edge),
        separation_(separation_share * features.smallest_edge) {}

  std::optional<Hit> node_and_face(std::size_t pair) const;
  std::optional<Hit> edge_and_edge(std::size_t pair) const;

 private:
  void set_start(Hit& hit, Contact& contact, const Vector3d& offset, double floor) const;
  void set_hit(Hit& hit, Contact contact, Vector3d normal, bool without_side) const;

  const SurfaceFeatures& features_;
  const Surface& surface_;
  const ContactOptions& options_;
  const FeaturePairs& pairs_;
  const FeatureMotion& motion_;
  double floor_, separation_;
};

}  // namespace brio
