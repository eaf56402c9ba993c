// Rigid walls against tied nodes.

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "src/motion/constraints.hpp"

namespace brio {

namespace {

const Tie& tie_of(const Ties& ties, int node) { return ties.node[index(ties.of_node[index(node)])].tie; }

/// Calls visit(node, impulse, moment) for the independent nodes that get an impulse on a tied node.
template <class Visit>
void transfer(const Ties& ties, const Nodes& nodes, int node, const Vector3d& impulse, const Vector3d& moment,
              const Visit& visit) {
  if (!ties.is_tied(node)) {
    visit(index(node), impulse, moment);
    return;
  }
  const Tie& tie = tie_of(ties, node);
  const std::array<Vector3d, 4> share = spread(tie, corners_of(tie, nodes), impulse);
  const Vector3d turn = tie.turning ? moment + cross(tie.arm, impulse) : Vector3d{};
  for (std::size_t k = 0; k < 4; ++k)
    if (tie.weight[k] != 0 || !is_zero(share[k]))
      transfer(ties, nodes, tie.corner[k], share[k], tie.weight[k] * turn, visit);
}

/// Upper bound of the velocity of a node along a unit impulse: paths to one corner are counted separately.
double inverse_mass_along(const Ties& ties, const Nodes& nodes, int node, const Vector3d& direction) {
  double sum = 0;
  transfer(ties, nodes, node, direction, Vector3d{},
           [&](std::size_t corner, const Vector3d& impulse, const Vector3d& moment) {
             sum += compliance(nodes.free_translations(corner), nodes.record[corner].inverse_mass, impulse);
             if (nodes.has_rotations())
               sum += compliance(nodes.free_rotations(corner), nodes.angular_velocity[corner].component[3],
                                 moment);
           });
  return sum;
}

/// Adds an impulse to a velocity, in the directions that are free. \return that of the support
Vector3d push(const SymmetricTensor<double>& free, double inverse, const Vector3d& impulse,
              const double* before, double* velocity, Reaction& support) {
  const Vector3d taken = free * impulse;
  Vector3d reaction{};
  for (std::size_t i = 0; i < 3; ++i) {
    velocity[i] += inverse * taken[i];
    reaction[i] = taken[i] - impulse[i];
  }
  support.before += dot(reaction, vector_at(before));
  support.after += dot(reaction, vector_at(velocity));
  return reaction;
}

void apply(const Ties& ties, Nodes& nodes, int node, const Vector3d& given, Reaction& support) {
  transfer(ties, nodes, node, given, Vector3d{},
           [&](std::size_t corner, const Vector3d& impulse, const Vector3d& moment) {
             NodeRecord& record = nodes.record[corner];
             const Vector3d reaction =
                 push(nodes.free_translations(corner), record.inverse_mass, impulse,
                      nodes.velocity_before[corner].component, record.velocity, support);
             support.impulse.add(vector_at(record.position), reaction);
             if (!nodes.has_rotations()) return;
             double* rate = nodes.angular_velocity[corner].component;
             support.impulse.angular += push(nodes.free_rotations(corner), rate[3], moment,
                                             nodes.angular_velocity_before[corner].component, rate, support);
           });
}

}  // namespace

Reaction stop_tied_at(const WallInRun& entry, const StepTimes& times, NodesInContact in_contact, Ties& ties,
                      Nodes& nodes) {
  Reaction support;
  ties.wall_impulse.assign(ties.node.size(), Vector3d{});
  ties.wall_friction.assign(ties.node.size(), Vector3d{});
  if (times.next <= 0) return support;
  const Vector3d normal = entry.wall.normal;
  const Vector3d wall_velocity = entry.wall.velocity;
  const double offset = dot(normal, entry.wall.point + (times.time + times.next) * wall_velocity);
  for (std::size_t i = ties.node.size(); i-- > 0;) {
    const Tie& tie = ties.node[i].tie;
    if (in_contact.has(index(tie.node))) continue;
    const Vector3d x = vector_at(nodes.record[index(tie.node)].position);
    const Vector3d v = tied_velocity(tie, nodes, times.next);
    const double height = dot(normal, x + times.next * v) - offset;
    if (height >= 0) continue;
    const double compliance = inverse_mass_along(ties, nodes, tie.node, normal);
    if (!(compliance > 0)) continue;
    ties.wall_impulse[i] = -height / times.next / compliance * normal;
    const Vector3d relative = v - wall_velocity;
    const Vector3d sliding = relative - dot(normal, relative) * normal;
    const double speed = norm(sliding);
    if (entry.wall.friction > 0 && speed > 0) {
      const double slip = inverse_mass_along(ties, nodes, tie.node, sliding / speed);
      const double stick = slip > 0 ? speed / slip : 0;
      ties.wall_friction[i] =
          -std::min(stick, entry.wall.friction * norm(ties.wall_impulse[i])) / speed * sliding;
    }
    apply(ties, nodes, tie.node, ties.wall_impulse[i] + ties.wall_friction[i], support);
  }
  carry_velocities(ties, nodes, times.next);
  return support;
}

WallReaction reaction_of_tied(const Ties& ties, const StepTimes& times, Nodes& nodes) {
  carry_velocities(ties, nodes, times.next);
  WallReaction reaction;
  for (std::size_t i = 0; i < ties.node.size(); ++i) {
    if (is_zero(ties.wall_impulse[i])) continue;
    const auto node = index(ties.node[i].tie.node);
    const NodeRecord& record = nodes.record[node];
    const Vector3d before = vector_at(nodes.velocity_before[node].component);
    const Vector3d after = vector_at(record.velocity);
    const Vector3d position = vector_at(record.position);
    reaction.normal.before += dot(ties.wall_impulse[i], before);
    reaction.normal.after += dot(ties.wall_impulse[i], after);
    reaction.friction.before += dot(ties.wall_friction[i], before);
    reaction.friction.after += dot(ties.wall_friction[i], after);
    reaction.normal.impulse.add(position, ties.wall_impulse[i]);
    reaction.friction.impulse.add(position, ties.wall_friction[i]);
  }
  return reaction;
}

}  // namespace brio
