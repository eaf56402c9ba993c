#pragma once
/// Ties of a deck to faces of the model.

#include <span>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/deck/mesh.hpp"
#include "src/model/model.hpp"

namespace brio {

/// Find what holds the nodes that the deck ties, and take supports away from them that their corners have as
/// well. The nodes of the parts and prescribed motions are known.
/// \param connectivity of each part, by place in its block
/// \throws BuildError with the place of the connection where nothing is near, a node would be held twice or
/// by itself, or a support holds a node otherwise than its face.
void make_ties(const Deck& deck, std::span<const Mesh> meshes, std::span<const std::vector<int>> connectivity,
               Model& model);

/// Let held nodes start with their faces.
/// \throws BuildError where initial conditions give them another motion.
void start_ties(Model& model);

}  // namespace brio
