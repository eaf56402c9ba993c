#pragma once
/// Ties that end: because elements are deleted, or by force.

#include <optional>

#include "contact/ties/ties.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/sweep/erosion.hpp"

namespace brio {

/// Releases tied nodes whose face or whose last element was deleted in the present step. \returns the kinetic
/// energy and momentum lost, as mass is transferred from the corners of the face to the node; none where no
/// tie was released
std::optional<Contribution> release_ties(Ties& ties, const Erosion& erosion, Nodes& nodes);

/// Releases tied nodes whose force on their face exceeds that of their connection; the same.
/// \pre forces of elements and loads stand on the nodes \param step the last, between the present velocities
/// and those before
std::optional<Contribution> fail_ties(Ties& ties, double step, Nodes& nodes);

}  // namespace brio
