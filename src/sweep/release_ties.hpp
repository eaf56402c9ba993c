#pragma once
/// Ties that end because elements are deleted.

#include "contact/ties/ties.hpp"
#include "src/motion/ledger.hpp"
#include "src/sweep/erosion.hpp"

namespace brio {

/// Let nodes go whose face or whose last element was deleted in the present step. What their motion loses, as
/// mass goes from the corners back to where they are, goes to the books of the deleted.
/// \returns whether there are any.
bool release_ties(Ties& ties, const Erosion& erosion, Nodes& nodes, EnergyBook& energy,
                  MomentumBook& momentum);

}  // namespace brio
