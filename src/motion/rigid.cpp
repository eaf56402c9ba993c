#include "src/motion/rigid.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"

namespace brio {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d matrix;
  matrix << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return matrix;
}

bool rotation_is_given(const RigidBody& body) {
  return body.is_given(3) || body.is_given(4) || body.is_given(5);
}

// Inverse within the rows and columns of the free rotations about the body's axes, 0 elsewhere.
Matrix3d free_inverse(const RigidBody& body, const Matrix3d& inertia) {
  if (!rotation_is_given(body)) return inertia.inverse();
  const Matrix3d along_axes = body.axes * inertia * body.axes.transpose();
  Matrix3d reduced = along_axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (!body.is_given(axis + 3)) continue;
    reduced.row(axis).setZero();
    reduced.col(axis).setZero();
    reduced(axis, axis) = along_axes(axis, axis);
  }
  Matrix3d inverse = reduced.inverse();
  for (int axis = 0; axis < 3; ++axis)
    if (body.is_given(axis + 3)) inverse(axis, axis) = 0;
  return body.axes.transpose() * inverse * body.axes;
}

Matrix3d turned(const Matrix3d& inertia, const Quaterniond& attitude) {
  const Matrix3d turn = attitude.toRotationMatrix();
  return turn * inertia * turn.transpose();
}

// The angular velocity whose given components are those of `given` and whose momentum has the free components
// of `momentum`.
Vector3d angular_velocity_of(const RigidMotion& motion, const Vector3d& momentum, Vector3d given) {
  given = motion.axes * given;
  for (int axis = 0; axis < 3; ++axis)
    if (!motion.rotation_is_given(axis)) given[axis] = 0;
  given = motion.axes.transpose() * given;
  return given + motion.inverse_inertia * (momentum - motion.inertia * given);
}

// Inertia and the velocities before, at the present attitude.
void prepare(const RigidBody& body, RigidMotion& motion) {
  motion.centre = body.centre;
  motion.inertia = turned(body.inertia, body.attitude);
  motion.inverse_inertia = free_inverse(body, motion.inertia);
  motion.velocity_before = motion.velocity;
  motion.angular_velocity = angular_velocity_of(motion, body.angular_momentum, motion.angular_velocity);
  motion.angular_velocity_before = motion.angular_velocity;
}

Quaterniond normalized(const Quaterniond& q) {
  const double size = std::sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
  return {q.w() / size, q.x() / size, q.y() / size, q.z() / size};
}

// Cayley transform of a vector: a turn by the angle 2 atan(|v|/2) about it.
Quaterniond cayley(const Vector3d& v) { return normalized({1, 0.5 * v[0], 0.5 * v[1], 0.5 * v[2]}); }

// A turn by the angle |v| about v.
Quaterniond turn_by(const Vector3d& v) {
  const double angle = v.norm();
  if (angle == 0) return Quaterniond::Identity();
  const double share = std::sin(0.5 * angle) / angle;
  return normalized({std::cos(0.5 * angle), share * v[0], share * v[1], share * v[2]});
}

[[noreturn]] void turns_too_far() {
  throw Breakdown(
      "a rigid part rotates too far in one time step; time.step_scale or time.step must be smaller");
}

constexpr int most_iterations = 50;
// Newton's method doubles the digits: after a change below this share the next would be rounding.
constexpr double newton_share = 1e-9;
constexpr double converged_change = 1e-15;

// Midpoint rule for the angular momentum m in the body's frame, m' = m x (J^-1 m).
Quaterniond free_turn(const RigidBody& body, double step) {
  const Vector3d start = body.attitude.conjugate()._transformVector(body.angular_momentum);
  const Matrix3d inverse = body.inertia.inverse();
  Vector3d end = start + step * start.cross(inverse * start);
  for (int i = 0; i < most_iterations; ++i) {
    const Vector3d mean = 0.5 * (start + end);
    const Vector3d rate = inverse * mean;
    const Vector3d residual = end - start - step * mean.cross(rate);
    const Matrix3d slope =
        Matrix3d::Identity() - 0.5 * step * (cross_matrix(mean) * inverse - cross_matrix(rate));
    const Vector3d change = slope.inverse() * residual;
    end -= change;
    if (change.norm() <= newton_share * start.norm())
      return normalized(body.attitude * cayley(step * (inverse * (0.5 * (start + end)))));
  }
  turns_too_far();
}

// Free components of the angular momentum are kept, given components of the angular velocity too; the turn is
// by the mean of the angular velocities at both ends. \return the momentum that supports added.
Vector3d given_turn(RigidBody& body, RigidMotion& motion, double step) {
  const Quaterniond attitude = body.attitude;
  const Vector3d start = motion.angular_velocity;
  Vector3d end = start;
  double last_change = HUGE_VAL;
  for (int i = 0; i < most_iterations; ++i) {
    body.attitude = normalized(turn_by(0.5 * step * (start + end)) * attitude);
    motion.inertia = turned(body.inertia, body.attitude);
    motion.inverse_inertia = free_inverse(body, motion.inertia);
    const Vector3d next = angular_velocity_of(motion, body.angular_momentum, start);
    const double change = (next - end).norm();
    end = next;
    // Below the rounding of what it is computed from, a change does not get smaller.
    const bool is_rounding = change <= newton_share * start.norm() && change >= last_change;
    last_change = change;
    if (is_rounding || change <= converged_change * start.norm()) {
      Vector3d added = motion.inertia * end - body.angular_momentum;
      body.angular_momentum += added;
      return added;
    }
  }
  turns_too_far();
}

constexpr std::size_t nodes_per_task = 4096;

void place_nodes(const RigidBody& body, Nodes& nodes, ThreadTeam& team) {
  const Matrix3d turn = body.attitude.toRotationMatrix();
  team.for_ranges(body.node.size(), nodes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3d x = body.centre + turn * body.arm[i];
      double* position = nodes.record[index(body.node[i])].position;
      for (int axis = 0; axis < 3; ++axis) position[axis] = x[axis];
    }
  });
}

// Before the body moves.
void keep_joints(RigidBody& body) {
  if (body.joint.empty()) return;
  const Matrix3d turn = body.attitude.toRotationMatrix();
  for (std::size_t j = 0; j < body.joint.size(); ++j)
    body.joint_before[j] = to_vector(body.centre + turn * body.arm[body.joint[j]]);
}

void take_displacements(const RigidBody& body, double step, Nodes& nodes) {
  for (std::size_t j = 0; j < body.joint.size(); ++j) {
    NodeRecord& record = nodes.record[index(body.node[body.joint[j]])];
    for (std::size_t axis = 0; axis < 3; ++axis)
      record.velocity[axis] = (record.position[axis] - body.joint_before[j][axis]) / step;
  }
}

void add_torques(RigidBodies& bodies, const NodalLoad& load, double time) {
  if (load.bodies.empty()) return;
  const Vector3d moment = load.factor(time) * Vector3d(load.force.data());
  for (const std::size_t b : load.bodies) bodies.body[b].torque += moment;
}

}  // namespace

bool RigidBody::is_given(int axis) const {
  return std::any_of(given.begin(), given.end(), [&](const auto& one) { return one.axis == axis; });
}

void start(RigidBody& body, RigidMotion& motion, const Vector3d& velocity, const Vector3d& angular_velocity) {
  motion.mass = body.mass;
  motion.axes = body.axes;
  for (int axis = 0; axis < 3; ++axis) motion.inverse_mass[axis] = body.is_given(axis) ? 0 : 1 / body.mass;
  motion.velocity = velocity;
  motion.angular_velocity = angular_velocity;
  body.angular_momentum = turned(body.inertia, body.attitude) * angular_velocity;
  prepare(body, motion);
}

KineticEnergy kinetic_energy(const RigidBodies& bodies) {
  KineticEnergy energy;
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    const RigidBody& body = bodies.body[b];
    const RigidMotion& motion = bodies.motion[b];
    energy.half += 0.5 * (body.mass * motion.velocity.squaredNorm() +
                          body.angular_momentum.dot(motion.angular_velocity));
    energy.now += 0.5 * (body.mass * motion.velocity.dot(motion.velocity_before) +
                         body.angular_momentum.dot(motion.angular_velocity_before));
  }
  return energy;
}

void add_momentum(const RigidBodies& bodies, Momentum& sum) {
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    const RigidBody& body = bodies.body[b];
    const Vector3d linear = body.mass * bodies.motion[b].velocity;
    sum.total.add(to_vector(body.centre), to_vector(linear));
    add_to(sum.total.angular, to_vector(body.angular_momentum));
    sum.linear_size += linear.norm();
    sum.angular_size += linear.norm() * body.centre.norm() + body.angular_momentum.norm();
  }
}

void gather_forces(RigidBodies& bodies, std::span<const ActiveLoad> loads, double time, bool by_nodes,
                   const Nodes& nodes) {
  Vector3d gravity = Vector3d::Zero();
  for (RigidBody& body : bodies.body) body.torque.setZero();
  for (const ActiveLoad& entry : loads) {
    if (const auto* load = std::get_if<GravityLoad>(&entry.load))
      gravity += load->factor(time) * Vector3d(load->acceleration.data());
    else if (const auto* nodal = std::get_if<NodalLoad>(&entry.load))
      add_torques(bodies, *nodal, time);
  }
  for (RigidBody& body : bodies.body) {
    body.weight = body.mass * gravity;
    body.force = body.weight;
    body.moment = body.torque;
    if (!by_nodes) continue;
    for (int entry : body.node) {
      const auto node = index(entry);
      const Vector3d force(nodes.force[node].component);
      body.force += force;
      body.moment += (Vector3d(nodes.record[node].position) - body.centre).cross(force);
    }
    if (!nodes.has_rotations()) continue;
    for (const std::size_t i : body.joint)
      body.moment += Vector3d(nodes.moment[index(body.node[i])].component);
  }
}

double load_power(const RigidBodies& bodies) {
  double sum = 0;
  for (std::size_t b = 0; b < bodies.body.size(); ++b)
    sum += bodies.body[b].weight.dot(bodies.motion[b].velocity) +
           bodies.body[b].torque.dot(bodies.motion[b].angular_velocity);
  return sum;
}

Impulse load_resultant(const RigidBodies& bodies) {
  Impulse sum;
  for (const RigidBody& body : bodies.body) {
    sum.add(to_vector(body.centre), to_vector(body.weight));
    add_to(sum.angular, to_vector(body.torque));
  }
  return sum;
}

Reaction accelerate(RigidBodies& bodies, const StepTimes& times) {
  Reaction reaction;
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    RigidBody& body = bodies.body[b];
    RigidMotion& motion = bodies.motion[b];
    const Vector3d pushed = motion.velocity + times.mean() / body.mass * body.force;
    motion.velocity = pushed;
    body.angular_momentum += times.mean() * body.moment;
    const Vector3d turning = body.angular_momentum;
    if (body.given.empty()) {
      motion.angular_velocity = motion.inverse_inertia * turning;
      continue;
    }
    const Vector3d linear_before = body.axes * motion.velocity_before;
    const Vector3d angular_before = body.axes * motion.angular_velocity_before;
    Vector3d linear = body.axes * pushed, angular = angular_before;
    for (const PrescribedRigid& one : body.given) {
      double& rate = one.axis < 3 ? linear[one.axis] : angular[one.axis - 3];
      const double before = one.axis < 3 ? linear_before[one.axis] : angular_before[one.axis - 3];
      rate = given_velocity(one.kind, one.curve, times).after(before);
    }
    motion.velocity = body.axes.transpose() * linear;
    motion.angular_velocity = angular_velocity_of(motion, turning, body.axes.transpose() * angular);
    if (rotation_is_given(body)) body.angular_momentum = motion.inertia * motion.angular_velocity;
    const Vector3d impulse = body.mass * (motion.velocity - pushed);
    const Vector3d moment = body.angular_momentum - turning;
    body.support = impulse;
    reaction.impulse.add(to_vector(body.centre), to_vector(impulse));
    add_to(reaction.impulse.angular, to_vector(moment));
    reaction.before += impulse.dot(motion.velocity_before) + moment.dot(motion.angular_velocity_before);
    reaction.after += impulse.dot(motion.velocity) + moment.dot(motion.angular_velocity);
  }
  return reaction;
}

void add_contact_impulses(RigidBodies& bodies) {
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    RigidBody& body = bodies.body[b];
    RigidMotion& motion = bodies.motion[b];
    if (!motion.moment.isZero(0)) {
      body.angular_momentum += motion.moment;
      motion.angular_velocity = angular_velocity_of(motion, body.angular_momentum, motion.angular_velocity);
      if (rotation_is_given(body)) body.angular_momentum = motion.inertia * motion.angular_velocity;
    }
    motion.impulse.setZero();
    motion.moment.setZero();
  }
}

void carry_velocities(const RigidBodies& bodies, Nodes& nodes, ThreadTeam& team) {
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    const RigidBody& body = bodies.body[b];
    const RigidMotion& motion = bodies.motion[b];
    team.for_ranges(body.node.size(), nodes_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        NodeRecord& record = nodes.record[index(body.node[i])];
        const Vector3d velocity = motion.velocity_at(Vector3d(record.position) - body.centre);
        for (int axis = 0; axis < 3; ++axis) record.velocity[axis] = velocity[axis];
      }
    });
    if (!nodes.has_rotations()) continue;
    for (const std::size_t i : body.joint)
      for (int axis = 0; axis < 3; ++axis)
        nodes.angular_velocity[index(body.node[i])].component[axis] = motion.angular_velocity[axis];
  }
}

Reaction move(RigidBodies& bodies, double step, Nodes& nodes, ThreadTeam& team) {
  Reaction reaction;
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    RigidBody& body = bodies.body[b];
    RigidMotion& motion = bodies.motion[b];
    keep_joints(body);
    body.centre += step * motion.velocity;
    if (rotation_is_given(body)) {
      const Vector3d rate = motion.angular_velocity;
      const Vector3d added = given_turn(body, motion, step);
      add_to(reaction.impulse.angular, to_vector(added));
      for (int axis = 0; axis < 3; ++axis)
        if (body.is_given(axis + 3))
          reaction.after += body.axes.row(axis).dot(added) * body.axes.row(axis).dot(rate);
    } else {
      body.attitude = free_turn(body, step);
    }
    prepare(body, motion);
    place_nodes(body, nodes, team);
  }
  carry_velocities(bodies, nodes, team);
  for (const RigidBody& body : bodies.body) take_displacements(body, step, nodes);
  return reaction;
}

}  // namespace brio
