#include "src/motion/springs.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"

namespace brio {

namespace {

Vector3d place_of(const SpringAnchor& anchor, const Nodes& nodes) {
  return anchor.node < 0 ? anchor.point : vector_at(nodes.record[index(anchor.node)].position);
}

Vector3d velocity_of(const SpringAnchor& anchor, const Nodes& nodes) {
  return anchor.node < 0 ? Vector3d{} : vector_at(nodes.record[index(anchor.node)].velocity);
}

Vector3d spin_of(const SpringAnchor& anchor, const RigidBodies& bodies, const Nodes& nodes) {
  if (anchor.node < 0) return Vector3d{};
  if (anchor.body >= 0) return bodies.motion[index(anchor.body)].angular_velocity;
  return vector_at(nodes.angular_velocity[index(anchor.node)].component);
}

double rate_of(const SpringInRun& spring, const RigidBodies& bodies, const Nodes& nodes) {
  const auto& [from, to] = spring.end;
  if (spring.is_torsional)
    return dot(spring.direction, spin_of(to, bodies, nodes) - spin_of(from, bodies, nodes));
  return dot(spring.direction, velocity_of(to, nodes) - velocity_of(from, nodes));
}

void measure(SpringInRun& spring, const Nodes& nodes) {
  const Vector3d between = place_of(spring.end[1], nodes) - place_of(spring.end[0], nodes);
  const double distance = norm(between);
  spring.direction = distance > 0 ? between / distance : Vector3d{};
  spring.elongation = distance - spring.length;
}

/// Rotation vector of an end over the last step.
Vector3d turn_of(SpringAnchor& anchor, double last_step, const RigidBodies& bodies, const Nodes& nodes) {
  if (anchor.body < 0) return last_step * spin_of(anchor, bodies, nodes);
  const Quaternion<double>& now = bodies.body[index(anchor.body)].attitude;
  const Quaternion<double> turn = now * conjugate(anchor.attitude);
  anchor.attitude = now;
  const double sine = norm(vector_part(turn));
  return sine > 0 ? 2 * std::atan2(sine, turn.w) / sine * vector_part(turn) : Vector3d{};
}

// The angle grows by the rotations about the axis as it lies in the middle of the step.
void measure_angle(SpringInRun& spring, double last_step, const RigidBodies& bodies, const Nodes& nodes) {
  const Vector3d of_from = turn_of(spring.end[0], last_step, bodies, nodes);
  const Vector3d of_to = turn_of(spring.end[1], last_step, bodies, nodes);
  Vector3d middle = spring.direction;
  if (!is_zero(of_from)) {
    middle = turned_by(0.5 * of_from, spring.direction);
    spring.direction = normalized(turned_by(of_from, spring.direction));
  }
  spring.elongation += dot(middle, of_to - of_from);
}

bool is_removed(const SpringAnchor& anchor, const Nodes& nodes) {
  return anchor.node >= 0 && anchor.body < 0 && nodes.record[index(anchor.node)].inverse_mass == 0;
}

void add_force(const SpringAnchor& anchor, const Vector3d& force, Nodes& nodes) {
  if (anchor.node < 0) return;
  double* sum = nodes.force[index(anchor.node)].component;
  for (int axis = 0; axis < 3; ++axis) sum[axis] += force[axis];
}

void add_moment(const SpringAnchor& anchor, const Vector3d& moment, Nodes& nodes) {
  if (anchor.node < 0 || anchor.body >= 0) return;
  double* sum = nodes.moment[index(anchor.node)].component;
  for (int axis = 0; axis < 3; ++axis) sum[axis] += moment[axis];
}

Vector3d arm_of(const SpringAnchor& anchor, const RigidBodies& bodies, const Nodes& nodes) {
  return place_of(anchor, nodes) - bodies.body[index(anchor.body)].centre;
}

/// Acceleration along a direction by the forces known so far, and by a unit force along it; or angular
/// acceleration by moments.
struct Response {
  double acceleration = 0;
  double inverse_mass = 0;
};

Response response_of(const SpringAnchor& anchor, const Vector3d& direction, const RigidBodies& bodies,
                     const Nodes& nodes) {
  if (anchor.node < 0) return {};
  if (anchor.body >= 0) {
    const RigidBody& body = bodies.body[index(anchor.body)];
    const RigidMotion& motion = bodies.motion[index(anchor.body)];
    const Vector3d arm = arm_of(anchor, bodies, nodes);
    const Vector3d turning = motion.inverse_inertia * body.moment;
    return {dot(direction, motion.free_inverse_mass() * body.force + cross(turning, arm)),
            motion.inverse_mass_along(direction, arm)};
  }
  const auto node = index(anchor.node);
  const Vector3d along = nodes.free_inverse_mass(node) * direction;
  const double* force = nodes.force[node].component;
  return {dot(along, vector_at(force)), dot(along, direction)};
}

Response turning_response_of(const SpringAnchor& anchor, const Vector3d& axis, const RigidBodies& bodies,
                             const Nodes& nodes) {
  if (anchor.node < 0) return {};
  if (anchor.body >= 0) {
    const RigidMotion& motion = bodies.motion[index(anchor.body)];
    const Vector3d along = motion.inverse_inertia * axis;
    return {dot(along, bodies.body[index(anchor.body)].moment), dot(along, axis)};
  }
  const auto node = index(anchor.node);
  const Vector3d along = nodes.free_inverse_inertia(node) * axis;
  const double* moment = nodes.moment[node].component;
  return {dot(along, vector_at(moment)), dot(along, axis)};
}

void twist(const SpringAnchor& anchor, const Vector3d& moment, RigidBodies& bodies, Nodes& nodes) {
  if (anchor.body < 0) return add_moment(anchor, moment, nodes);
  bodies.body[index(anchor.body)].moment += moment;
}

void pull(const SpringAnchor& anchor, const Vector3d& force, RigidBodies& bodies, Nodes& nodes) {
  if (anchor.body < 0) {
    add_force(anchor, force, nodes);
    return;
  }
  RigidBody& body = bodies.body[index(anchor.body)];
  body.force += force;
  body.moment += cross(arm_of(anchor, bodies, nodes), force);
}

// The rate of elongation at the time of the step is r + h/2 (a - d w): r that of the half step before, a by
// the other forces, d = c rate the force of the dashpot, w the inverse mass along the line.
double dashpot_force(const SpringInRun& spring, double mean_step, const RigidBodies& bodies,
                     const Nodes& nodes) {
  const auto respond = spring.is_torsional ? turning_response_of : response_of;
  const Response from = respond(spring.end[0], spring.direction, bodies, nodes);
  const Response to = respond(spring.end[1], spring.direction, bodies, nodes);
  const double rate =
      rate_of(spring, bodies, nodes) + 0.5 * mean_step * (to.acceleration - from.acceleration);
  const double inverse_mass = from.inverse_mass + to.inverse_mass;
  return spring.damping * rate / (1 + 0.5 * mean_step * spring.damping * inverse_mass);
}

double largest_inverse_mass(const AnchoredMass& mass, const RigidBodies& bodies, const Nodes& nodes) {
  if (const auto node = index(mass.node); mass.body < 0)
    return nodes.prescribed_translations(node) == 7 ? 0 : nodes.record[node].inverse_mass;
  const RigidMotion& motion = bodies.motion[index(mass.body)];
  return largest_component(motion.inverse_mass) + mass.arm * mass.arm * trace(motion.inverse_inertia);
}

// Zero where nothing turns.
double largest_inverse_inertia(const AnchoredMass& mass, const RigidBodies& bodies, const Nodes& nodes) {
  if (mass.torsional_stiffness == 0 && mass.torsional_damping == 0) return 0;
  if (mass.body < 0) {
    const auto node = index(mass.node);
    return nodes.prescribed_rotations(node) == 7 ? 0 : nodes.angular_velocity[node].component[3];
  }
  return trace(bodies.motion[index(mass.body)].inverse_inertia);
}

/// Of what resists the elongation and, in tension, a motion across it.
double largest_stiffness(const SpringInRun& spring) {
  if (spring.is_torsional) return spring.stiffness;
  const double distance = spring.elongation + spring.length;
  return distance > 0 && spring.force > 0 ? std::max(spring.stiffness, spring.force / distance)
                                          : spring.stiffness;
}

/// Largest time step with dt^2 w2 + 2 dt d <= 4.
double stable_step(double squared_frequency, double damping) {
  const double sum = damping + std::sqrt(damping * damping + 4 * squared_frequency);
  return sum > 0 ? 4 / sum : std::numeric_limits<double>::infinity();
}

bool is_beyond_strength(const SpringInRun& spring, double force) {
  return (spring.is_torsional ? std::abs(force) : force) > spring.strength;
}

// What it stores with the work of the force of the last step, and none in the present one. \param growth of
// the elongation since
Contribution break_off(SpringInRun& spring, double growth) {
  const Contribution sum{.internal = -spring.energy, .deleted = spring.energy + 0.5 * spring.force * growth};
  spring.is_broken = true;
  spring.energy = spring.force = spring.dashpot = 0;
  return sum;
}

}  // namespace

double force_at(const SpringInRun& spring, double elongation) {
  const ForceTable& table = spring.table;
  if (table.empty()) return spring.stiffness * elongation;
  if (elongation <= table.front()[0]) return table.front()[1];
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (elongation > table[i][0]) continue;
    const double share = (elongation - table[i - 1][0]) / (table[i][0] - table[i - 1][0]);
    return table[i - 1][1] + share * (table[i][1] - table[i - 1][1]);
  }
  return table.back()[1];
}

// The trapezoidal rule between the points of the table is exact.
double energy_at(const SpringInRun& spring, double elongation) {
  if (spring.table.empty()) return 0.5 * spring.stiffness * elongation * elongation;
  const double lower = std::min(elongation, 0.0), upper = std::max(elongation, 0.0);
  double sum = 0, last = lower;
  const auto add_to_point = [&](double point) {
    sum += 0.5 * (force_at(spring, last) + force_at(spring, point)) * (point - last);
    last = point;
  };
  for (const auto& point : spring.table)
    if (point[0] > last && point[0] < upper) add_to_point(point[0]);
  add_to_point(upper);
  return elongation < 0 ? -sum : sum;
}

double start(Springs& springs, const Nodes& nodes) {
  double sum = 0;
  for (SpringInRun& spring : springs.spring) {
    if (!spring.is_torsional) measure(spring, nodes);
    spring.force = force_at(spring, spring.elongation);
    spring.energy = energy_at(spring, spring.elongation);
    sum += spring.energy;
  }
  return sum;
}

Contribution stretch(Springs& springs, double last_step, const RigidBodies& bodies, Nodes& nodes) {
  Contribution sum;
  for (SpringInRun& spring : springs.spring) {
    if (spring.is_broken) continue;
    const double before = spring.elongation;
    if (spring.is_torsional) {
      measure_angle(spring, last_step, bodies, nodes);
    } else {
      measure(spring, nodes);
    }
    const double force = force_at(spring, spring.elongation);
    if (is_beyond_strength(spring, force) || is_removed(spring.end[0], nodes) ||
        is_removed(spring.end[1], nodes)) {
      sum += break_off(spring, spring.elongation - before);
      continue;
    }
    spring.force = force;
    const double energy = energy_at(spring, spring.elongation);
    sum.internal += energy - spring.energy;
    spring.energy = energy;
    const auto add = spring.is_torsional ? add_moment : add_force;
    add(spring.end[0], force * spring.direction, nodes);
    add(spring.end[1], -force * spring.direction, nodes);
  }
  return sum;
}

void turn_bodies(const Springs& springs, RigidBodies& bodies) {
  for (const SpringInRun& spring : springs.spring) {
    if (!spring.is_torsional || spring.is_broken) continue;
    for (const double sign : {1.0, -1.0})
      if (const int body = spring.end[sign > 0 ? 0 : 1].body; body >= 0)
        bodies.body[index(body)].moment += sign * spring.force * spring.direction;
  }
}

// With Q the sum of stiffness over mass, or over inertia of torsional springs, of all springs at a node or
// body, the largest eigenvalue of the springs is at most the largest Q_1 + Q_2 of a spring. Proof: the energy
// k (x_1 - x_2)^2 of a spring is at most k (1 + Q_2 / Q_1) x_1^2 + k (1 + Q_1 / Q_2) x_2^2, by which every
// mass stands alone, with an eigenvalue of at most the mean of Q_1 + Q_2 of its springs.
double bound_step(Springs& springs, double of_elements, const RigidBodies& bodies, const Nodes& nodes) {
  for (AnchoredMass& mass : springs.mass)
    mass.stiffness = mass.damping = mass.torsional_stiffness = mass.torsional_damping = 0;
  for (const SpringInRun& spring : springs.spring)
    for (const SpringAnchor& anchor : spring.end) {
      if (spring.is_broken || anchor.node < 0) continue;
      AnchoredMass& mass = springs.mass[anchor.mass];
      (spring.is_torsional ? mass.torsional_stiffness : mass.stiffness) += largest_stiffness(spring);
      (spring.is_torsional ? mass.torsional_damping : mass.damping) += spring.damping;
    }
  double squared_frequency = 0, damping = 0, least = of_elements;
  springs.critical = -1;
  for (std::size_t i = 0; i < springs.spring.size(); ++i) {
    const SpringInRun& spring = springs.spring[i];
    if (spring.is_broken) continue;
    double own_frequency = 0, own_damping = 0;
    for (const SpringAnchor& anchor : spring.end) {
      if (anchor.node < 0) continue;
      const AnchoredMass& mass = springs.mass[anchor.mass];
      const double inverse = largest_inverse_mass(mass, bodies, nodes);
      const double inverse_inertia = largest_inverse_inertia(mass, bodies, nodes);
      own_frequency += mass.stiffness * inverse + mass.torsional_stiffness * inverse_inertia;
      own_damping += mass.damping * inverse + mass.torsional_damping * inverse_inertia;
    }
    squared_frequency = std::max(squared_frequency, own_frequency);
    damping = std::max(damping, own_damping);
    const double own = stable_step(own_frequency, own_damping);
    if (own >= least) continue;
    least = own;
    springs.critical = static_cast<int>(i);
  }
  return stable_step(squared_frequency + 4 / (of_elements * of_elements), damping);
}

Contribution pull_dashpots(Springs& springs, double mean_step, RigidBodies& bodies, Nodes& nodes) {
  Contribution sum;
  for (SpringInRun& spring : springs.spring) {
    if (spring.is_broken) continue;
    if (spring.damping > 0) {
      spring.dashpot = dashpot_force(spring, mean_step, bodies, nodes);
      sum.damping.before -= mean_step * spring.dashpot * rate_of(spring, bodies, nodes);
      const auto act = spring.is_torsional ? twist : pull;
      act(spring.end[0], spring.dashpot * spring.direction, bodies, nodes);
      act(spring.end[1], -spring.dashpot * spring.direction, bodies, nodes);
    }
    // A point that stays in place is a support.
    const Vector3d impulse = mean_step * (spring.force + spring.dashpot) * spring.direction;
    for (const double sign : {-1.0, 1.0}) {
      const SpringAnchor& anchor = spring.end[sign < 0 ? 0 : 1];
      if (anchor.node >= 0) continue;
      if (spring.is_torsional) {
        sum.supports.angular += sign * impulse;
      } else {
        sum.supports.add(anchor.point, sign * impulse);
      }
    }
  }
  return sum;
}

Contribution dashpots_done(const Springs& springs, double mean_step, const RigidBodies& bodies,
                           const Nodes& nodes) {
  Contribution sum;
  for (const SpringInRun& spring : springs.spring)
    if (spring.dashpot != 0) sum.damping.after -= mean_step * spring.dashpot * rate_of(spring, bodies, nodes);
  return sum;
}

void add_columns(const Springs& springs, std::vector<std::string>& columns) {
  for (const SpringSet& set : springs.set) {
    const std::string name = "spring." + set.name;
    columns.push_back(name + (set.is_torsional ? ".angle" : ".elongation"));
    columns.push_back(name + (set.is_torsional ? ".moment" : ".force"));
    if (set.joins_sets) columns.push_back(name + ".broken");
  }
}

void add_values(const Springs& springs, std::vector<double>& row) {
  for (const SpringSet& set : springs.set) {
    double elongation = 0, force = 0;
    std::size_t broken = 0;
    for (std::size_t i = set.first; i < set.first + set.count; ++i) {
      const SpringInRun& spring = springs.spring[i];
      if (spring.is_broken) ++broken;
      if (!spring.is_broken || !set.joins_sets) elongation += spring.elongation;
      force += spring.force + spring.dashpot;
    }
    const std::size_t whole = set.joins_sets ? set.count - broken : 1;
    row.push_back(whole > 0 ? elongation / static_cast<double>(whole) : 0);
    row.push_back(force);
    if (set.joins_sets) row.push_back(static_cast<double>(broken));
  }
}

}  // namespace brio
