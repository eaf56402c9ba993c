#pragma once
/// Compressible neo-Hookean solid: per reference volume, W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2
/// (Simo & Pister 1984; Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis). Stress
/// follows from the total stretch, so that it comes back from any closed path: a check on the laws in rate
/// form at large strain.

#include <string_view>

#include "materials/elastic_constants.hpp"
#include "materials/material_law.hpp"
#include "src/base/lane_math.hpp"

namespace brio {

struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  using Settings = NeoHookean;
  static constexpr MaterialTraits traits{.update_from_stretch = true};
  double density = 0;
  double youngs_modulus = 0;
  double poissons_ratio = 0;

  static constexpr auto fields() {
    return field_table(required("density", &NeoHookean::density, positive, "mass per reference volume"),
                       required("youngs_modulus", &NeoHookean::youngs_modulus, positive,
                                "Young's modulus at small strain, stress"),
                       required("poissons_ratio", &NeoHookean::poissons_ratio, poissons_ratio_range,
                                "Poisson's ratio at small strain, -"));
  }

  /// How far the moduli have moved from those at rest; zero before the first update.
  template <class T>
  struct History {
    T first_lame_growth;
    T shear_growth;
  };

  ElasticConstants elastic() const { return {youngs_modulus, poissons_ratio}; }

  /// Of the present state, per current volume: first_lame + 2 shear bounds rho c^2 of every wave, shear that
  /// of waves polarized across their direction. At large stretch first_lame turns negative, down to -shear.
  template <class T>
  ElasticModuli<T> moduli(const History<T>& history) const {
    return {T(elastic().first_lame()) + history.first_lame_growth,
            T(elastic().shear()) + history.shear_growth};
  }

  /// \param stretch U of F = R U, positive definite
  /// \param[out] stress Cauchy stress on the unrotated axes: R^T sigma R = (mu (U^2 - I) + lambda ln J I) / J
  template <class T>
  BRIO_INLINE void update_from_stretch(const SymmetricTensor<T>& stretch, SymmetricTensor<T>& stress,
                                       History<T>& history) const {
    const double first_lame = elastic().first_lame();
    const double shear = elastic().shear();
    const SymmetricTensor<T> growth = growth_of_square(stretch);
    const T volume = determinant(stretch);
    const T inverse_volume = 1.0 / volume;
    const T log_volume = log(volume);
    stress = inverse_volume * (isotropic(T(first_lame) * log_volume) + T(shear) * growth);

    // Acoustic tensor along n: J rho c^2 = mu n.b.n across and lambda (1 - ln J) + mu (1 + n.b.n) along n.
    // The largest n.b.n is at most the mean of b plus sqrt(2/3) of the size of its deviator, equal in
    // uniaxial tension.
    const SymmetricTensor<T> deviatoric = deviator(growth);
    const T largest =
        1.0 + trace(growth) * (1.0 / 3.0) + sqrt((2.0 / 3.0) * contract(deviatoric, deviatoric));
    const T across = T(shear) * largest * inverse_volume;
    const T along = (T(first_lame) * (1.0 - log_volume) + T(shear) * (1.0 + largest)) * inverse_volume;
    history.shear_growth = across - T(shear);
    history.first_lame_growth = max(along - 2.0 * across, -across) - T(first_lame);
  }

 private:
  /// U^2 - I from U - I, which keeps the digits of a small strain.
  template <class T>
  BRIO_INLINE static SymmetricTensor<T> growth_of_square(const SymmetricTensor<T>& stretch) {
    const SymmetricTensor<T> e = stretch - isotropic(T(1.0));
    const SymmetricTensor<T> squared{
        square(e.xx) + square(e.xy) + square(e.xz), square(e.xy) + square(e.yy) + square(e.yz),
        square(e.xz) + square(e.yz) + square(e.zz), e.xx * e.xy + e.xy * e.yy + e.xz * e.yz,
        e.xy * e.xz + e.yy * e.yz + e.yz * e.zz,    e.xx * e.xz + e.xy * e.yz + e.xz * e.zz};
    return T(2.0) * e + squared;
  }
  template <class T>
  BRIO_INLINE static T determinant(const SymmetricTensor<T>& a) {
    return a.xx * (a.yy * a.zz - square(a.yz)) - a.xy * (a.xy * a.zz - a.yz * a.xz) +
           a.xz * (a.xy * a.yz - a.yy * a.xz);
  }
};

}  // namespace brio
