#pragma once
/// Ties that end because elements are deleted.

#include <optional>

#include "contact/ties/ties.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/sweep/erosion.hpp"

namespace brio {

/// Releases tied nodes whose face or whose last element was deleted in the present step. \returns the kinetic
/// energy and momentum lost, as mass is transferred from the corners of the face to the node; none where no
/// tie was released
std::optional<Contribution> release_ties(Ties& ties, const Erosion& erosion, Nodes& nodes);

}  // namespace brio
