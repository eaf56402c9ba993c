#include "src/fields/cell_variables.hpp"

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
// Rigid parts have no energy, and no volume is told.
void internal_energy_density(const ElementSample& sample, double* out) {
  *out = sample.internal_energy == 0 ? 0 : sample.internal_energy / sample.volume;
}
void hourglass_energy_density(const ElementSample& sample, double* out) {
  *out = sample.hourglass_energy / sample.volume;
}
void thickness(const ElementSample& sample, double* out) { *out = sample.thickness; }
void radius(const ElementSample& sample, double* out) { *out = sample.radius; }
void density(const ElementSample& sample, double* out) { *out = sample.density; }

void stress(const ElementSample& sample, double* out) { write_components(sample.stress, out); }
void stress_top(const ElementSample& sample, double* out) { write_components(sample.top.stress, out); }
void stress_middle(const ElementSample& sample, double* out) { write_components(sample.middle.stress, out); }
void stress_bottom(const ElementSample& sample, double* out) { write_components(sample.bottom.stress, out); }
void plastic_strain_top(const ElementSample& sample, double* out) { *out = sample.top.plastic_strain; }
void plastic_strain_middle(const ElementSample& sample, double* out) { *out = sample.middle.plastic_strain; }
void plastic_strain_bottom(const ElementSample& sample, double* out) { *out = sample.bottom.plastic_strain; }
// Rigid parts have a thickness, and no stress.
void membrane_force(const ElementSample& sample, double* out) {
  const bool carries = !std::isnan(sample.bending_moment.xx);
  write_components((carries ? sample.thickness : ElementSample::undefined) * sample.stress, out);
}
void bending_moment(const ElementSample& sample, double* out) {
  write_components(sample.bending_moment, out);
}
void beam_force(const ElementSample& sample, double* out) { std::ranges::copy(sample.section_force, out); }
void beam_moment(const ElementSample& sample, double* out) { std::ranges::copy(sample.section_moment, out); }
void beam_twist(const ElementSample& sample, double* out) { *out = sample.twist; }

constexpr auto shells = &ElementTraits::has_thickness;
constexpr auto beams = &ElementTraits::has_section;
constexpr auto with_hourglass_control = &ElementTraits::has_hourglass_control;

constexpr CellVariable by_choice[] = {
    {"von_mises", 1, von_mises, nullptr, "stress", "of `stress`"},
    {"pressure", 1, pressure, nullptr, "stress", "of `stress`, positive in compression"},
    {"triaxiality", 1, triaxiality, nullptr, "-",
     "of `stress`: mean over von Mises stress; 0 without stress"},
    {"internal_energy", 1, internal_energy, nullptr, "energy", "elastic and plastic work on the element"},
    {"internal_energy_density", 1, internal_energy_density, nullptr, "energy/volume",
     "`internal_energy` over the present volume of the element"},
    {"hourglass_energy_density", 1, hourglass_energy_density, with_hourglass_control, "energy/volume",
     "energy stored by the control of hourglass modes (of shells that of drilling as well), over the present "
     "volume"},
    {"strain", 6, nullptr, nullptr, "-",
     "logarithmic (Hencky) strain ln V since the start, in the middle of a hexahedron, or of the middle "
     "surface of a shell, with its thickness; NaN in beams, particles and rigid parts"},
    {"strain_rate", 6, nullptr, nullptr, "1/time",
     "rate of deformation D of the last half step, at the place of `strain`; of a shell that in its middle "
     "surface, without the rate of its thickness; NaN in beams, particles and rigid parts"},
    {"stress_top", 6, stress_top, shells, "stress",
     "at the outermost integration point on the side to which the normal, by the right-hand rule about the "
     "nodes, points. Gauss points are not on the surface (at 0.906 of the half thickness of 5); those of "
     "`quadrature: lobatto` are"},
    {"stress_middle", 6, stress_middle, shells, "stress",
     "at the integration point in the middle of the thickness, which odd numbers of points have; NaN with "
     "even"},
    {"stress_bottom", 6, stress_bottom, shells, "stress", "as `stress_top` on the other side"},
    {"equivalent_plastic_strain_top", 1, plastic_strain_top, shells, "-", "at the point of `stress_top`"},
    {"equivalent_plastic_strain_middle", 1, plastic_strain_middle, shells, "-",
     "at the point of `stress_middle`"},
    {"equivalent_plastic_strain_bottom", 1, plastic_strain_bottom, shells, "-",
     "at the point of `stress_bottom`"},
    {"membrane_force", 6, membrane_force, shells, "force/length",
     "integral of the stress over the thickness"},
    {"bending_moment", 6, bending_moment, shells, "force",
     "moment per length: integral of the place from the middle towards the top times the stress"},
    {"beam_force", 3, beam_force, beams, "force", "axial force, shear forces along y and z of the section"},
    {"beam_moment", 3, beam_moment, beams, "moment",
     "in the middle of the element, on axes of the section: torque, bending moments about y and z"},
    {"beam_twist", 1, beam_twist, beams, "radian/length",
     "rotation of the second end less that of the first about the axis, over the initial length; NaN in "
     "trusses "
     "and cables"}};
constexpr CellVariable by_default[] = {{"stress", 6, stress, nullptr, "", ""},
                                       {"thickness", 1, thickness, shells, "", ""},
                                       {"radius", 1, radius, &ElementTraits::has_radius, "", ""},
                                       {"density", 1, density, &ElementTraits::has_density, "", ""}};
constexpr DefaultField told_by_default[] = {
    {"stress", 6, "elements", "stress", "Cauchy stress, mean over the integration points"},
    {"equivalent_plastic_strain", 1, "elements", "-",
     "largest of the integration points; 0 in materials without plasticity"},
    {"damage", 1, "elements, where a material fails", "-",
     "largest of the integration points; 0 in materials that do not fail"},
    {"thickness", 1, "elements, with shells", "length", "present thickness; NaN in other elements"},
    {"radius", 1, "elements, with beams or particles", "length", "NaN in other elements"},
    {"density", 1, "elements, with particles", "density", "NaN in other elements"},
    {"part", 1, "elements, always", "-", "index of the part in the deck from 0"},
    {"element_id", 1, "elements, always", "-",
     "number of the element in its mesh file; elements of generated meshes have those after the largest of "
     "files, "
     "or from 0, in the order of the deck: unique over the scene unless two files have the same"}};
constexpr DefaultField of_state[] = {
    {"state", 0, "elements but particles, by its name alone", "",
     "all that elements remember, in double precision, as many numbers as the largest has, from which other "
     "decks can begin ([initial_state.md](initial_state.md)); `velocity` is then in double precision"},
    {"angular_velocity", 3, "points of shells and beams, with `state`", "radian/time",
     "of the last half step"}};

}  // namespace

void write_components(const SymmetricTensor<double>& s, double* out) {
  std::ranges::copy(std::array{s.xx, s.yy, s.zz, s.xy, s.yz, s.xz}, out);
}

std::span<const CellVariable> chosen_variables() { return by_choice; }
std::span<const DefaultField> default_fields() { return told_by_default; }
std::span<const DefaultField> state_fields() { return of_state; }

const CellVariable& cell_variable(std::string_view name) {
  const auto* found = std::ranges::find(by_choice, name, &CellVariable::name);
  return found != std::end(by_choice) ? *found : *std::ranges::find(by_default, name, &CellVariable::name);
}

std::vector<std::string> named_variables(std::span<const std::string> wanted,
                                         std::span<const std::string_view> others,
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
    for (const CellVariable& variable : by_choice)
      if (is_had(variable)) add(variable.name);
    for (const std::string_view other : others) add(other);
  }
  return names;
}

}  // namespace brio
