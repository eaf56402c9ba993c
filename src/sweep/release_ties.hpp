#pragma once
/// Ties that end because elements are deleted.

#include "contact/ties/ties.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/sweep/erosion.hpp"

namespace brio {

/// Releases tied nodes whose face or whose last element was deleted in the present step. The kinetic energy
/// and momentum lost, as mass is transferred from the corners of the face to the node, count as deleted.
/// \returns whether there are any.
bool release_ties(Ties& ties, const Erosion& erosion, Nodes& nodes, EnergyBalance& energy,
                  MomentumBalance& momentum);

}  // namespace brio
