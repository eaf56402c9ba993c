#pragma once
/// Prescribed motion of nodes, and rigid walls.

#include <vector>

#include "contact/ties/ties.hpp"
#include "src/base/index.hpp"
#include "src/deck/deck.hpp"
#include "src/motion/energy_balance.hpp"

namespace brio {

/// One component of motion of a list of nodes.
struct PrescribedNodes {
  std::vector<int> nodes;
  MotionKind kind = MotionKind::velocity;
  int axis = 0;  ///< 0..2 translations, 3..5 rotations
  Curve curve;
  std::string place{};  ///< in the deck
  int condition = -1;   ///< its number in the deck
  /// Of each node, where its supports are not all along the global axes, else empty: the unit vector along
  /// which the component is, and the change of velocity that changes it by one and no other that is
  /// prescribed (skew_supports.hpp).
  std::vector<Vector3d> direction{}, dual{};
  std::vector<Vector3d> impulse{};  ///< on each node in this step; likewise

  bool turns() const { return axis >= 3; }
  bool is_skew() const { return !direction.empty(); }
  /// Of the node at a place of the list, or of all.
  Vector3d direction_of(std::size_t at) const {
    if (is_skew()) return direction[at];
    Vector3d unit{};
    unit[index(axis % 3)] = 1;
    return unit;
  }
};

/// Times of the present time step: forces are of `time`, velocities go from -previous/2 to +next/2 about it.
struct StepTimes {
  double time = 0;
  double previous = 0;  ///< step before `time`; 0 at the start
  double next = 0;      ///< step after it
  double mean() const { return 0.5 * (previous + next); }
};

/// Reaction of supports or walls in one time step: impulse, J.v- and J.v+.
struct Reaction {
  Impulse impulse;
  double before = 0;
  double after = 0;
};

/// A reaction of supports.
inline Contribution of_support(const Reaction& support) {
  return {.external = {.before = support.before, .after = support.after}, .supports = support.impulse};
}

/// Velocity of a prescribed motion over the time step, or its change.
struct GivenVelocity {
  double value = 0;
  bool is_change = false;
  double after(double before) const { return is_change ? before + value : value; }
};
GivenVelocity given_velocity(MotionKind kind, const Curve& curve, const StepTimes& times);

/// Sets the velocity after nodes were accelerated by their force. \return the impulse of the support; of skew
/// ones without J.v+
Reaction prescribe(PrescribedNodes& given, const StepTimes& times, Nodes& nodes);
/// J.v+ of a skew one, once all motions are prescribed.
double work_after(const PrescribedNodes& given, const Nodes& nodes);

/// J.v of a unit of the impulse J on a node, or a moment, of which supports leave a share: 0 where that is
/// rounding. \param free directions \param inverse mass or inertia
double compliance(const SymmetricTensor<double>& free, double inverse, const Vector3d& impulse);

/// A rigid wall: nodes that would be behind it at the end of the time step are stopped on it.
struct WallInRun {
  RigidWall wall;      ///< normal of unit length
  int condition = -1;  ///< its number in the deck
};

struct WallReaction {
  Reaction normal, friction;
};

/// Work at the velocity of the wall is external, the rest that of contact and friction.
inline Contribution of_wall(const WallReaction& reaction, const WallInRun& entry) {
  const auto moved = [&](const Reaction& part) { return dot(part.impulse.linear, entry.wall.velocity); };
  const double normal = moved(reaction.normal), friction = moved(reaction.friction), both = normal + friction;
  Contribution sum{
      .external = {.before = both, .after = both},
      .contact = {.before = reaction.normal.before - normal, .after = reaction.normal.after - normal},
      .friction = {.before = reaction.friction.before - friction,
                   .after = reaction.friction.after - friction},
      .walls = reaction.normal.impulse};
  sum.walls += reaction.friction.impulse;
  return sum;
}

/// Nodes that contact has stopped at walls together with its own constraints: stopped here, they could cross
/// other surfaces.
struct NodesInContact {
  std::span<const int> slave_of;  ///< of each node: its number among them, or -1; empty: there are none
  bool has(std::size_t node) const { return !slave_of.empty() && slave_of[node] >= 0; }
};

/// Stops nodes but those in contact; \return normal and frictional reaction.
WallReaction stop_at(const WallInRun& wall, const StepTimes& times, NodesInContact in_contact, Nodes& nodes);

/// Stops tied nodes, by impulses on the corners of their faces; before the others. Tied nodes then move with
/// their faces. \return the reaction of supports of the corners
Reaction stop_tied_at(const WallInRun& wall, const StepTimes& times, NodesInContact in_contact, Ties& ties,
                      Nodes& nodes);
/// Reaction of the wall on tied nodes, once all nodes have been stopped.
WallReaction reaction_of_tied(const Ties& ties, const StepTimes& times, Nodes& nodes);

}  // namespace brio
