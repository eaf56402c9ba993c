#include "src/motion/rigid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

bool rotation_is_given(const RigidBody& body) {
  return body.is_given(3) || body.is_given(4) || body.is_given(5);
}

Tensor<double> turned(const Tensor<double>& inertia, const Quaternion<double>& attitude) {
  const Tensor<double> turn = rotation_matrix(attitude);
  return turn * inertia * transposed(turn);
}

// Inertia and the velocities before, at the present attitude.
void prepare(const RigidBody& body, RigidMotion& motion) {
  motion.centre = body.centre;
  motion.inertia = turned(body.inertia, body.attitude);
  motion.inverse_inertia =
      free_inverse(motion.inertia, body.axes, [&](int axis) { return body.is_given(axis + 3); });
  motion.velocity_before = motion.velocity;
  motion.angular_velocity = angular_velocity_of(motion, body.angular_momentum, motion.angular_velocity);
  motion.angular_velocity_before = motion.angular_velocity;
}

[[noreturn]] void turns_too_far() {
  throw Breakdown(
      "a rigid part rotates too far in one time step; time.step_scale or time.step must be smaller");
}

constexpr std::size_t nodes_per_task = 512;

void place_nodes(const RigidBody& body, Nodes& nodes, ThreadTeam& team) {
  const Tensor<double> turn = rotation_matrix(body.attitude);
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
  const Tensor<double> turn = rotation_matrix(body.attitude);
  for (std::size_t j = 0; j < body.joint.size(); ++j)
    body.joint_before[j] = body.centre + turn * body.arm[body.joint[j]];
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
  const Vector3d moment = load.factor(time) * load.force;
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
    energy.half += 0.5 * (body.mass * squared_norm(motion.velocity) +
                          dot(body.angular_momentum, motion.angular_velocity));
    energy.now += 0.5 * (body.mass * dot(motion.velocity, motion.velocity_before) +
                         dot(body.angular_momentum, motion.angular_velocity_before));
  }
  return energy;
}

void add_momentum(const RigidBodies& bodies, Momentum& sum) {
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    const RigidBody& body = bodies.body[b];
    const Vector3d linear = body.mass * bodies.motion[b].velocity;
    sum.total.add(body.centre, linear);
    sum.total.angular += body.angular_momentum;
    sum.linear_size += norm(linear);
    sum.angular_size += norm(linear) * norm(body.centre) + norm(body.angular_momentum);
  }
}

void gather_forces(RigidBodies& bodies, std::span<const ActiveLoad> loads, double time, bool by_nodes,
                   const Nodes& nodes) {
  Vector3d gravity{};
  for (RigidBody& body : bodies.body) body.torque = {};
  for (const ActiveLoad& entry : loads) {
    if (const auto* load = std::get_if<GravityLoad>(&entry.load))
      gravity += load->factor(time) * load->acceleration;
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
      const Vector3d force = vector_at(nodes.force[node].component);
      body.force += force;
      body.moment += cross(vector_at(nodes.record[node].position) - body.centre, force);
    }
    if (!nodes.has_rotations()) continue;
    for (const std::size_t i : body.joint)
      body.moment += vector_at(nodes.moment[index(body.node[i])].component);
  }
}

double load_power(const RigidBodies& bodies) {
  double sum = 0;
  for (std::size_t b = 0; b < bodies.body.size(); ++b)
    sum += dot(bodies.body[b].weight, bodies.motion[b].velocity) +
           dot(bodies.body[b].torque, bodies.motion[b].angular_velocity);
  return sum;
}

Impulse load_resultant(const RigidBodies& bodies) {
  Impulse sum;
  for (const RigidBody& body : bodies.body) {
    sum.add(body.centre, body.weight);
    sum.angular += body.torque;
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
    motion.velocity = transposed_times(body.axes, linear);
    motion.angular_velocity = angular_velocity_of(motion, turning, transposed_times(body.axes, angular));
    if (rotation_is_given(body)) body.angular_momentum = motion.inertia * motion.angular_velocity;
    const Vector3d impulse = body.mass * (motion.velocity - pushed);
    const Vector3d moment = body.angular_momentum - turning;
    body.support = impulse;
    reaction.impulse.add(body.centre, impulse);
    reaction.impulse.angular += moment;
    reaction.before += dot(impulse, motion.velocity_before) + dot(moment, motion.angular_velocity_before);
    reaction.after += dot(impulse, motion.velocity) + dot(moment, motion.angular_velocity);
  }
  return reaction;
}

void add_contact_impulses(RigidBodies& bodies) {
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    RigidBody& body = bodies.body[b];
    RigidMotion& motion = bodies.motion[b];
    if (!is_zero(motion.moment)) {
      body.angular_momentum += motion.moment;
      motion.angular_velocity = angular_velocity_of(motion, body.angular_momentum, motion.angular_velocity);
      if (rotation_is_given(body)) body.angular_momentum = motion.inertia * motion.angular_velocity;
    }
    motion.impulse = {};
    motion.moment = {};
  }
}

void carry_velocities(const RigidBodies& bodies, Nodes& nodes, ThreadTeam& team) {
  for (std::size_t b = 0; b < bodies.body.size(); ++b) {
    const RigidBody& body = bodies.body[b];
    const RigidMotion& motion = bodies.motion[b];
    team.for_ranges(body.node.size(), nodes_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        NodeRecord& record = nodes.record[index(body.node[i])];
        const Vector3d velocity = motion.velocity_at(vector_at(record.position) - body.centre);
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
    const std::optional<RigidTurn> turn = turn_over(motion, body.angular_momentum, step);
    if (!turn) turns_too_far();
    const Vector3d half = 0.5 * turn->rotation;
    body.attitude = normalized(Quaternion<double>{1, half.x, half.y, half.z} * body.attitude);
    if (rotation_is_given(body)) {
      const Vector3d rate = motion.angular_velocity;
      const Vector3d added = turn->momentum - body.angular_momentum;
      body.angular_momentum += added;
      reaction.impulse.angular += added;
      for (int axis = 0; axis < 3; ++axis)
        if (body.is_given(axis + 3))
          reaction.after += dot(body.axes.row(axis), added) * dot(body.axes.row(axis), rate);
    }
    prepare(body, motion);
    place_nodes(body, nodes, team);
  }
  carry_velocities(bodies, nodes, team);
  for (const RigidBody& body : bodies.body) take_displacements(body, step, nodes);
  return reaction;
}

}  // namespace brio
