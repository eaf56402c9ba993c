#pragma once
/// Rotations of nodes since the start, integrated from their angular velocities where a deck asks for them.

#include <span>
#include <string_view>
#include <vector>

#include "elements/base/quaternion.hpp"
#include "elements/block.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// Its name in `output.fields.variables`.
inline constexpr std::string_view rotation_field = "rotation";

/// Of each node; not a number at those of no element that turns its nodes. Empty: the deck asks for none.
using NodeRotations = std::vector<Quaternion<double>>;

/// None yet. \pre the nodes have rotations
NodeRotations start_rotations(std::span<const Block> blocks, const Nodes& nodes);

/// By the angular velocities for a step, with the same quaternions as the ends of beams.
void turn(NodeRotations& rotations, const Nodes& nodes, double step, ThreadTeam& team);

}  // namespace brio
