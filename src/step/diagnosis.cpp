#include "src/step/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <variant>

#include "src/base/index.hpp"
#include "src/model/part_shape.hpp"

namespace brio {

namespace {

/// Of the largest energy: more is the likely cause of an error.
constexpr double large_share = 0.1;
/// Of the speed of sound.
constexpr double fast = 0.3, absurd = 3;

double speed_of_sound(const Block& block) {
  return std::visit([](const auto& law) { return std::sqrt(law.youngs_modulus / law.density); },
                    block.material);
}

/// Speed of a node against the mean of its part.
struct Fastest {
  const PartInModel* part = nullptr;
  int node = -1;
  double speed = 0;  ///< over the speed of sound
  bool finite = true;
};

Vector3d mean_velocity_of(const PartInModel& part, const Nodes& nodes) {
  Vector3d sum{};
  for (const int node : part.node)
    for (std::size_t i = 0; i < 3; ++i) sum[i] += nodes.record[index(node)].velocity[i];
  for (double& component : sum) component /= static_cast<double>(part.node.size());
  return sum;
}

Fastest fastest_node(const Model& model) {
  Fastest fastest;
  for (const PartInModel& part : model.parts) {
    if (part.rigid >= 0) continue;
    const double sound = speed_of_sound(model.blocks[part.block]);
    const Vector3d mean = mean_velocity_of(part, model.nodes);
    for (const int node : part.node) {
      const NodeRecord& record = model.nodes.record[index(node)];
      Vector3d velocity{};
      bool finite = true;
      for (std::size_t i = 0; i < 3; ++i) {
        finite = finite && std::isfinite(record.velocity[i]) && std::isfinite(record.position[i]);
        velocity[i] = record.velocity[i] - mean[i];
      }
      if (!finite) return {&part, node, 0, false};
      const double speed = std::hypot(velocity[0], velocity[1], velocity[2]) / sound;
      if (fastest.part == nullptr || speed > fastest.speed) fastest = {&part, node, speed, true};
    }
  }
  return fastest;
}

std::string element_at(const Model& model, const PartInModel& part, int node) {
  for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
    const std::vector<int> nodes = nodes_of_element(model, part, e);
    if (std::find(nodes.begin(), nodes.end(), node) != nodes.end())
      return "element " + std::to_string(part.number_of_element(e)) + " of part '" + part.name + "'";
  }
  return "a node of part '" + part.name + "' whose elements are deleted";
}

std::string smaller_step(const Model& model) {
  const TimeSection& time = model.control.settings;
  if (time.step) return "time.step: " + written(0.5 * *time.step);
  return "time.step_scale: " + written(0.5 * time.step_scale);
}

constexpr const char* not_a_number =
    "a value is too large or not a number; check units, densities and velocities of the deck";

/// Whether all parts together start with a speed that no part can have.
bool starts_too_fast(const Model& model, double sound) {
  double mass = 0;
  for (const PartInModel& part : model.parts) mass += part.mass;
  return !(std::sqrt(2 * model.energy.kinetic_start / mass) <= absurd * sound);
}

std::string likely_cause(const Model& model, const Fastest& fastest) {
  const double speed = fastest.speed;
  const EnergyBalance& energy = model.energy;
  const double missing = std::abs(energy.relative_error()) * energy.reference;
  if (!std::isfinite(missing)) return not_a_number;
  if (starts_too_fast(model, speed_of_sound(model.blocks[fastest.part->block])))
    return "parts start faster than sound; check units and velocities of the deck, else try " +
           smaller_step(model);
  if (energy.contact.at_step() > 0.5 * missing)
    return "contact has added " + written(energy.contact.at_step()) + "; try contact.passes: 100, or " +
           smaller_step(model);
  if (std::abs(energy.hourglass) > large_share * energy.reference)
    return "hourglass energy is " + written(energy.hourglass) + "; try hex8_full, more elements, or " +
           smaller_step(model);
  if (speed > fast)
    return "elements are crushed within few time steps; try " + smaller_step(model) +
           ", deletion: {inverted: true}, or smaller elements";
  for (const Block& block : model.blocks)
    if (block.precision == Precision::single_precision)
      return "the time step is too large, or rounding in single precision; try numerics.precision: double, "
             "then " +
             smaller_step(model);
  return "the time step is too large for the motion there; try " + smaller_step(model);
}

}  // namespace

std::string written(double number) {
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, 6);
  return {digits.data(), end.ptr};
}

std::string element_name(const Model& model, std::size_t block, std::size_t element) {
  const PartInModel& part = model.parts[block];
  return "element " + std::to_string(part.number_of_element(element)) + " of part '" + part.name + "'";
}

std::string critical_name(const Model& model) {
  const Springs& springs = model.springs;
  if (springs.critical >= 0) return "spring '" + springs.spring[index(springs.critical)].name + "'";
  return element_name(model, model.control.critical_block, model.control.critical_element);
}

std::string cause_of_energy_error(const Model& model) {
  const Fastest fastest = fastest_node(model);
  if (fastest.part == nullptr)
    return "all parts are rigid: likely the time step does not resolve their impact; try " +
           smaller_step(model);
  const std::string place = element_at(model, *fastest.part, fastest.node);
  if (!fastest.finite) return "in " + place + " " + not_a_number;
  return "the largest velocity is at " + place + ", at " + written(fastest.speed) +
         " of the speed of sound; likely cause: " + likely_cause(model, fastest);
}

std::string cause_of_collapse(const Model& model) {
  const Fastest fastest = fastest_node(model);
  if (!fastest.finite)
    return "likely cause: in " + element_at(model, *fastest.part, fastest.node) + " " + not_a_number;
  if (fastest.part != nullptr && starts_too_fast(model, speed_of_sound(model.blocks[fastest.part->block])))
    return "likely cause: parts start faster than sound; check units and velocities of the deck";
  return "likely cause: the element is crushed or torn; try deletion: {inverted: true} or a failure of its "
         "material, " +
         smaller_step(model) + ", or contact that keeps other bodies out of it";
}

}  // namespace brio
