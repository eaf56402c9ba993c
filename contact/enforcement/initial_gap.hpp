#pragma once
/// The start of contact by distances: surfaces that coincide or overlap a little are moved apart once, to
/// their radii, so that nothing crosses and every pair has a side. Solids keep their skins, two solids a gap
/// of two skins; shells, beams and particles their thickness.
///
/// First what is drawn touching is set back (retraction.hpp). Where more overlaps, moved are nodes of the
/// surface, each of equal weight, as little as does it: the constraints of find_sided_pairs are solved for
/// displacements instead of velocities, along present normals, until none is missing. Held are components of
/// motion that are prescribed, nodes of rigid bodies, and nodes that a tie holds, which follow what holds
/// them.

#include "contact/overlap.hpp"

namespace brio {

/// Find overlaps and move nodes until every pair is at its radii, as remove_initial_overlap. Where nothing is
/// wrong but that the gap is missing, and there is no room for it, what is apart stays as it is.
/// \throws std::invalid_argument naming parts and place where an overlap is deeper than the limit of the
/// options, cannot be removed, or surfaces cross.
/// \pre scene.distance
std::vector<InitialOverlap> make_initial_gap(ContactScene& scene, Nodes& nodes, ThreadTeam& team);

}  // namespace brio
