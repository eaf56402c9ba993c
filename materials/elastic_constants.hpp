#pragma once
/// Isotropic elasticity as every law here starts from it: two constants, the stress they give to a strain
/// increment in three dimensions and in plane stress.

#include "materials/stress_state.hpp"
#include "src/base/fields.hpp"

namespace brio {

/// Poisson's ratio at which the bulk modulus is still finite.
inline constexpr Range poissons_ratio_range{
    .lower = -1, .upper = 0.5, .lower_open = true, .upper_open = true};

struct ElasticConstants {
  double youngs_modulus;
  double poissons_ratio;

  constexpr double first_lame() const {
    return youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
  }
  constexpr double shear() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }

  template <class T>
  ElasticModuli<T> moduli() const {
    return {T(first_lame()), T(shear())};
  }

  template <class T>
  BRIO_INLINE SymmetricTensor<T> stress(const SymmetricTensor<T>& strain) const {
    return isotropic(T(first_lame()) * trace(strain)) + T(2 * shear()) * strain;
  }

  /// Plane stress, sigma_zz = 0. \param shear_factor multiplies the transverse shear modulus (5/6 for a
  /// plate).
  template <class T>
  BRIO_INLINE ShellTensor<T> plane_stress(const ShellTensor<T>& strain, double shear_factor) const {
    const double stretch = youngs_modulus / (1 - poissons_ratio * poissons_ratio);
    const T transverse(2 * shear_factor * shear());
    return {T(stretch) * (strain.xx + T(poissons_ratio) * strain.yy),
            T(stretch) * (strain.yy + T(poissons_ratio) * strain.xx), T(2 * shear()) * strain.xy,
            transverse * strain.yz, transverse * strain.xz};
  }

  /// Stress along a fibre and across it, free to contract.
  template <class T>
  BRIO_INLINE FibreTensor<T> fibre(const FibreTensor<T>& strain) const {
    return {T(youngs_modulus) * strain.xx, T(2 * shear()) * strain.xy, T(2 * shear()) * strain.xz};
  }

  /// Elastic strain through the thickness that goes with an increment of plane stress.
  template <class T>
  BRIO_INLINE T thickness_strain(const ShellTensor<T>& stress_increment) const {
    return T(-poissons_ratio / youngs_modulus) * (stress_increment.xx + stress_increment.yy);
  }
};

}  // namespace brio
