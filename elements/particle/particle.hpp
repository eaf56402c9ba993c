#pragma once
/// Settings of smoothed particle hydrodynamics. Equations: particle_kernel.hpp, particle_cloud.hpp.

#include <array>
#include <optional>
#include <string_view>

#include "elements/base/element_kind.hpp"
#include "elements/solid/solid.hpp"
#include "src/base/fields.hpp"

namespace brio {

/// Configuration of the kernel and of the neighbours.
enum class ParticleFrame {
  total_lagrangian,  ///< total-Lagrangian kernel: the initial configuration
  eulerian           ///< updated-Lagrangian kernel: the present configuration
};
constexpr std::array<NamedValue<ParticleFrame>, 2> named_values(ParticleFrame) {
  return {{{"total_lagrangian", ParticleFrame::total_lagrangian}, {"eulerian", ParticleFrame::eulerian}}};
}

struct Block;

struct Particle {
  static constexpr std::string_view name = "particle";
  static constexpr int nodes = 1;
  static constexpr bool rotations = false;
  /// Their mass is their density, which is not to be scaled.
  static constexpr ElementTraits traits{.cell = vertex_cell,
                                        .summary_key = "particle",
                                        .precision = ElementPrecision::double_only,
                                        .gains_mass = false,
                                        .shares_nodes = false,
                                        .has_radius = true,
                                        .has_density = true,
                                        .has_hourglass_control = true};
  template <class Law>
  static constexpr bool accepts = is_solid_law<Law>;

  ParticleFrame kernel = ParticleFrame::total_lagrangian;
  std::optional<double> smoothing_length{};
  std::optional<std::array<double, 2>> smoothing_bounds{};
  std::optional<double> hourglass_stiffness{};
  std::optional<double> hourglass_viscosity{};
  std::optional<double> artificial_stress{};
  double linear_bulk_viscosity = 0.06;
  double quadratic_bulk_viscosity = 1.2;

  static constexpr auto fields() {
    return field_table(
        optional("kernel", &Particle::kernel, any_number,
                 "total_lagrangian: neighbours and weights of the initial configuration, for solids; "
                 "eulerian: of the "
                 "present configuration (updated Lagrangian), for fluids and fragmentation"),
        optional(
            "smoothing_length", &Particle::smoothing_length, Range{.lower = 1, .upper = 2},
            "smoothing length over the spacing of the particles, half the radius of the kernel; default: "
            "1.1, or 1.5 where the kernel is eulerian"),
        optional("smoothing_bounds", &Particle::smoothing_bounds, positive,
                 "eulerian: least and largest smoothing length over the initial one; default: [0.5, 2]"),
        optional("hourglass_stiffness", &Particle::hourglass_stiffness, fraction,
                 "total_lagrangian: stiffness control of zero-energy modes, fraction of Young's modulus; "
                 "default: 0.1"),
        optional("hourglass_viscosity", &Particle::hourglass_viscosity, fraction,
                 "eulerian: viscous control of zero-energy modes, fraction of density times speed of sound "
                 "times spacing; default: 0.3"),
        optional("artificial_stress", &Particle::artificial_stress, fraction,
                 "eulerian: artificial stress of close particles, fraction of their tension; default: 0.3"),
        optional("linear_bulk_viscosity", &Particle::linear_bulk_viscosity, non_negative,
                 "bulk viscosity b1, on the spacing of the particles, -"),
        optional("quadratic_bulk_viscosity", &Particle::quadratic_bulk_viscosity, non_negative,
                 "quadratic bulk viscosity b2, for shocks, in compression only, -"));
  }
  constexpr std::string_view fault() const {
    if (kernel == ParticleFrame::total_lagrangian &&
        (smoothing_bounds || artificial_stress || hourglass_viscosity))
      return "smoothing_bounds, artificial_stress and hourglass_viscosity belong to kernel: eulerian; leave "
             "them out";
    if (kernel == ParticleFrame::eulerian && hourglass_stiffness)
      return "hourglass_stiffness belongs to kernel: total_lagrangian; leave it out";
    if (smoothing_bounds && ((*smoothing_bounds)[0] > 1 || (*smoothing_bounds)[1] < 1))
      return "smoothing_bounds leave out 1; accepted are a number up to 1 and one from 1 on";
    return "";
  }

  /// A particle touches as its share of the lattice does, whose volume the mesh gives.
  double contact_thickness() const { return 0; }

  constexpr bool is_eulerian() const { return kernel == ParticleFrame::eulerian; }
  constexpr double smoothing() const { return smoothing_length.value_or(is_eulerian() ? 1.5 : 1.1); }
  constexpr double stiffness_share() const { return is_eulerian() ? 0 : hourglass_stiffness.value_or(0.1); }
  constexpr double viscosity_share() const { return is_eulerian() ? hourglass_viscosity.value_or(0.3) : 0; }
};

/// Sets block.kernel.
void choose_kernel(const Particle& element, Block& block);

}  // namespace brio
