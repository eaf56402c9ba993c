#pragma once
/// Loads and springs of a deck.

#include <span>

#include "src/deck/mesh.hpp"
#include "src/model/model.hpp"

namespace brio {

/// \throws BuildError where a set is not there, or a moment acts on what does not turn
void make_loads(const Deck& deck, std::span<const Mesh> meshes, Model& model);

/// Fastens springs to the nodes nearest to their ends, or to those of sets; what they store at the start is
/// energy of the start. \pre balances are set \throws BuildError where both ends are one mass, a node is
/// tied, or does not turn about an axis
void make_springs(const Deck& deck, std::span<const Mesh> meshes, Model& model);

}  // namespace brio
