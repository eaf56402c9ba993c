#include "src/motion/damping.hpp"

namespace brio {

namespace {

/// What damping adds to a force f: with b = alpha h / 2 the velocity after the step is
/// (v (1 - b) + h f / m) / (1 + b), as a force of (f - alpha m v) / (1 + b) gives it.
void damp_rows(double rate, double mean_step, double inverse_inertia, const double* velocity, double* force,
               Vector3d& added) {
  added = {};
  if (rate == 0 || inverse_inertia == 0) return;
  const double share = 1 / (1 + 0.5 * rate * mean_step);
  for (std::size_t i = 0; i < 3; ++i) {
    const double damped = (force[i] - rate / inverse_inertia * velocity[i]) * share;
    added[i] = damped - force[i];
    force[i] = damped;
  }
}

}  // namespace

NodalDamping make_damping(std::vector<double> rate, const Nodes& nodes) {
  NodalDamping damping{.rate = std::move(rate), .force = std::vector<Vector3d>(nodes.size())};
  if (nodes.has_rotations()) damping.moment.resize(nodes.size());
  return damping;
}

void damp(NodalDamping& damping, double mean_step, Nodes& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const NodeRecord& record = nodes.record[i];
    damp_rows(damping.rate[i], mean_step, record.inverse_mass, record.velocity, nodes.force[i].component,
              damping.force[i]);
    if (!nodes.has_rotations()) continue;
    const double* turning = nodes.angular_velocity[i].component;
    damp_rows(damping.rate[i], mean_step, turning[3], turning, nodes.moment[i].component, damping.moment[i]);
  }
}

double power(const NodalDamping& damping, const Nodes& nodes) {
  double sum = 0;
  for (std::size_t i = 0; i < damping.force.size(); ++i) sum += dot(damping.force[i], velocity(nodes, i));
  for (std::size_t i = 0; i < damping.moment.size(); ++i)
    sum += dot(damping.moment[i], vector_at(nodes.angular_velocity[i].component));
  return sum;
}

Impulse resultant(const NodalDamping& damping, const Nodes& nodes) {
  Impulse sum;
  for (std::size_t i = 0; i < damping.force.size(); ++i) sum.add(position(nodes, i), damping.force[i]);
  for (const Vector3d& moment : damping.moment) sum.angular += moment;
  return sum;
}

}  // namespace brio
