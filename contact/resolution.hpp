#pragma once
/// Contact by distances over one step: find the constraints, solve for their impulses, look for what would
/// cross nevertheless, and solve again with that until nothing does.

#include <span>

#include "contact/scene.hpp"

namespace brio {

/// See `resolve`. \pre scene.distance.
void resolve_by_distances(ContactScene& scene, Nodes& nodes, double dt, ThreadTeam& team,
                          std::span<RigidMotion> bodies, const Ties& ties,
                          std::span<const ContactWall> walls);

}  // namespace brio
