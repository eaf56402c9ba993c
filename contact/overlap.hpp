#pragma once
/// Overlaps that a mesh begins with. Small ones are removed before the first step by moving nodes, so that
/// they cost neither strain nor energy: everything formed from the mesh (masses, reference lengths) must be
/// formed afterwards.

#include <string>
#include <vector>

#include "contact/scene.hpp"

namespace brio {

/// What was found between two parts.
struct InitialOverlap {
  std::string node_part;  ///< the part whose nodes lie too deep ...
  std::string face_part;  ///< ... in, or too close to, this one
  double depth = 0;       ///< the deepest; 0: nothing was missing but the gap of contact
  int nodes = 0;
  double moved = 0;  ///< how far the nodes of both were moved at most
  double gap = 0;    ///< that contact by distances keeps between them beyond their thickness

  bool is_overlap() const { return depth > 0; }
};

/// Find overlaps and move nodes until none is left. Nodes prescribed along an axis are not moved along it.
/// Shells that begin closer to their own part than their thickness keep doing so: they are excluded from
/// testing each other. \returns one entry for each pair of parts, empty where the mesh is clean. \throws
/// std::invalid_argument naming parts, depth and place, when an overlap is deeper than the limit of the
/// options or cannot be removed.
std::vector<InitialOverlap> remove_initial_overlap(ContactScene& scene, Nodes& nodes, ThreadTeam& team);

}  // namespace brio
