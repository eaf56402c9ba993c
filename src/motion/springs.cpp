#include "src/motion/springs.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

using Eigen::Vector3d;

namespace {

Vector3d place_of(const SpringAnchor& anchor, const Nodes& nodes) {
  return anchor.node < 0 ? anchor.point
                         : Vector3d(nodes.record[static_cast<std::size_t>(anchor.node)].position);
}

Vector3d velocity_of(const SpringAnchor& anchor, const Nodes& nodes) {
  return anchor.node < 0 ? Vector3d(Vector3d::Zero())
                         : Vector3d(nodes.record[static_cast<std::size_t>(anchor.node)].velocity);
}

double rate_of(const SpringInRun& spring, const Nodes& nodes) {
  return spring.direction.dot(velocity_of(spring.end[1], nodes) - velocity_of(spring.end[0], nodes));
}

void measure(SpringInRun& spring, const Nodes& nodes) {
  const Vector3d between = place_of(spring.end[1], nodes) - place_of(spring.end[0], nodes);
  const double distance = between.norm();
  spring.direction = distance > 0 ? Vector3d(between / distance) : Vector3d(Vector3d::Zero());
  spring.elongation = distance - spring.length;
}

bool is_removed(const SpringAnchor& anchor, const Nodes& nodes) {
  return anchor.node >= 0 && anchor.body < 0 &&
         nodes.record[static_cast<std::size_t>(anchor.node)].inverse_mass == 0;
}

void add_force(const SpringAnchor& anchor, const Vector3d& force, Nodes& nodes) {
  if (anchor.node < 0) return;
  double* sum = nodes.force[static_cast<std::size_t>(anchor.node)].component;
  for (int axis = 0; axis < 3; ++axis) sum[axis] += force[axis];
}

Vector3d arm_of(const SpringAnchor& anchor, const RigidBodies& bodies, const Nodes& nodes) {
  return place_of(anchor, nodes) - bodies.body[static_cast<std::size_t>(anchor.body)].centre;
}

/// Acceleration along a direction by the forces known so far, and by a unit force along it.
struct Response {
  double acceleration = 0;
  double inverse_mass = 0;
};

Response response_of(const SpringAnchor& anchor, const Vector3d& direction, const RigidBodies& bodies,
                     const Nodes& nodes) {
  if (anchor.node < 0) return {};
  if (anchor.body >= 0) {
    const RigidBody& body = bodies.body[static_cast<std::size_t>(anchor.body)];
    const RigidMotion& motion = bodies.motion[static_cast<std::size_t>(anchor.body)];
    const Vector3d arm = arm_of(anchor, bodies, nodes);
    const Vector3d turning = motion.inverse_inertia * body.moment;
    return {direction.dot(motion.free_inverse_mass() * body.force + turning.cross(arm)),
            motion.inverse_mass_along(direction, arm)};
  }
  const auto node = static_cast<std::size_t>(anchor.node);
  const Vector along = nodes.free_inverse_mass(node) * to_vector(direction);
  const double* force = nodes.force[node].component;
  return {dot(along, {force[0], force[1], force[2]}), dot(along, to_vector(direction))};
}

void pull(const SpringAnchor& anchor, const Vector3d& force, RigidBodies& bodies, Nodes& nodes) {
  if (anchor.body < 0) {
    add_force(anchor, force, nodes);
    return;
  }
  RigidBody& body = bodies.body[static_cast<std::size_t>(anchor.body)];
  body.force += force;
  body.moment += arm_of(anchor, bodies, nodes).cross(force);
}

// The rate of elongation at the time of the step is r + h/2 (a - d w): r that of the half step before, a by
// the other forces, d = c rate the force of the dashpot, w the inverse mass along the line.
double dashpot_force(const SpringInRun& spring, double mean_step, const RigidBodies& bodies,
                     const Nodes& nodes) {
  const Response from = response_of(spring.end[0], spring.direction, bodies, nodes);
  const Response to = response_of(spring.end[1], spring.direction, bodies, nodes);
  const double rate = rate_of(spring, nodes) + 0.5 * mean_step * (to.acceleration - from.acceleration);
  const double inverse_mass = from.inverse_mass + to.inverse_mass;
  return spring.damping * rate / (1 + 0.5 * mean_step * spring.damping * inverse_mass);
}

double largest_inverse_mass(const AnchoredMass& mass, const RigidBodies& bodies, const Nodes& nodes) {
  if (const auto node = static_cast<std::size_t>(mass.node); mass.body < 0)
    return nodes.prescribed_translations(node) == 7 ? 0 : nodes.record[node].inverse_mass;
  const RigidMotion& motion = bodies.motion[static_cast<std::size_t>(mass.body)];
  return motion.inverse_mass.maxCoeff() + mass.arm * mass.arm * motion.inverse_inertia.trace();
}

/// Of what resists the elongation and, in tension, a motion across it.
double largest_stiffness(const SpringInRun& spring) {
  const double distance = spring.elongation + spring.length;
  return distance > 0 && spring.force > 0 ? std::max(spring.stiffness, spring.force / distance)
                                          : spring.stiffness;
}

/// Largest time step with dt^2 w2 + 2 dt d <= 4.
double stable_step(double squared_frequency, double damping) {
  const double sum = damping + std::sqrt(damping * damping + 4 * squared_frequency);
  return sum > 0 ? 4 / sum : std::numeric_limits<double>::infinity();
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
    measure(spring, nodes);
    spring.force = force_at(spring, spring.elongation);
    spring.energy = energy_at(spring, spring.elongation);
    sum += spring.energy;
  }
  return sum;
}

Contribution stretch(Springs& springs, Nodes& nodes) {
  Contribution sum;
  for (SpringInRun& spring : springs.spring) {
    if (spring.is_broken) continue;
    const double before = spring.elongation;
    measure(spring, nodes);
    const double force = force_at(spring, spring.elongation);
    if (force > spring.strength || is_removed(spring.end[0], nodes) || is_removed(spring.end[1], nodes)) {
      sum += break_off(spring, spring.elongation - before);
      continue;
    }
    spring.force = force;
    const double energy = energy_at(spring, spring.elongation);
    sum.internal += energy - spring.energy;
    spring.energy = energy;
    add_force(spring.end[0], force * spring.direction, nodes);
    add_force(spring.end[1], -force * spring.direction, nodes);
  }
  return sum;
}

// With S the sum of the stiffnesses at a mass m, the largest eigenvalue of the springs is at most the largest
// S_1 / m_1 + S_2 / m_2 of a spring: Gershgorin's theorem for the elongations, whose matrix has k_j / m
// where two springs share a mass.
double bound_step(Springs& springs, double of_elements, const RigidBodies& bodies, const Nodes& nodes) {
  for (AnchoredMass& mass : springs.mass) mass.stiffness = mass.damping = 0;
  for (const SpringInRun& spring : springs.spring)
    for (const SpringAnchor& anchor : spring.end) {
      if (spring.is_broken || anchor.node < 0) continue;
      AnchoredMass& mass = springs.mass[anchor.mass];
      mass.stiffness += largest_stiffness(spring);
      mass.damping += spring.damping;
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
      own_frequency += mass.stiffness * inverse;
      own_damping += mass.damping * inverse;
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
      sum.damping.before -= mean_step * spring.dashpot * rate_of(spring, nodes);
      pull(spring.end[0], spring.dashpot * spring.direction, bodies, nodes);
      pull(spring.end[1], -spring.dashpot * spring.direction, bodies, nodes);
    }
    // A point that stays in place is a support.
    const Vector3d impulse = mean_step * (spring.force + spring.dashpot) * spring.direction;
    for (const double sign : {-1.0, 1.0}) {
      const SpringAnchor& anchor = spring.end[sign < 0 ? 0 : 1];
      if (anchor.node < 0) sum.supports.add(to_vector(anchor.point), to_vector(sign * impulse));
    }
  }
  return sum;
}

Contribution dashpots_done(const Springs& springs, double mean_step, const Nodes& nodes) {
  Contribution sum;
  for (const SpringInRun& spring : springs.spring)
    if (spring.dashpot != 0) sum.damping.after -= mean_step * spring.dashpot * rate_of(spring, nodes);
  return sum;
}

void add_columns(const Springs& springs, std::vector<std::string>& columns) {
  for (const SpringInRun& spring : springs.spring)
    for (const char* quantity : {".elongation", ".force"})
      columns.push_back("spring." + spring.name + quantity);
}

void add_values(const Springs& springs, std::vector<double>& row) {
  for (const SpringInRun& spring : springs.spring) {
    row.push_back(spring.elongation);
    row.push_back(spring.force + spring.dashpot);
  }
}

}  // namespace brio
