#pragma once
/// Sides of elements.

#include <algorithm>
#include <array>
#include <cstddef>

namespace brio {

inline constexpr int sides_of_hexahedron = 6;

/// Sides of a hexahedron in VTK's order, counterclockwise from outside.
inline constexpr int side_corner[sides_of_hexahedron][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                            {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

/// Nodes of a side with repeated ones removed, the order kept; a triangle repeats its third. \returns false
/// where fewer than three are left: the side has collapsed.
inline bool distinct_nodes(const std::array<int, 4>& corner, std::array<int, 4>& distinct) {
  std::size_t count = 0;
  for (int node : corner)
    if (std::find(distinct.begin(), distinct.begin() + count, node) == distinct.begin() + count)
      distinct[count++] = node;
  if (count < 3) return false;
  if (count == 3) distinct[3] = distinct[2];
  return true;
}

/// Nodes of a side of the hexahedron with these eight nodes. \returns false where the side has collapsed.
inline bool side_nodes(const int* hexahedron, int side, std::array<int, 4>& nodes) {
  const int* corner = side_corner[side];
  return distinct_nodes(
      {hexahedron[corner[0]], hexahedron[corner[1]], hexahedron[corner[2]], hexahedron[corner[3]]}, nodes);
}

/// The same for any two elements that share a side, whichever node of a triangle each repeats.
inline std::array<int, 4> side_key(std::array<int, 4> nodes) {
  if (nodes[3] == nodes[2]) {
    std::sort(nodes.begin(), nodes.end() - 1);
    nodes[3] = nodes[2];
  } else {
    std::sort(nodes.begin(), nodes.end());
  }
  return nodes;
}

}  // namespace brio
