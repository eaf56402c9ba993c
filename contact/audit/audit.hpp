#pragma once
/// Contact audit: brute-force count of undetected penetrations at the present positions. It uses no sides, no
/// history and no vertex normals, and shares with detection only the surface and the excluded pairs: its
/// search, predicates and distances are its own.
///
/// - *Crossings*: every edge and both diagonals of every face, and every beam, against the triangles of every
///   face (a quadrilateral is cut along the diagonal from its corner 0; shells are their middle surfaces).
///   Pairs that share a node are left out, neighbours in one element are not.
/// - *Too close*: distances below the touching distance by more than a tenth: of nodes to faces, and between
///   beams, particles and edges.
/// - *Swallowed*: pieces inside of a closed solid whose surface they do not cross, by the winding number.

#include <array>
#include <cstdint>

#include "contact/scene.hpp"

namespace brio {

/// Where a finding is worst.
struct AuditPlace {
  double depth = 0;                 ///< a length
  int node = -1;                    ///< global
  std::array<int, 2> part{-1, -1};  ///< of the surface: that of the node, and the other
  int unused = 0;                   // no byte of a saved state is left undefined

  void keep_deeper(const AuditPlace& other) {
    if (other.depth > depth) *this = other;
  }
};

struct Audit {
  std::int64_t crossings = 0;  ///< pairs of faces, or of a beam and a face, that intersect
  /// Of these, by more than a tenth of the shortest edge of the two.
  std::int64_t deep_crossings = 0;
  std::int64_t too_close = 0;  ///< nodes, and pairs of segments
  std::int64_t swallowed = 0;  ///< pairs of pieces
  AuditPlace deepest_crossing;
  AuditPlace deepest_too_close;

  Audit& operator+=(const Audit& other);
  std::int64_t missed() const { return crossings + too_close + swallowed; }
  /// Without crossings of less than a tenth of an edge.
  std::int64_t deep() const { return deep_crossings + too_close + swallowed; }
  /// The deepest of all.
  const AuditPlace& deepest() const {
    return deepest_too_close.depth > deepest_crossing.depth ? deepest_too_close : deepest_crossing;
  }
};

/// The same for any number of threads. The time grows like n log n with the size n of the surface.
Audit audit(const ContactScene& scene, const Nodes& nodes, ThreadTeam& team);

}  // namespace brio
