#include "src/model/start_balances.hpp"

namespace brio {

void start_balances(Model& model) {
  if (!model.prescribed.empty() || !model.walls.empty() || !model.contacts.empty())
    model.nodes.keep_velocities_before();
  Momentum start = momentum(model.nodes);
  add_momentum(model.rigid, start);
  model.momentum.start = model.momentum.now = start.total;
  model.momentum.linear_scale = start.linear_size;
  model.momentum.angular_scale = start.angular_size;
  double energy = kinetic_energy(model.rigid).half;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const double* v = model.nodes.record[i].velocity;
    energy += 0.5 * model.nodes.mass[i] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!model.nodes.has_rotations()) continue;
    const double* w = model.nodes.angular_velocity[i].component;
    energy += 0.5 * model.nodes.rotational_inertia[i] * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  }
  model.energy.kinetic_start = model.energy.kinetic_half = model.energy.kinetic = energy;
}

}  // namespace brio
