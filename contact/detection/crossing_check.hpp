#pragma once
/// Pairs without a separating plane over a time step: whether they come into contact, by the velocity checks,
/// which have no false negatives (velocity_check.hpp, edge_check.hpp), and the constraints that prevent it.

#include <optional>

#include "contact/detection/crossing_guard.hpp"
#include "contact/features/flatness.hpp"

namespace brio {

/// Of edges that are points: their least distance over the sum of their radii.
inline constexpr double floor_of_points = 0.5;
/// Of pairs that start the step nearer than the least distance: over their distance at the start.
inline constexpr double floor_at_start = 0.9;

/// Distance that a pair keeps over a time step: twice the thickness up to which hulls are flat
/// (flatness.hpp). Edges that keep it from the sides of a flat face, and nodes that do from its hull, do not
/// pass over its diagonals either, which are not paired. \param radii their sum; zero: two skins are kept
template <class T>
T least_distance(const SurfaceFeatures& features, T radii) {
  return T(2.0) * max(T(flat_share_of_skin * features.skin), T(flat_share_of_radius) * radii);
}

class CrossingCheck {
 public:
  CrossingCheck(const SurfaceFeatures& features, const Surface& surface, const ContactOptions& options,
                const FeaturePairs& pairs, const FeatureMotion& motion, std::span<const Contact> constraints)
      : features_(features),
        surface_(surface),
        options_(options),
        pairs_(pairs),
        motion_(motion),
        constraints_(constraints),
        separation_(separation_share * features.smallest_edge) {}

  std::optional<Hit> node_and_face(std::size_t pair) const;
  std::optional<Hit> edge_and_edge(std::size_t pair) const;

 private:
  bool is_hidden(int a, int b, bool radii) const;
  void set_start(Hit& hit, Contact& contact, const Vector3d& offset, double floor) const;
  void set_hit(Hit& hit, Contact contact, Vector3d normal, bool without_side, double floor) const;

  const SurfaceFeatures& features_;
  const Surface& surface_;
  const ContactOptions& options_;
  const FeaturePairs& pairs_;
  const FeatureMotion& motion_;
  std::span<const Contact> constraints_;  ///< of this step, by Contact::slave
  double separation_;
};

}  // namespace brio
