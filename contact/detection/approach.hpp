#pragma once
/// Of a pair near in this step: whether it may touch, and whether it was a constraint.

#include <algorithm>
#include <array>
#include <span>

#include "contact/features/feature_motion.hpp"
#include "contact/pair.hpp"

namespace brio {

/// Whether the step's approach, or twice it, closes the gap but for the band.
bool closes_gap(const Contact& contact, const FeatureMotion& motion, double band);

/// Whether boxes around the paths of both features meet within that distance and the band: of these all pairs
/// are listed, of others those whose boxes happen to be large. \param reach at which they touch
bool paths_meet(const Contact& contact, const FeatureMotion& motion, double reach, double band);

/// Whether a pair of edges is in a list that is ordered by Contact::slave. \param first the number of the
/// first edge \param nodes Contact::node
inline bool has_edges(std::span<const Contact> contacts, int first, const std::array<int, 5>& nodes) {
  const auto range = std::ranges::equal_range(contacts, first_edge_slave + first, {}, &Contact::slave);
  return std::ranges::find(range, nodes, &Contact::node) != range.end();
}

}  // namespace brio
