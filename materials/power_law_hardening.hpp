#pragma once
/// J2 plasticity with power-law hardening and a Lueders plateau (Stone, Wellman & Krieg, SAND90-0153).

#include <optional>
#include <string_view>

#include "materials/material_law.hpp"
#include "materials/plastic_flow.hpp"
#include "materials/power_hardening.hpp"

namespace brio {

struct PowerLawHardening {
  static constexpr std::string_view name = "power_law_hardening";
  using Settings = PowerLawHardening;
  static constexpr MaterialTraits traits{.update = true,
                                         .update_plane_stress = true,
                                         .update_fibre = true,
                                         .equivalent_plastic_strain = true,
                                         .hardening = true,
                                         .failure = true,
                                         .named_history = true,
                                         .fault = true};
  double density = 0;
  double youngs_modulus = 0;
  double poissons_ratio = 0;
  double yield_stress = 0;
  double hardening_constant = 0;
  double hardening_exponent = 1;
  double luders_strain = 0;
  std::optional<Failure> failure{};

  static constexpr auto fields() {
    return field_table(
        required("density", &PowerLawHardening::density, positive, "mass per reference volume"),
        required("youngs_modulus", &PowerLawHardening::youngs_modulus, positive, "Young's modulus, stress"),
        required("poissons_ratio", &PowerLawHardening::poissons_ratio, poissons_ratio_range,
                 "Poisson's ratio, -"),
        required("yield_stress", &PowerLawHardening::yield_stress, positive, "uniaxial yield stress"),
        required("hardening_constant", &PowerLawHardening::hardening_constant, non_negative,
                 "A in yield_stress + A <plastic strain - luders_strain>^hardening_exponent, stress"),
        required("hardening_exponent", &PowerLawHardening::hardening_exponent, hardening_exponent_range,
                 "exponent of the plastic strain, -"),
        optional("luders_strain", &PowerLawHardening::luders_strain, non_negative,
                 "plastic strain at which hardening sets in, -"),
        optional("failure", &PowerLawHardening::failure, any_number,
                 "how the material fails; absent: never"));
  }
  constexpr std::string_view fault() const { return fault_without_rate(failure); }

  template <class T>
  struct History {
    T equivalent_plastic_strain;
    T plastic_strain_rest{};  ///< below the last digit of the former (hardening.hpp)
  };

  static constexpr auto named_history() {
    return field_table(largest("equivalent_plastic_strain", &History<double>::equivalent_plastic_strain));
  }

  ElasticConstants elastic() const { return {youngs_modulus, poissons_ratio}; }
  PowerHardening hardening() const {
    return {yield_stress, hardening_constant, hardening_exponent, luders_strain};
  }
  double kinematic_modulus() const { return 0; }

  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return elastic().template moduli<T>();
  }

  template <class T>
  BRIO_INLINE void update(const SymmetricTensor<T>& strain_increment, SymmetricTensor<T>& stress,
                          History<T>& history) const {
    plastic_update(*this, strain_increment, stress, history);
  }

  template <class T>
  BRIO_INLINE void update_plane_stress(const ShellTensor<T>& strain_increment, double shear_factor,
                                       ShellTensor<T>& stress, History<T>& history,
                                       T& thickness_strain_increment) const {
    plastic_update_plane_stress(*this, strain_increment, shear_factor, stress, history,
                                thickness_strain_increment);
  }

  template <class T>
  BRIO_INLINE void update_fibre(const FibreTensor<T>& strain_increment, FibreTensor<T>& stress,
                                History<T>& history) const {
    plastic_update_fibre(*this, strain_increment, stress, history);
  }
};

}  // namespace brio
