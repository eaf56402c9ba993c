#pragma once
/// Topology of the elements below a surface, for its local update after deletions: which elements share a
/// side. Built only where elements may be deleted. The work of a deletion is proportional to the number of
/// elements deleted, whatever the size of the mesh.
///
/// Faces and slave nodes keep their numbers. A dead one leaves its number unused until the candidates have
/// been searched anew, so that whatever was found in between can tell it by `Face::alive` and
/// `Surface::node`; after that new ones take it over. Shells never come to the surface, and their numbers are
/// not taken over.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contact/surface/element_sides.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/index.hpp"

namespace brio {

/// An element as the surface numbers parts and elements.
struct SurfaceElement {
  int part = 0;
  int element = 0;  ///< within its part
};

/// Elements of one part, numbered through all parts, and so are their sides: six of a hexahedron, one of a
/// shell, none of a beam or a particle.
struct TopologyPart {
  int nodes_per_element = 8;
  std::vector<int> connectivity;
  int first_element = 0;
  int first_side = 0;
  int first_round = 0;  ///< its first in Surface::round

  bool solid() const { return nodes_per_element == 8; }
  bool shell() const { return nodes_per_element == 4; }
  bool round() const { return nodes_per_element <= 2; }
  int sides() const { return round() ? 0 : shell() ? 1 : 6; }
  int corners() const { return nodes_per_element; }
};

/// Numbers of the dead: first unusable, then reusable.
struct FreeNumbers {
  std::vector<int> retired;
  std::vector<int> free;
  void release() {
    free.insert(free.end(), retired.begin(), retired.end());
    retired.clear();
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(retired, free);
  }
};

/// Changes by a deletion. Each list without repetition, in an order that does not depend on threads.
struct SurfaceChange {
  std::vector<int> dead_face;
  std::vector<int> new_face;
  std::vector<int> dead_round;
  std::vector<int> dead_slave;
  std::vector<int> new_slave;
  std::vector<int> changed_slave;  ///< living ones that gained or lost faces, new ones among them; ascending
  std::vector<int> debris;         ///< changed ones that were left without elements and stay
  bool split = false;              ///< there are new bodies
  void clear() {
    for (auto* list : {&dead_face, &new_face, &dead_round, &dead_slave, &new_slave, &changed_slave, &debris})
      list->clear();
    split = false;
  }
};

/// State of a node without elements.
struct DebrisNode {
  double radius = 0;  ///< that it may have, beginning with the one it had; 0: it leaves contact
  int elements = 0;   ///< that live
};

struct SurfaceTopology {
  std::vector<TopologyPart> part;
  /// Of each side: the next side with the same nodes, round in a ring; else its face, or that it has none
  /// (see side_state in the source).
  std::vector<int> side;
  std::vector<int> body;           ///< of each element; -1: deleted
  std::vector<DebrisNode> debris;  ///< of each global node; empty where none stays without elements
  std::vector<std::pair<int, int>>
      under_shells;  ///< (node, hexahedron) of nodes that shells have too; ascending

  FreeNumbers faces, slaves;
  std::vector<int> mark;  ///< of each element, by which search for pieces it was reached last
  int last_mark = 0;
  std::uint64_t visits = 0;  ///< sides, faces and nodes looked at by deletions so far

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(side, body, debris, faces, slaves, mark, last_mark, visits);
  }
};

/// \param surface as made from the parts; bodies that have no face at all are numbered after the others
SurfaceTopology make_topology(Surface& surface, std::span<const SurfacePart> parts);

/// Delete elements, in any order; those already deleted are passed over. Faces of the deleted die, sides of
/// their neighbours become faces, nodes come to the surface, nodes left without elements leave it or become
/// debris; pieces of a body that has split become bodies. Everything in `surface` is then as if built from
/// the living elements but for numbers.
void delete_elements(Surface& surface, SurfaceTopology& topology, std::span<const SurfaceElement> deleted,
                     SurfaceChange& change);

/// State of a side, in SurfaceTopology::side: from 0, the next side of its ring; else one of these, or a
/// face.
namespace side_state {
inline constexpr int none = -1;   ///< collapsed, or of a deleted element
inline constexpr int alone = -2;  ///< nothing shares it any more, and it has no face yet
constexpr int of_face(int face) { return -3 - face; }
constexpr int face_of(int state) { return -3 - state; }
constexpr bool is_face(int state) { return state <= -3; }
}  // namespace side_state

/// The part of an element, a side, numbered through all parts.
inline const TopologyPart& part_of_element(const SurfaceTopology& topology, int element) {
  std::size_t p = topology.part.size() - 1;
  while (topology.part[p].first_element > element) --p;
  return topology.part[p];
}
inline const TopologyPart& part_of_side(const SurfaceTopology& topology, int side) {
  std::size_t p = topology.part.size() - 1;
  while (topology.part[p].first_side > side) --p;
  return topology.part[p];
}

/// Nodes of a side of a hexahedron of that part. \returns false where it has collapsed.
inline bool nodes_of_side(const TopologyPart& part, int side, std::array<int, 4>& nodes) {
  const int local = side - part.first_side;
  return side_nodes(part.connectivity.data() + 8 * static_cast<std::ptrdiff_t>(local / sides_of_hexahedron),
                    local % sides_of_hexahedron, nodes);
}

/// Number through all parts of the element of a face.
inline int element_of(const SurfaceTopology& topology, const Face& face) {
  return topology.part[index(face.part)].first_element + face.element;
}

/// Nodes of an element, numbered through all parts.
inline std::span<const int> nodes_of(const SurfaceTopology& topology, int element) {
  const TopologyPart& part = part_of_element(topology, element);
  const auto corners = index(part.corners());
  return {part.connectivity.data() + corners * index(element - part.first_element), corners};
}

/// Call `visit` with every living face of an element, numbered through all parts.
template <class Visit>
void for_faces_of(const SurfaceTopology& topology, int element, const Visit& visit) {
  const TopologyPart& part = part_of_element(topology, element);
  const int first = part.first_side + part.sides() * (element - part.first_element);
  for (int side = first; side < first + part.sides(); ++side) {
    const int state = topology.side[index(side)];
    if (side_state::is_face(state)) visit(side_state::face_of(state));
  }
}

/// Call `visit` with living hexahedra at a node that shells have too.
template <class Visit>
void for_hexahedra_under_shells(const SurfaceTopology& topology, int node, const Visit& visit) {
  const auto& under = topology.under_shells;
  for (auto at = std::lower_bound(under.begin(), under.end(), std::pair(node, 0));
       at != under.end() && at->first == node; ++at)
    if (topology.body[index(at->second)] >= 0) visit(at->second);
}

/// Call `visit` with living elements, at least one in each direction in which elements around share a node
/// with this one: those that share a side, and those with a face at its nodes. Where elements at a node are
/// not joined by sides, they have faces there, but for hexahedra around a shell inside of them.
template <class Visit>
void for_elements_around(const Surface& surface, const SurfaceTopology& topology, int element,
                         const Visit& visit) {
  const TopologyPart& part = part_of_element(topology, element);
  const int first = part.first_side + part.sides() * (element - part.first_element);
  for (int side = first; side < first + part.sides(); ++side)
    for (int other = topology.side[index(side)]; other >= 0 && other != side;
         other = topology.side[index(other)]) {
      const TopologyPart& of = part_of_side(topology, other);
      visit(of.first_element + (other - of.first_side) / of.sides());
    }
  for (int node : nodes_of(topology, element)) {
    if (part.shell()) for_hexahedra_under_shells(topology, node, visit);
    if (surface.slave(node) < 0) continue;
    for (int f : surface.faces_of.of(surface.slave(node)))
      visit(element_of(topology, surface.face[index(f)]));
  }
}

}  // namespace brio
