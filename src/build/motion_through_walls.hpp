#pragma once
/// Prescribed motions that rigid walls do not allow.

#include "src/model/model.hpp"

namespace brio {

/// What is prescribed along the normal of a wall does not give way to it, and would pass without a word.
/// Looks at nodes, and at rigid bodies: at the lowest node of those that cannot turn, at the centre of
/// others. \pre initial velocities are set \throws BuildError at the place of the motion, naming wall, node
/// or part, depth and time
void refuse_motions_through_walls(const Model& model);

}  // namespace brio
