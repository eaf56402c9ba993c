#include "src/motion/node_rotations.hpp"

#include <limits>

#include "elements/beam/beam_rotation.hpp"
#include "src/base/index.hpp"
#include "src/motion/motion.hpp"

namespace brio {

NodeRotations start_rotations(std::span<const Block> blocks, const Nodes& nodes) {
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  NodeRotations rotations(nodes.size(), {undefined, undefined, undefined, undefined});
  for (const Block& block : blocks)
    for (std::size_t e = 0; e < block.element_count; ++e) {
      if (!(block.kernel.gyration(block, e) > 0)) continue;
      for (int corner = 0; corner < nodes_per_element(block.element); ++corner)
        rotations[index(block.node(e, corner))] = {1, 0, 0, 0};
    }
  return rotations;
}

void turn(NodeRotations& rotations, const Nodes& nodes, double step, ThreadTeam& team) {
  team.for_ranges(rotations.size(), nodes_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double* rate = nodes.angular_velocity[i].component;
      rotations[i] = turned(Vector3d{step * rate[0], step * rate[1], step * rate[2]}, rotations[i]);
    }
  });
}

}  // namespace brio
