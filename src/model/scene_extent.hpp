#pragma once
/// Width and mass of a scene.

#include "src/base/nodes.hpp"

namespace brio {

/// Reference of the velocity change in a time step: the initial scene.
struct SceneExtent {
  double width = 0;  ///< longest side of the box around all nodes; 0: nothing can be said
  double mass = 0;   ///< of all nodes
};

SceneExtent scene_extent(const Nodes& nodes);

}  // namespace brio
