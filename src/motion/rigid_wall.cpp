// Rigid walls against rigid bodies: projected Gauss-Seidel iterations (sequential impulses) over the nodes
// that would be behind the wall.

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "src/motion/rigid.hpp"

namespace brio {

namespace {

constexpr int most_passes = 50;
constexpr double converged_ratio = 1e-10;
// Fraction of an old overlap, left by rounding and by rotation, that a time step removes.
constexpr double overlap_recovery = 0.1;
// Nodes are considered that reach the wall at this multiple of their approach: other impulses of the step may
// rotate the body towards it.
constexpr double approach_factor = 2;

void find_touches(const WallInRun& entry, const StepTimes& times, NodesInContact in_contact, RigidBody& body,
                  const RigidMotion& motion, const Nodes& nodes) {
  const Vector3d normal = entry.wall.normal;
  const Vector3d wall_velocity = entry.wall.velocity;
  const double offset = dot(normal, entry.wall.point + times.time * wall_velocity);
  body.touch.clear();
  for (int node : body.node) {
    if (in_contact.has(index(node))) continue;
    const Vector3d x = position(nodes, node);
    const double height = dot(normal, x) - offset;
    const Vector3d arm = x - body.centre;
    const double reach = approach_factor * times.next * norm(motion.velocity_at(arm) - wall_velocity);
    if (height > reach) continue;
    WallTouch touch;
    touch.node = node;
    touch.arm = arm;
    touch.target = height >= 0 ? -height / times.next : overlap_recovery * -height / times.next;
    const double inverse = motion.inverse_mass_along(normal, arm);
    if (!(inverse > 0)) continue;
    touch.normal_mass = 1 / inverse;
    body.touch.push_back(touch);
  }
}

// \returns the change of the relative velocity.
double solve_normal(WallTouch& touch, const Vector3d& normal, const Vector3d& wall_velocity,
                    RigidMotion& motion) {
  const double along = dot(normal, motion.velocity_at(touch.arm) - wall_velocity);
  const double impulse = std::max(0.0, touch.impulse + touch.normal_mass * (touch.target - along));
  const double change = impulse - touch.impulse;
  touch.impulse = impulse;
  if (change != 0) motion.apply_impulse(change * normal, touch.arm);
  return std::abs(change) / touch.normal_mass;
}

// Against the slip, with the effective mass in its direction.
double solve_friction(WallTouch& touch, const Vector3d& normal, const Vector3d& wall_velocity,
                      double friction, RigidMotion& motion) {
  const Vector3d relative = motion.velocity_at(touch.arm) - wall_velocity;
  const Vector3d slip = relative - dot(normal, relative) * normal;
  const double speed = norm(slip);
  if (speed == 0) return 0;
  const double inverse = motion.inverse_mass_along(slip / speed, touch.arm);
  if (!(inverse > 0)) return 0;
  Vector3d impulse = touch.friction - slip / inverse;
  const double limit = friction * touch.impulse;
  const double size = norm(impulse);
  if (size > limit) impulse *= limit / size;
  const Vector3d change = impulse - touch.friction;
  touch.friction = impulse;
  motion.apply_impulse(change, touch.arm);
  return norm(change) * inverse;
}

void account(Reaction& reaction, const Vector3d& position, const Vector3d& impulse, const WallTouch& touch,
             const RigidMotion& motion) {
  reaction.impulse.add(position, impulse);
  reaction.before += dot(impulse, motion.velocity_before_at(touch.arm));
  reaction.after += dot(impulse, motion.velocity_at(touch.arm));
}

}  // namespace

double height_above(const WallInRun& entry, const RigidBody& body, const Nodes& nodes) {
  const Vector3d normal = entry.wall.normal;
  double least = HUGE_VAL;
  for (int node : body.node) least = std::min(least, dot(normal, position(nodes, node) - entry.wall.point));
  return least;
}

Contribution stop_at(const WallInRun& entry, const StepTimes& times, NodesInContact in_contact,
                     RigidBody& body, RigidMotion& motion, const Nodes& nodes) {
  if (times.next <= 0) return {};
  find_touches(entry, times, in_contact, body, motion, nodes);
  if (body.touch.empty()) return {};
  const Vector3d normal = entry.wall.normal;
  const Vector3d wall_velocity = entry.wall.velocity;
  double first = 0;
  for (int pass = 0; pass < most_passes; ++pass) {
    double residual = 0;
    for (WallTouch& touch : body.touch) {
      residual = std::max(residual, solve_normal(touch, normal, wall_velocity, motion));
      if (entry.wall.friction > 0)
        residual =
            std::max(residual, solve_friction(touch, normal, wall_velocity, entry.wall.friction, motion));
    }
    first = std::max(first, residual);
    if (residual <= converged_ratio * first) break;
  }
  WallReaction reaction;
  for (const WallTouch& touch : body.touch) {
    const Vector3d position = body.centre + touch.arm;
    account(reaction.normal, position, touch.impulse * normal, touch, motion);
    account(reaction.friction, position, touch.friction, touch, motion);
  }
  const RigidSupport held = support_against(motion, motion.impulse, motion.moment);
  Contribution sum = of_wall(reaction, entry);
  sum.external += Work{.before = held.work_before, .after = held.work_after};
  sum.supports.add(body.centre, held.impulse);
  sum.supports.angular += held.moment;
  return sum;
}

}  // namespace brio
