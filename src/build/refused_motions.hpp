#pragma once
/// Prescribed motions that contradict each other, or that rigid walls do not allow.

#include "src/model/model.hpp"

namespace brio {

/// Of two motions of one component of a node or a rigid body, the one that is set last would prevail
/// silently. \pre initial velocities are set
/// \throws BuildError at the place of the later one, naming that of the other and the node, where the two
/// differ before the end time; equal ones, of the same kind or of different kinds, are accepted.
void refuse_contradictory_motions(const Model& model);

/// A motion prescribed along the normal of a wall is not changed by it, and would pass silently. Examines
/// nodes, and at rigid bodies: at the lowest node of those that cannot turn, at the centre of others. \pre
/// initial velocities are set \throws BuildError at the place of the motion, naming wall, node or part, depth
/// and time
void refuse_motions_through_walls(const Model& model);

}  // namespace brio
