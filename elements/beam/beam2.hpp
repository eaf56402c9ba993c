#pragma once
/// Settings of the two-node beam. Equations: beam2_kernel.hpp.

#include <array>
#include <memory>
#include <optional>
#include <string_view>

#include "elements/base/element_kind.hpp"
#include "elements/beam/beam_section.hpp"
#include "src/base/fields.hpp"
#include "src/base/tensor.hpp"

namespace brio {

enum class BeamFormulation {
  beam,
  truss,  ///< carries axial force alone
  cable   ///< carries tension alone
};
constexpr std::array<NamedValue<BeamFormulation>, 3> named_values(BeamFormulation) {
  return {{{"beam", BeamFormulation::beam},
           {"truss", BeamFormulation::truss},
           {"cable", BeamFormulation::cable}}};
}

struct Block;

struct Beam2 {
  static constexpr std::string_view name = "beam2";
  static constexpr int nodes = 2;
  static constexpr bool rotations = true;
  /// In double: strains come from differences of positions and triads since the start: rounded to float,
  /// these would do work in every step and heat the beam.
  static constexpr ElementTraits traits{.cell = line_cell,
                                        .summary_key = "beam2",
                                        .precision = ElementPrecision::always_double,
                                        .has_radius = true,
                                        .has_section = true};
  template <class Law>
  static constexpr bool accepts = Law::traits.update_fibre;

  BeamSection section;
  BeamFormulation formulation = BeamFormulation::beam;
  std::optional<Vector3d> orientation;
  std::optional<double> shear_factor;
  std::optional<double> contact_radius;
  double linear_bulk_viscosity = 0.06;
  std::shared_ptr<const FibreSection> fibres;  ///< of the section, once `prepared`; no entry of a deck

  static constexpr auto fields() {
    return field_table(
        required("section", &Beam2::section, any_number, "shape of the cross section"),
        optional("formulation", &Beam2::formulation, any_number,
                 "beam; truss: axial force alone; cable: tension alone"),
        optional("orientation", &Beam2::orientation, any_number,
                 "direction of the section's height, across the beam; required where a beam is not round"),
        optional("shear_factor", &Beam2::shear_factor, Range{.lower = 0, .upper = 1, .lower_open = true},
                 "shear area over area, along both axes; default: that of the section, -"),
        optional("contact_radius", &Beam2::contact_radius, positive,
                 "contact radius; default: the outer radius, for a section that is not round that of a "
                 "circle of the same area"),
        optional("linear_bulk_viscosity", &Beam2::linear_bulk_viscosity, fraction,
                 "linear axial viscosity b1, fraction of critical damping of the highest mode, -"));
  }
  constexpr std::string_view fault() const {
    if (orientation && (*orientation)[0] == 0 && (*orientation)[1] == 0 && (*orientation)[2] == 0)
      return "the orientation has no direction; at least one component must differ from 0";
    if (bends() && !is_round(section) && !orientation)
      return "a section that is not round needs an 'orientation': the direction of its height";
    return "";
  }

  constexpr bool bends() const { return formulation == BeamFormulation::beam; }

  double contact_thickness() const { return 2 * contact_radius.value_or(fibres_of(section).radius); }

  /// With the fibres of its section.
  Beam2 prepared() const {
    Beam2 ready = *this;
    ready.fibres = std::make_shared<const FibreSection>(fibres_of(section, shear_factor.value_or(0)));
    return ready;
  }
};

/// Sets block.kernel.
void choose_kernel(const Beam2& element, Block& block);

}  // namespace brio
