#pragma once
/// Pairs of faces that intersect, and beams that cross faces.

#include <array>
#include <utility>
#include <vector>

#include "contact/audit/audit.hpp"
#include "contact/audit/audit_surface.hpp"

namespace brio {

struct Crossings {
  Audit found;
  /// Pairs of pieces whose surfaces cross, may they or not, ascending, the lesser number first.
  std::vector<std::array<int, 2>> crossed_pieces;
  /// Pairs of faces of different pieces that do not cross but whose boxes overlap, by their numbers in
  /// AuditedSurface::face.
  std::vector<std::array<int, 2>> near_faces;
};

Crossings find_crossings(const AuditedSurface& surface, ThreadTeam& team);

}  // namespace brio
