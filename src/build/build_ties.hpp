#pragma once
/// Ties of a deck to faces of the model.

#include <span>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/deck/mesh.hpp"
#include "src/model/model.hpp"

namespace brio {

/// Find the faces to which the deck ties nodes, and remove supports of tied nodes that their corners have as
/// well. The nodes of the parts and prescribed motions are known. \param connectivity of each part, by place
/// in its block \throws BuildError with the place of the connection where no node is near, a node would be
/// tied twice or to itself, or the supports of a node and of its face differ.
void make_ties(const Deck& deck, std::span<const Mesh> meshes, std::span<const std::vector<int>> connectivity,
               Model& model);

/// Those that no force can end: where they are, contact makes no gap.
Ties ties_that_last(const Ties& ties);

/// Ties that can fail to the same faces, at the distances that nodes have now.
void tie_again(Model& model);

/// Give tied nodes the initial velocity of their faces.
/// \throws BuildError where initial conditions give them another motion.
void start_ties(Model& model);

}  // namespace brio
