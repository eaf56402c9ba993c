#pragma once
/// What a mesh holds, before it is part of a model.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// A side of an element, for pressure: element index and local side (hex: 0..5 as in sides_of_hex; shell: 0).
struct ElementSide {
  int element;
  int side;
};

struct Mesh {
  int nodes_per_element = 8;  ///< 8: hexahedra, 4: shells, 2: beams, 1: particles
  std::vector<Vector3d> position;
  /// Where the nodes lie when elements get their masses; empty: at `position`.
  std::vector<Vector3d> reference;
  std::vector<int> connectivity;                      ///< nodes_per_element entries an element
  std::vector<double> volume;                         ///< of each particle; empty for other elements
  std::map<std::string, std::vector<int>> node_sets;  ///< ascending node indices
  std::map<std::string, std::vector<ElementSide>> side_sets;
  std::vector<std::int64_t> node_id;     ///< in the file that the mesh is from; empty: it is generated
  std::vector<std::int64_t> element_id;  ///< likewise

  std::int64_t number_of_element(std::size_t element) const {
    return element_id.empty() ? static_cast<std::int64_t>(element) : element_id[element];
  }
  std::size_t element_count() const { return connectivity.size() / index(nodes_per_element); }
};

/// Corners of the sides of a hexahedron in VTK order, each seen counter-clockwise from outside.
inline constexpr std::array<std::array<int, 4>, 6> sides_of_hex{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

}  // namespace brio
