#pragma once
/// Impact zone, the last resort against crossings: nodes joined by hits move as one rigid body for the time
/// step (rigid impact zones: Provot 1997; Harmon, Vouga, Tamstorf, Grinspun 2008). Linear and angular
/// momentum are conserved; energy is dissipated as in a plastic impact.

#include <bitset>
#include <span>

#include "contact/features/rigid_motion.hpp"
#include "src/base/nodes.hpp"

namespace brio {

struct ContactScene;
struct Ties;

/// A node or a rigid body of a zone.
struct ZoneMember {
  double mass;
  Vector3d position, velocity;
  Tensor<double> inertia{};  ///< about the position
  Vector3d angular_velocity{};
  std::bitset<6> prescribed = 0;             ///< components of the velocity, then of the angular velocity
  Tensor<double> axes = identity<double>();  ///< columns: directions of these components
  /// Impulse and moment by the other members and by walls, without supports: without walls they sum to zero.
  /// A prescribed component keeps its velocity: its support balances the impulse.
  Vector3d impulse{}, moment{};
};

/// A point of a zone that ends the step in front of a rigid wall.
struct ZoneWall {
  std::size_t row = 0;  ///< its constraint row
  Vector3d point, normal;
  double least_velocity = 0;  ///< along the normal
  bool pushes = false;
  double impulse = 0;  ///< of the wall on the zone, along the normal
};

/// Impulses after which the members move as one rigid body: of all rigid motions with the prescribed
/// components, and on the walls that they would pass, the one with the least kinetic energy of the change.
/// Where none has them, the closest one (least squares).
void find_zone_impulses(std::span<ZoneMember> members, std::span<ZoneWall> walls = {});

/// Join the nodes of the present hits to zones, those of earlier calls in the step included, and move each
/// zone as one; a tied node moves with its corners. Velocities are those of `nodes` and `bodies`, impulses
/// are added to ContactScene::zone_impulse and to the bodies, those of walls to their rows.
void move_zones_as_one(ContactScene& scene, Nodes& nodes, const Ties& ties, std::span<RigidMotion> bodies);

}  // namespace brio
