#include "src/step/check_energy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/breakdown.hpp"
#include "src/step/diagnosis.hpp"

namespace brio {

namespace {

// Kinetic energy of all nodes if they moved by the rounding error of the largest coordinate in a time step:
// the only energy of a scene at rest before its loads begin.
double energy_of_rounding(const Model& model) {
  double mass = 0, largest = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    mass += model.nodes.mass[i];
    for (int axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(model.nodes.record[i].position[axis]));
  }
  const double speed = std::numeric_limits<double>::epsilon() * largest / model.times.next;
  return 0.5 * mass * speed * speed;
}

// Hourglass energies below this fraction of the energy of the run are ignored.
constexpr double ignored_fraction = 1e-3;

}  // namespace

void check_energy_balance(Model& model, double energy_error_limit) {
  EnergyBalance& energy = model.energy;
  if (model.step == 0) energy.reference = energy_of_rounding(model);
  energy.end_step();
  const double error = energy.relative_error();
  if (!(std::abs(error) <= energy_error_limit))
    throw Breakdown((std::isfinite(error) ? "the energy error " + written(error) +
                                                " exceeds numerics.energy_error_limit at time "
                                          : "the energy is not a number at time ") +
                    written(model.times.time) + "; " + cause_of_energy_error(model));
  for (PartEnergy& part : model.part_energy)
    part.note_ratio(model.times.time, ignored_fraction * energy.reference, model.hourglass_warning);
}

}  // namespace brio
