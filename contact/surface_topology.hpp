#pragma once
/// What a surface needs to know of its elements so that it can be mended where some are deleted: which
/// elements share a side. Built only where elements may be deleted. The work of a deletion is proportional to
/// the number of elements deleted, whatever the size of the mesh.
///
/// Faces and slave nodes keep their numbers. A dead one leaves its number unused until the candidates have
/// been searched anew, so that whatever was found in between can tell it by `Face::alive` and
/// `Surface::node`; after that new ones take it over.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/surface.hpp"

namespace brio {

struct DeletedElement {
  int part = 0;     ///< as the surface numbers parts
  int element = 0;  ///< within its part
};

/// Elements of one part, numbered through all parts, and so are their sides: six of a hexahedron, one of a
/// shell.
struct TopologyPart {
  bool shell = false;
  std::vector<int> connectivity;
  int first_element = 0;
  int first_side = 0;

  int sides() const { return shell ? 1 : 6; }
  int corners() const { return shell ? 4 : 8; }
};

/// Numbers of the dead: first unusable, then reusable.
struct FreeNumbers {
  std::vector<int> retired;
  std::vector<int> free;
  void release() {
    free.insert(free.end(), retired.begin(), retired.end());
    retired.clear();
  }
};

/// What a deletion changed. Each list without repetition, in an order that does not depend on threads.
struct SurfaceChange {
  std::vector<int> dead_face;
  std::vector<int> new_face;
  std::vector<int> dead_slave;
  std::vector<int> new_slave;
  std::vector<int> changed_slave;  ///< living ones that gained or lost faces, new ones among them; ascending
  void clear() {
    for (auto* list : {&dead_face, &new_face, &dead_slave, &new_slave, &changed_slave}) list->clear();
  }
};

struct SurfaceTopology {
  std::vector<TopologyPart> part;
  /// Of each side: the next side with the same nodes, round in a ring; else its face, or that it has none
  /// (see side_state in the source).
  std::vector<int> side;
  std::vector<int> body;        ///< of each element; -1: deleted
  double debris_radius = 0;     ///< of nodes left without elements; 0: they leave contact
  bool may_have_split = false;  ///< since bodies were numbered last

  FreeNumbers faces, slaves;
  std::uint64_t visits = 0;  ///< sides, faces and nodes looked at by deletions so far

  bool alive(const DeletedElement& e) const {
    return body[static_cast<std::size_t>(part[static_cast<std::size_t>(e.part)].first_element + e.element)] >=
           0;
  }
};

/// \param surface as made from the parts; bodies that have no face at all are numbered after the others
SurfaceTopology make_topology(Surface& surface, std::span<const SurfacePart> parts);

/// Delete elements, in any order; those already deleted are passed over. Faces of the deleted die, sides of
/// their neighbours become faces, nodes come to the surface, nodes left without elements leave it or become
/// debris. Everything in `surface` is then as if built from the living elements but for numbers, and but for
/// the numbers of bodies: pieces of a body that has split share one until `number_pieces`.
void delete_elements(Surface& surface, SurfaceTopology& topology, std::span<const DeletedElement> deleted,
                     SurfaceChange& change);

/// Give pieces of bodies that have split numbers of their own; the piece with the first element keeps the
/// old one. Looks at all elements, but only where deletions may have split something. \returns whether
/// numbers changed.
bool number_pieces(Surface& surface, SurfaceTopology& topology);

/// Call `visit` with every living face of the element of a face.
template <class Visit>
void for_faces_of_element(const SurfaceTopology& topology, const Face& face, const Visit& visit);

/// State of a side, in SurfaceTopology::side: from 0, the next side of its ring; else one of these, or a
/// face.
namespace side_state {
inline constexpr int none = -1;   ///< collapsed, or of a deleted element
inline constexpr int alone = -2;  ///< nothing shares it any more, and it has no face yet
constexpr int of_face(int face) { return -3 - face; }
constexpr int face_of(int state) { return -3 - state; }
constexpr bool is_face(int state) { return state <= -3; }
}  // namespace side_state

template <class Visit>
void for_faces_of_element(const SurfaceTopology& topology, const Face& face, const Visit& visit) {
  const TopologyPart& part = topology.part[static_cast<std::size_t>(face.part)];
  const int first = part.first_side + part.sides() * face.element;
  for (int side = first; side < first + part.sides(); ++side) {
    const int state = topology.side[static_cast<std::size_t>(side)];
    if (side_state::is_face(state)) visit(side_state::face_of(state));
  }
}

}  // namespace brio
