#include "src/model/scene_extent.hpp"

#include <algorithm>

namespace brio {

SceneExtent scene_extent(const Nodes& nodes) {
  SceneExtent extent;
  for (const double mass : nodes.mass) extent.mass += mass;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::minmax_element(
        nodes.record.begin(), nodes.record.end(),
        [axis](const auto& a, const auto& b) { return a.position[axis] < b.position[axis]; });
    if (least != most) extent.width = std::max(extent.width, most->position[axis] - least->position[axis]);
  }
  return extent;
}

}  // namespace brio
