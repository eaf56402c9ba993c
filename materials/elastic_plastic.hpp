#pragma once
/// J2 plasticity with linear hardening, isotropic, kinematic or a mix of both.

#include <optional>
#include <string_view>

#include "materials/material_law.hpp"
#include "materials/plastic_flow.hpp"

namespace brio {

struct IsotropicElasticPlastic;

struct ElasticPlastic {
  /// What runs where nothing is kinematic: no back stress to store and stream, a third of the state of a
  /// brick.
  using Reduced = IsotropicElasticPlastic;
  bool is_reduced() const { return hardening_mix == 0; }

  static constexpr std::string_view name = "elastic_plastic";
  using Settings = ElasticPlastic;
  static constexpr MaterialTraits traits{.update = true,
                                         .update_plane_stress = true,
                                         .update_fibre = true,
                                         .equivalent_plastic_strain = true,
                                         .back_stress = true,
                                         .hardening = true,
                                         .failure = true,
                                         .is_reduced = true,
                                         .named_history = true,
                                         .fault = true};
  double density = 0;
  double youngs_modulus = 0;
  double poissons_ratio = 0;
  double yield_stress = 0;
  double hardening_modulus = 0;
  double hardening_mix = 0;
  std::optional<Failure> failure{};

  static constexpr auto fields() {
    return field_table(
        required("density", &ElasticPlastic::density, positive, "mass per reference volume"),
        required("youngs_modulus", &ElasticPlastic::youngs_modulus, positive, "Young's modulus, stress"),
        required("poissons_ratio", &ElasticPlastic::poissons_ratio, poissons_ratio_range,
                 "Poisson's ratio, -"),
        required("yield_stress", &ElasticPlastic::yield_stress, positive, "uniaxial yield stress"),
        optional("hardening_modulus", &ElasticPlastic::hardening_modulus, non_negative,
                 "slope of uniaxial stress over plastic strain, stress"),
        optional("hardening_mix", &ElasticPlastic::hardening_mix, fraction,
                 "share of the hardening that moves the yield surface: 0 isotropic, 1 kinematic, -"),
        optional("failure", &ElasticPlastic::failure, any_number, "how the material fails; absent: never"));
  }
  constexpr std::string_view fault() const { return fault_without_rate(failure); }

  template <class T>
  struct History {
    T equivalent_plastic_strain;
    SymmetricTensor<T> back_stress;  ///< deviatoric
  };

  static constexpr auto named_history() {
    return field_table(largest("equivalent_plastic_strain", &History<double>::equivalent_plastic_strain));
  }

  ElasticConstants elastic() const { return {youngs_modulus, poissons_ratio}; }
  LinearHardening hardening() const { return {yield_stress, (1 - hardening_mix) * hardening_modulus}; }
  double kinematic_modulus() const { return hardening_mix * hardening_modulus; }

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

struct IsotropicElasticPlastic : ElasticPlastic {
  static constexpr MaterialTraits traits = [] {
    MaterialTraits isotropic = ElasticPlastic::traits;
    isotropic.back_stress = false;
    return isotropic;
  }();

  template <class T>
  struct History {
    T equivalent_plastic_strain;
  };

  static constexpr auto named_history() {
    return field_table(largest("equivalent_plastic_strain", &History<double>::equivalent_plastic_strain));
  }

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
