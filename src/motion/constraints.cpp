#include "src/motion/constraints.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Duals change no other prescribed component, so that one may be set after the other.
Reaction prescribe_skew(PrescribedNodes& given, const StepTimes& times, Nodes& nodes) {
  Reaction reaction;
  const GivenVelocity velocity_given = given_velocity(given.kind, given.curve, times);
  for (std::size_t k = 0; k < given.nodes.size(); ++k) {
    const auto node = index(given.nodes[k]);
    double* velocity = given.turns() ? nodes.angular_velocity[node].component : nodes.record[node].velocity;
    const double inertia = given.turns() ? nodes.rotational_inertia[node] : nodes.mass[node];
    const double* before =
        (given.turns() ? nodes.angular_velocity_before : nodes.velocity_before)[node].component;
    const Vector3d was = vector_at(before), is = vector_at(velocity);
    const double change = velocity_given.after(dot(given.direction[k], was)) - dot(given.direction[k], is);
    Vector3d& impulse = given.impulse[k];
    for (std::size_t i = 0; i < 3; ++i) {
      velocity[i] += change * given.dual[k][i];
      impulse[i] = inertia * change * given.dual[k][i];
    }
    if (given.turns()) {
      reaction.impulse.angular += impulse;
    } else {
      reaction.impulse.add(position(nodes, node), impulse);
    }
    reaction.before += dot(impulse, was);
  }
  return reaction;
}

/// Of an impulse, squared.
constexpr double rounding_of_free_share = 1e-14;

}  // namespace

double work_after(const PrescribedNodes& given, const Nodes& nodes) {
  double sum = 0;
  for (std::size_t k = 0; k < given.impulse.size(); ++k) {
    const auto node = index(given.nodes[k]);
    const double* velocity =
        given.turns() ? nodes.angular_velocity[node].component : nodes.record[node].velocity;
    sum += dot(given.impulse[k], vector_at(velocity));
  }
  return sum;
}

double compliance(const SymmetricTensor<double>& free, double inverse, const Vector3d& impulse) {
  const double share = dot(impulse, free * impulse);
  return share > rounding_of_free_share * dot(impulse, impulse) ? inverse * share : 0;
}

GivenVelocity given_velocity(MotionKind kind, const Curve& curve, const StepTimes& times) {
  switch (kind) {
    case MotionKind::displacement:
      return {times.next > 0 ? (curve(times.time + times.next) - curve(times.time)) / times.next
                             : curve.slope(times.time)};
    case MotionKind::velocity:
      return {curve(times.time + 0.5 * times.next)};
    case MotionKind::acceleration:
      return {times.mean() * curve(times.time), true};
  }
  return {};
}

Reaction prescribe(PrescribedNodes& given, const StepTimes& times, Nodes& nodes) {
  if (given.is_skew()) return prescribe_skew(given, times, nodes);
  Reaction reaction;
  const bool turns = given.turns();
  const auto axis = index(turns ? given.axis - 3 : given.axis);
  const GivenVelocity velocity_given = given_velocity(given.kind, given.curve, times);
  for (int entry : given.nodes) {
    const auto node = index(entry);
    double& velocity =
        turns ? nodes.angular_velocity[node].component[axis] : nodes.record[node].velocity[axis];
    const double inertia = turns ? nodes.rotational_inertia[node] : nodes.mass[node];
    const double before =
        (turns ? nodes.angular_velocity_before : nodes.velocity_before)[node].component[axis];
    const double after = velocity_given.after(before);
    Vector3d impulse{};
    impulse[axis] = inertia * (after - velocity);
    velocity = after;
    if (turns) {
      reaction.impulse.angular += impulse;
    } else {
      reaction.impulse.add(position(nodes, node), impulse);
    }
    reaction.before += impulse[axis] * before;
    reaction.after += impulse[axis] * after;
  }
  return reaction;
}

WallReaction stop_at(const WallInRun& entry, const StepTimes& times, NodesInContact in_contact,
                     Nodes& nodes) {
  const RigidWall& wall = entry.wall;
  WallReaction reaction;
  double offset = 0;  // of the plane along its normal at the end of the step
  for (std::size_t i = 0; i < 3; ++i)
    offset += wall.normal[i] * (wall.point[i] + wall.velocity[i] * (times.time + times.next));
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    NodeRecord& record = nodes.record[node];
    const double height = wall.normal[0] * (record.position[0] + times.next * record.velocity[0]) +
                          wall.normal[1] * (record.position[1] + times.next * record.velocity[1]) +
                          wall.normal[2] * (record.position[2] + times.next * record.velocity[2]) - offset;
    if (height >= 0 || times.next <= 0 || in_contact.has(node)) continue;
    // Impulse along the normal that puts the node on the wall; prescribed axes do not move.
    const SymmetricTensor<double> free = nodes.free_translations(node);
    const double yielding = compliance(free, record.inverse_mass, wall.normal);
    if (yielding <= 0) continue;
    const double normal_impulse = -height / times.next / yielding;
    Vector3d normal{}, tangential{}, sliding{};
    double along = 0;
    for (std::size_t i = 0; i < 3; ++i) along += wall.normal[i] * (record.velocity[i] - wall.velocity[i]);
    for (std::size_t i = 0; i < 3; ++i) {
      normal[i] = normal_impulse * wall.normal[i];
      sliding[i] = record.velocity[i] - wall.velocity[i] - along * wall.normal[i];
    }
    const double speed = std::sqrt(dot(sliding, sliding));
    if (wall.friction > 0 && speed > 0) {
      const double stick = nodes.mass[node] * speed;
      const double size = std::min(stick, wall.friction * normal_impulse);
      for (std::size_t i = 0; i < 3; ++i) tangential[i] = -size * sliding[i] / speed;
    }
    const Vector3d x = position(nodes, node);
    normal = free * normal;
    tangential = free * tangential;
    for (std::size_t i = 0; i < 3; ++i) {
      const double before = nodes.velocity_before[node].component[i];
      const double after = record.velocity[i] + (normal[i] + tangential[i]) * record.inverse_mass;
      record.velocity[i] = after;
      reaction.normal.before += normal[i] * before;
      reaction.normal.after += normal[i] * after;
      reaction.friction.before += tangential[i] * before;
      reaction.friction.after += tangential[i] * after;
    }
    reaction.normal.impulse.add(x, normal);
    reaction.friction.impulse.add(x, tangential);
  }
  return reaction;
}

}  // namespace brio
