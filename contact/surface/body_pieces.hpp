#pragma once
/// Connected pieces of a body after deletions.

#include <span>

#include "contact/surface/surface.hpp"
#include "contact/surface/surface_topology.hpp"

namespace brio {

/// Find out whether these elements of one body, of which each stands for what hangs together around a
/// deletion, are still connected; elements are that share a node. Each piece that is not gets a number of its
/// own, but for the last and usually largest, which keeps the old one. The search goes out from all of them
/// in step and ends as soon as they have met or all but one are exhausted: its work is that of the smaller
/// pieces, or of the way around what was deleted. \returns whether there are new bodies.
bool separate_pieces(Surface& surface, SurfaceTopology& topology, std::span<const int> elements);

}  // namespace brio
