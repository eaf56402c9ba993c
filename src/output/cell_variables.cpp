#include "src/output/cell_variables.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace brio {

namespace {

double pressure_of(const ElementSample& sample) { return -trace(sample.stress) / 3; }

double von_mises_of(const ElementSample& sample) {
  const SymmetricTensor<double> s = deviator(sample.stress);
  return std::sqrt(1.5 * contract(s, s));
}

void von_mises(const ElementSample& sample, double* out) { *out = von_mises_of(sample); }
void pressure(const ElementSample& sample, double* out) { *out = pressure_of(sample); }
// Mean over von Mises stress; 0 of an element without stress.
void triaxiality(const ElementSample& sample, double* out) {
  const double equivalent = von_mises_of(sample);
  *out = equivalent > 0 ? -pressure_of(sample) / equivalent : 0;
}
void internal_energy(const ElementSample& sample, double* out) { *out = sample.internal_energy; }
void thickness(const ElementSample& sample, double* out) { *out = sample.thickness; }
void radius(const ElementSample& sample, double* out) { *out = sample.radius; }
void density(const ElementSample& sample, double* out) { *out = sample.density; }

void write(const SymmetricTensor<double>& s, double* out) {
  std::ranges::copy(std::array{s.xx, s.yy, s.zz, s.xy, s.yz, s.xz}, out);
}
void stress(const ElementSample& sample, double* out) { write(sample.stress, out); }
void stress_top(const ElementSample& sample, double* out) { write(sample.top.stress, out); }
void stress_bottom(const ElementSample& sample, double* out) { write(sample.bottom.stress, out); }
void plastic_strain_top(const ElementSample& sample, double* out) { *out = sample.top.plastic_strain; }
void plastic_strain_bottom(const ElementSample& sample, double* out) { *out = sample.bottom.plastic_strain; }
// Rigid parts have a thickness, and no stress.
void membrane_force(const ElementSample& sample, double* out) {
  const bool carries = !std::isnan(sample.bending_moment.xx);
  write((carries ? sample.thickness : ElementSample::undefined) * sample.stress, out);
}
void bending_moment(const ElementSample& sample, double* out) { write(sample.bending_moment, out); }
void beam_force(const ElementSample& sample, double* out) { std::ranges::copy(sample.section_force, out); }
void beam_moment(const ElementSample& sample, double* out) { std::ranges::copy(sample.section_moment, out); }

constexpr auto shells = &ElementTraits::has_thickness;
constexpr auto beams = &ElementTraits::has_section;

constexpr CellVariable chosen[] = {{"von_mises", 1, von_mises},
                                   {"pressure", 1, pressure},
                                   {"triaxiality", 1, triaxiality},
                                   {"internal_energy", 1, internal_energy},
                                   {"stress_top", 6, stress_top, shells},
                                   {"stress_bottom", 6, stress_bottom, shells},
                                   {"equivalent_plastic_strain_top", 1, plastic_strain_top, shells},
                                   {"equivalent_plastic_strain_bottom", 1, plastic_strain_bottom, shells},
                                   {"membrane_force", 6, membrane_force, shells},
                                   {"bending_moment", 6, bending_moment, shells},
                                   {"beam_force", 3, beam_force, beams},
                                   {"beam_moment", 3, beam_moment, beams}};
constexpr CellVariable by_default[] = {
    {"stress", 6, stress}, {"thickness", 1, thickness}, {"radius", 1, radius}, {"density", 1, density}};

}  // namespace

std::span<const CellVariable> chosen_variables() { return chosen; }

const CellVariable& cell_variable(std::string_view name) {
  const auto* found = std::ranges::find(chosen, name, &CellVariable::name);
  return found != std::end(chosen) ? *found : *std::ranges::find(by_default, name, &CellVariable::name);
}

std::vector<std::string> named_variables(std::span<const std::string> wanted,
                                         std::span<const std::string_view> histories,
                                         const std::function<bool(const CellVariable&)>& is_had) {
  std::vector<std::string> names;
  const auto add = [&](std::string_view name) {
    if (std::ranges::find(names, name) == names.end()) names.emplace_back(name);
  };
  for (const std::string& name : wanted) {
    if (name != all_group) {
      add(name);
      continue;
    }
    add(default_group);
    for (const CellVariable& variable : chosen)
      if (is_had(variable)) add(variable.name);
    for (const std::string_view history : histories) add(history);
  }
  return names;
}

}  // namespace brio
