#pragma once
/// Node equivalencing: nodes that parts share, because a deck merges the parts.

#include <cstddef>
#include <span>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/deck/mesh.hpp"
#include "src/model/merged_parts.hpp"

namespace brio {

/// For each node of all meshes, numbered part by part, the one that replaces it: mostly itself. Empty
/// where a deck merges nothing.
struct SharedNodes {
  std::vector<std::size_t> same_as;
  std::vector<MergedParts> merged;
};

/// Each node of the second part of a connection becomes the closest node of the first within the tolerance.
/// \throws BuildError where a connection finds no pair of nodes, or would join two nodes of one part.
SharedNodes share_nodes(const Deck& deck, std::span<const Mesh> meshes);

}  // namespace brio
