#pragma once
/// Nodes that parts share, because a deck merges the parts.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "src/deck.hpp"
#include "src/mesh.hpp"

namespace brio {

/// What became of one connection.
struct MergedParts {
  std::string first, second;
  int nodes = 0;        ///< of the second that became nodes of the first
  double farthest = 0;  ///< that any of them was moved
};

/// For each node of all meshes, numbered part by part, the one whose place it takes: mostly itself. Empty
/// where a deck merges nothing.
struct SharedNodes {
  std::vector<std::size_t> same_as;
  std::vector<MergedParts> merged;
};

/// Each node of the second part of a connection becomes the closest node of the first within the tolerance.
/// \throws BuildError where a connection finds no pair of nodes, or would join two nodes of one part.
SharedNodes share_nodes(const Deck& deck, std::span<const Mesh> meshes);

}  // namespace brio
