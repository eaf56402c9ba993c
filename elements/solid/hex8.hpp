#pragma once
/// Settings of the eight-node hexahedron with one integration point. Equations: hex8_kernel.hpp.

#include <string_view>

#include "elements/base/element_kind.hpp"
#include "elements/solid/objective_rate.hpp"
#include "elements/solid/solid.hpp"
#include "src/base/fields.hpp"

namespace brio {

/// Above this, hourglass modes would set the stable time step.
inline constexpr Range hourglass_stiffness_range{.lower = 0, .upper = 0.15};

struct Block;

struct Hex8 {
  static constexpr std::string_view name = "hex8";
  static constexpr int nodes = 8;
  static constexpr bool rotations = false;
  static constexpr ElementTraits traits{
      .cell = hexahedron_cell, .summary_key = "hex8", .has_hourglass_control = true};
  template <class Law>
  static constexpr bool accepts = is_solid_law<Law>;

  ObjectiveRate objective_rate = ObjectiveRate::green_naghdi;
  double hourglass_stiffness = 0.05;
  double hourglass_viscosity = 0;
  double linear_bulk_viscosity = 0.06;
  double quadratic_bulk_viscosity = 1.2;

  double contact_thickness() const { return 0; }

  static constexpr auto fields() {
    return field_table(optional("objective_rate", &Hex8::objective_rate, any_number, "objective stress rate"),
                       optional("hourglass_stiffness", &Hex8::hourglass_stiffness, hourglass_stiffness_range,
                                "stiffness hourglass control, fraction of the bending modulus, -; at 1/9 an "
                                "elastic box bends exactly; while a brick yields, at most 0.01"),
                       optional("hourglass_viscosity", &Hex8::hourglass_viscosity, fraction,
                                "viscous hourglass control, fraction of critical damping, -"),
                       optional("linear_bulk_viscosity", &Hex8::linear_bulk_viscosity, non_negative,
                                "linear bulk viscosity b1, fraction of critical damping of dilatation, -"),
                       optional("quadratic_bulk_viscosity", &Hex8::quadratic_bulk_viscosity, non_negative,
                                "quadratic bulk viscosity b2, for shocks, in compression only, -"));
  }
};

/// Sets block.kernel.
void choose_kernel(const Hex8& element, Block& block);

}  // namespace brio
