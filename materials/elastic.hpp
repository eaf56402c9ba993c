#pragma once
/// Isotropic linear elasticity in rate form.

#include <string_view>

#include "materials/elastic_constants.hpp"
#include "materials/material_law.hpp"

namespace brio {

struct Elastic {
  static constexpr std::string_view name = "elastic";
  using Settings = Elastic;
  static constexpr MaterialTraits traits{.update = true, .update_plane_stress = true, .update_fibre = true};
  double density = 0;
  double youngs_modulus = 0;
  double poissons_ratio = 0;

  static constexpr auto fields() {
    return field_table(
        required("density", &Elastic::density, positive, "mass per reference volume"),
        required("youngs_modulus", &Elastic::youngs_modulus, positive, "Young's modulus, stress"),
        required("poissons_ratio", &Elastic::poissons_ratio, poissons_ratio_range, "Poisson's ratio, -"));
  }

  template <class T>
  struct History {};

  ElasticConstants elastic() const { return {youngs_modulus, poissons_ratio}; }

  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return elastic().template moduli<T>();
  }

  template <class T>
  BRIO_INLINE void update(const SymmetricTensor<T>& strain_increment, SymmetricTensor<T>& stress,
                          History<T>&) const {
    stress = stress + elastic().stress(strain_increment);
  }

  template <class T>
  BRIO_INLINE void update_plane_stress(const ShellTensor<T>& strain_increment, double shear_factor,
                                       ShellTensor<T>& stress, History<T>&,
                                       T& thickness_strain_increment) const {
    const ShellTensor<T> stress_increment = elastic().plane_stress(strain_increment, shear_factor);
    stress = stress + stress_increment;
    thickness_strain_increment = elastic().thickness_strain(stress_increment);
  }

  template <class T>
  BRIO_INLINE void update_fibre(const FibreTensor<T>& strain_increment, FibreTensor<T>& stress,
                                History<T>&) const {
    stress = stress + elastic().fibre(strain_increment);
  }
};

}  // namespace brio
