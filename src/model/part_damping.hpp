#pragma once
/// Damping of nodes, from that of the parts of a deck.

#include "src/model/model.hpp"

namespace brio {

/// The damping of a node is the mean of that of its parts, weighted by the masses that it has of them. Empty
/// unless a part is damped.
/// \pre elements have their masses
NodalDamping damping_of_parts(const Deck& deck, const Model& model);

}  // namespace brio
