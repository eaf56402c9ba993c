#pragma once
/// Elements that a deletion lays open: inside a body nothing keeps the sides of elements apart, and what has
/// been crushed there may cross its neighbours, or itself.

#include <span>
#include <vector>

#include "contact/pairs/feature_pairs.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// Of hexahedra whose faces a deletion has exposed, those of which such a face crosses a face of a
/// hexahedron, ascending. The work is proportional to the exposed faces. \pre the nodes are where the last
/// step of contact has taken them. \param laid_open numbers of living faces
std::vector<SurfaceElement> find_crossed_elements(const Surface& surface, FeaturePairs& pairs,
                                                  const FeatureMotion& motion, const Nodes& nodes,
                                                  std::span<const int> laid_open, ThreadTeam& team);

}  // namespace brio
