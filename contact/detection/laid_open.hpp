#pragma once
/// Elements that a deletion lays open: inside a body nothing keeps the sides of elements apart, and what has
/// been crushed there may cross its neighbours, or itself.

#include <span>
#include <vector>

#include "contact/surface.hpp"
#include "contact/surface_topology.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// Of hexahedra whose faces a deletion has laid open, those of which such a face crosses a face of the same
/// or of a neighbouring element, ascending. The work is proportional to the faces. \param laid_open numbers
/// of living faces
std::vector<SurfaceElement> find_crossed_elements(const Surface& surface, const SurfaceTopology& topology,
                                                  const Nodes& nodes, std::span<const int> laid_open);

}  // namespace brio
