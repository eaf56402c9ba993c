#pragma once
/// Prescribed motions that rigid walls do not allow.

#include "src/model/model.hpp"

namespace brio {

/// A motion prescribed along the normal of a wall is not changed by it, and would pass silently. Examines
/// nodes, and at rigid bodies: at the lowest node of those that cannot turn, at the centre of others. \pre
/// initial velocities are set \throws BuildError at the place of the motion, naming wall, node or part, depth
/// and time
void refuse_motions_through_walls(const Model& model);

}  // namespace brio
