#pragma once
/// Linear elasticity with the elastic moduli that another law has at a point: its stiffness without its
/// stress.

#include "materials/material_law.hpp"

namespace brio {

struct ElasticTangent {
  static constexpr MaterialTraits traits{.update = true, .update_plane_stress = true};
  template <class T>
  using History = ElasticModuli<T>;

  template <class T>
  ElasticModuli<T> moduli(const ElasticModuli<T>& history) const {
    return history;
  }

  template <class T>
  BRIO_INLINE void update(const SymmetricTensor<T>& strain_increment, SymmetricTensor<T>& stress,
                          const ElasticModuli<T>& m) const {
    stress = stress + isotropic(m.first_lame * trace(strain_increment)) + (2.0 * m.shear) * strain_increment;
  }

  template <class T>
  BRIO_INLINE void update_plane_stress(const ShellTensor<T>& strain, double shear_factor,
                                       ShellTensor<T>& stress, const ElasticModuli<T>& m,
                                       T& thickness_strain_increment) const {
    const T share = m.first_lame / (m.first_lame + 2.0 * m.shear);
    thickness_strain_increment = -share * (strain.xx + strain.yy);
    const T dilatation = 2.0 * m.shear * share * (strain.xx + strain.yy);
    const T twice = 2.0 * m.shear;
    stress = stress + ShellTensor<T>{dilatation + twice * strain.xx, dilatation + twice * strain.yy,
                                     twice * strain.xy, shear_factor * twice * strain.yz,
                                     shear_factor * twice * strain.xz};
  }
};

}  // namespace brio
