#pragma once
/// Toy law: elastic in volume, viscoelastic in shear (Maxwell): s' = 2 G e' - s / relaxation time, by
/// backward Euler. Walked through in docs/extending.md.

#include <string_view>

#include "materials/elastic_constants.hpp"
#include "materials/material_law.hpp"

namespace brio {

struct ToyMaxwell {
  static constexpr std::string_view name = "toy_maxwell";
  using Settings = ToyMaxwell;
  static constexpr MaterialTraits traits{.update = true, .time_step = true, .named_history = true};
  double density = 0;
  double youngs_modulus = 0;
  double poissons_ratio = 0;
  double relaxation_time = 1;
  double time_step = 0;  ///< of the present step; no entry of a deck

  static constexpr auto fields() {
    return field_table(
        required("density", &ToyMaxwell::density, positive, "mass per reference volume"),
        required("youngs_modulus", &ToyMaxwell::youngs_modulus, positive, "Young's modulus, stress"),
        required("poissons_ratio", &ToyMaxwell::poissons_ratio, poissons_ratio_range, "Poisson's ratio, -"),
        required("relaxation_time", &ToyMaxwell::relaxation_time, positive, "of shear stress, time"));
  }

  template <class T>
  struct History {
    T dissipation;  ///< energy per volume that has become heat
  };
  static constexpr auto named_history() {
    return field_table(mean("dissipation", &History<double>::dissipation),
                       largest("temperature_rise", &ToyMaxwell::temperature_rise));
  }
  /// Degree, of a heat capacity of 1e6 per volume.
  double temperature_rise(const History<double>& history) const { return 1e-6 * history.dissipation; }

  ElasticConstants elastic() const { return {youngs_modulus, poissons_ratio}; }

  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return elastic().template moduli<T>();
  }

  template <class T>
  BRIO_INLINE void update(const SymmetricTensor<T>& strain_increment, SymmetricTensor<T>& stress,
                          History<T>& history) const {
    stress = stress + elastic().stress(strain_increment);
    const double steps = time_step / relaxation_time;
    const SymmetricTensor<T> relaxed = T(1 / (1 + steps)) * deviator(stress);
    stress = isotropic(trace(stress) * (1.0 / 3.0)) + relaxed;
    history.dissipation += T(steps / (2 * elastic().shear())) * contract(relaxed, relaxed);
  }
};

}  // namespace brio
