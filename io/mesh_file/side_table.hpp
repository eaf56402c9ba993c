#pragma once
/// Sides of the elements of a mesh, found by their nodes.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "src/deck/mesh.hpp"

namespace brio {

class SideTable {
 public:
  /// \param mesh of hexahedra or shells
  explicit SideTable(const Mesh& mesh);

  /// Sides with no other of the same nodes, by element and side.
  std::vector<ElementSide> exterior() const;

  /// The side with these nodes; a triangle repeats one. Of two, that of `element`, or where that is below 0
  /// the one that is seen with its nodes in the same turn from outside its element. \return nothing where
  /// there is none
  std::optional<ElementSide> find(const std::array<int, 4>& nodes, int element) const;

  /// Whether the nodes of a side stand in the same turn.
  bool has_same_turn(const ElementSide& side, const std::array<int, 4>& nodes) const;

 private:
  struct Entry {
    std::array<int, 3>
        further;  ///< nodes of the side after its least, ascending; a triangle repeats the last
    int side;     ///< element times sides of an element, plus side
  };
  std::array<int, 4> nodes_of(const ElementSide& side) const;
  ElementSide side_of(const Entry& entry) const { return {entry.side / sides_, entry.side % sides_}; }

  const Mesh& mesh_;
  int sides_;                       ///< of an element
  std::vector<std::size_t> first_;  ///< entry of each node whose sides have it as their least
  std::vector<Entry> entries_;
};

}  // namespace brio
