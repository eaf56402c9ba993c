#pragma once
/// Belytschko-Tsay shell: settings of the deck. Equations: shell4_kernel.hpp.

#include <string_view>

#include "elements/base/element_kind.hpp"
#include "elements/shell/through_thickness.hpp"

namespace brio {

struct Block;

struct Shell4 {
  static constexpr std::string_view name = "shell4";
  static constexpr int nodes = 4;
  static constexpr bool rotations = true;
  static constexpr ElementTraits traits{.cell = quadrilateral_cell,
                                        .summary_key = "shell4",
                                        .has_thickness = true,
                                        .has_hourglass_control = true};
  template <class Law>
  static constexpr bool accepts = Law::traits.update_plane_stress;

  double thickness = 0;
  int thickness_points = 5;
  ThicknessQuadrature quadrature = ThicknessQuadrature::gauss;
  bool thickness_update = true;
  bool warping_projection = false;
  double shear_factor = 5.0 / 6.0;
  double hourglass_stiffness = 0.05;
  double hourglass_viscosity = 0;
  double drilling_stiffness = 0.001;
  double drilling_viscosity = 1;
  double linear_bulk_viscosity = 0.06;

  constexpr std::string_view fault() const {
    if (quadrature == ThicknessQuadrature::lobatto && thickness_points == 2)  // the surfaces
      return "two Lobatto points make bending three times as stiff; accepted are 3 to 9 thickness_points "
             "with "
             "quadrature: lobatto, or quadrature: gauss";
    return "";
  }

  double contact_thickness() const { return thickness; }
  const ThicknessRule& rule() const { return thickness_rule(quadrature, thickness_points); }

  static constexpr auto fields() {
    return field_table(
        required("thickness", &Shell4::thickness, positive, "initial thickness, length"),
        optional("thickness_points", &Shell4::thickness_points,
                 Range{.lower = 1, .upper = most_thickness_points},
                 "integration points through the thickness, 1 to 9"),
        optional("quadrature", &Shell4::quadrature, any_number, "integration rule through the thickness"),
        optional("thickness_update", &Shell4::thickness_update, any_number,
                 "thickness update: whether the thickness follows the thickness strain"),
        optional("warping_projection", &Shell4::warping_projection, any_number,
                 "couple curvature with membrane strain in warped elements"),
        optional("shear_factor", &Shell4::shear_factor, Range{.lower = 0, .upper = 1, .lower_open = true},
                 "factor of the transverse shear modulus, -"),
        optional("hourglass_stiffness", &Shell4::hourglass_stiffness, fraction,
                 "elastic hourglass control of membrane, bending and shear, -"),
        optional("hourglass_viscosity", &Shell4::hourglass_viscosity, fraction,
                 "viscous hourglass control, fraction of critical damping, -"),
        optional(
            "drilling_stiffness", &Shell4::drilling_stiffness, fraction,
            "drilling stiffness, fraction of the square of the highest frequency, -; yields at 0.01 rad"),
        optional("drilling_viscosity", &Shell4::drilling_viscosity, fraction,
                 "drilling damping, fraction of critical damping of the drilling stiffness, with which it "
                 "yields, -"),
        optional("linear_bulk_viscosity", &Shell4::linear_bulk_viscosity, fraction,
                 "linear membrane viscosity b1, fraction of critical damping of the highest mode, -"));
  }
};

/// Sets block.kernel.
void choose_kernel(const Shell4& element, Block& block);

}  // namespace brio
