#pragma once
/// Contradictory prescribed motions.

#include "src/model/model.hpp"

namespace brio {

/// Of two motions of one component of a node or a rigid body, the one that is set last would prevail
/// silently. \pre initial velocities are set
/// \throws BuildError at the place of the later one, naming that of the other and the node, where the two
/// differ before the end time; equal ones, of the same kind or of different kinds, are accepted.
void refuse_contradictory_motions(const Model& model);

}  // namespace brio
