#pragma once
/// The last resort against crossings: what a set of hits joins moves on as one rigid piece for the step
/// (rigid impact zones: Provot 1997; Harmon, Vouga, Tamstorf, Grinspun 2008). Linear and angular momentum are
/// kept; energy is lost as in a plastic impact.

#include <span>

#include "contact/rigid_motion.hpp"
#include "src/base/nodes.hpp"

namespace brio {

struct ContactScene;

/// Join the nodes of the present hits to zones, those of earlier calls in the step included, and move each
/// zone as one. Node velocities stand in ContactScene::velocity, impulses are added to its zone_impulse.
void move_zones_as_one(ContactScene& scene, const Nodes& nodes, double dt, std::span<RigidMotion> bodies);

}  // namespace brio
