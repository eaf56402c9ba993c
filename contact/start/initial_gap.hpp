#pragma once
/// Removal of initial overlap: surfaces that coincide or overlap a little are moved apart once, to their
/// radii, so that nothing crosses. Solids keep their skins, two solids a gap of two skins; shells, beams and
/// particles their thickness.
///
/// First coincident faces are set back (retraction.hpp). For larger overlaps, nodes of the surface are moved
/// as little as possible, with equal weights: the constraints of find_sided_pairs are solved for
/// displacements instead of velocities, along present normals, until all are satisfied. Fixed are prescribed
/// components of motion, nodes of rigid bodies, and tied nodes, which follow their main surface.

#include <string>
#include <vector>

#include "contact/scene.hpp"

namespace brio {

/// Overlap of two parts.
struct InitialOverlap {
  std::string node_part;  ///< the part whose nodes lie too deep ...
  std::string face_part;  ///< ... in, or too close to, this one
  double depth = 0;       ///< the deepest; 0: nothing was missing but the gap of contact
  int nodes = 0;
  double moved = 0;  ///< how far the nodes of both were moved at most
  double gap = 0;    ///< that is kept between them beyond their thickness

  bool is_overlap() const { return depth > 0; }
};

/// Find overlaps and move nodes until every pair is at its radii, so that they cost neither strain nor
/// energy: everything formed from the mesh (masses, reference lengths) must be formed afterwards. Nodes
/// prescribed along an axis are not moved along it. Where nothing is wrong but that the gap is missing, and
/// there is no room for it, what is apart stays as it is. Shells that begin closer to their own part than
/// their thickness keep doing so: they are excluded from testing each other. \returns one entry for each pair
/// of parts, empty where the mesh is clean \throws std::invalid_argument naming parts and place where an
/// overlap is deeper than the limit of the options, cannot be removed, or surfaces cross.
std::vector<InitialOverlap> make_initial_gap(ContactScene& scene, Nodes& nodes, ThreadTeam& team);

}  // namespace brio
