#pragma once
/// Settings of the eight-node hexahedron with 2x2x2 integration points. Equations: hex8_full_step.hpp.

#include <string_view>

#include "elements/base/element_kind.hpp"
#include "elements/solid/objective_rate.hpp"
#include "elements/solid/solid.hpp"
#include "src/base/fields.hpp"

namespace brio {

struct Block;

struct Hex8Full {
  static constexpr std::string_view name = "hex8_full";
  static constexpr int nodes = 8;
  static constexpr bool rotations = false;
  static constexpr ElementTraits traits{.cell = hexahedron_cell, .summary_key = "hex8"};
  template <class Law>
  static constexpr bool accepts = is_solid_law<Law>;

  ObjectiveRate objective_rate = ObjectiveRate::green_naghdi;
  double linear_bulk_viscosity = 0.06;
  double quadratic_bulk_viscosity = 1.2;

  double contact_thickness() const { return 0; }

  static constexpr auto fields() {
    return field_table(
        optional("objective_rate", &Hex8Full::objective_rate, any_number, "objective stress rate"),
        optional("linear_bulk_viscosity", &Hex8Full::linear_bulk_viscosity, non_negative,
                 "linear bulk viscosity b1, fraction of critical damping of dilatation, -"),
        optional("quadratic_bulk_viscosity", &Hex8Full::quadratic_bulk_viscosity, non_negative,
                 "quadratic bulk viscosity b2, for shocks, in compression only, -"));
  }
};

/// Sets block.kernel.
void choose_kernel(const Hex8Full& element, Block& block);

}  // namespace brio
