#pragma once
/// Isotropic linear elasticity in rate form.

#include <string_view>
#include <tuple>

#include "materials/stress_state.hpp"
#include "src/base/fields.hpp"

namespace brio {

/// Poisson's ratio at which the bulk modulus is still finite.
inline constexpr Range poissons_ratio_range{.lower = -1, .upper = 0.5, .lower_open = true, .upper_open = true};

struct Elastic {
  static constexpr std::string_view name = "elastic";
  double density = 0;
  double youngs_modulus = 0;
  double poissons_ratio = 0;

  static constexpr auto fields() {
    return std::tuple{
        required("density", &Elastic::density, positive, "mass per reference volume"),
        required("youngs_modulus", &Elastic::youngs_modulus, positive, "Young's modulus, stress"),
        required("poissons_ratio", &Elastic::poissons_ratio, poissons_ratio_range, "Poisson's ratio, -"),
    };
  }

  template <class T>
  struct History {};

  double first_lame() const {
    return youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
  }
  double shear_modulus() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }

  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return {T(first_lame()), T(shear_modulus())};
  }

  template <class T>
  BRIO_INLINE void update(const SymmetricTensor<T>& strain_increment, SymmetricTensor<T>& stress,
                          History<T>&) const {
    stress = stress + isotropic(T(first_lame()) * trace(strain_increment)) +
             T(2 * shear_modulus()) * strain_increment;
  }
};

}  // namespace brio
