#pragma once
/// J2 plasticity with any hardening law (hardening.hpp) and a kinematic share, by backward Euler: in three
/// dimensions the radial return (Krieg & Krieg 1977), in plane stress and in fibres the return in the plane
/// (plane_stress_flow.hpp). Both solve the consistency condition; the yield stress that remains is that of
/// the plastic strain that is stored.
///
/// The back stress of a history, where it has one, is the deviatoric tensor alpha of the three-dimensional
/// law, and the effective stress is that of xi = dev(stress) - alpha. Prager's rule: d(alpha) = 2/3
/// kinematic_modulus d(eps_p).

#include "materials/elastic_constants.hpp"
#include "materials/hardening.hpp"
#include "materials/plane_stress_flow.hpp"
#include "materials/stress_state.hpp"

namespace brio {

template <class History>
inline constexpr bool has_back_stress = requires(History history) {
  history.back_stress;
};

/// \param end where lanes that yield have come to
template <class T, class End, class History>
BRIO_INLINE void keep_plastic_strain(MaskOf<T> yields, const HardeningPoint<T>& start, const End& end,
                                     History& history) {
  history.equivalent_plastic_strain = where(yields, end.plastic_strain, start.plastic_strain);
  if constexpr (keeps_rest<History>) history.plastic_strain_rest = where(yields, end.rest, start.rest);
}

/// Radial return in three dimensions.
template <class T, class Law, class History>
BRIO_INLINE void plastic_update(const Law& law, const SymmetricTensor<T>& strain_increment,
                                SymmetricTensor<T>& stress, History& history) {
  const ElasticConstants elastic = law.elastic();
  const auto hardening = law.hardening();
  // Here and not where it is needed, so that it leaves the loops over points: it depends on parameters alone.
  const T stiffness(3 * elastic.shear() + law.kinematic_modulus());
  const T kinematic_share(law.kinematic_modulus() / (3 * elastic.shear() + law.kinematic_modulus()));

  stress = stress + elastic.stress(strain_increment);
  SymmetricTensor<T> xi = deviator(stress);
  if constexpr (has_back_stress<History>) xi = xi - history.back_stress;
  const T squared = 1.5 * contract(xi, xi);
  if (!any(squared > T(square(hardening.initial_yield_stress())))) return;

  const HardeningPoint<T> start = point_of(hardening, history);
  const auto yields = squared > square(start.stress);
  if (!any(yields)) return;
  const T trial = where(yields, sqrt(squared), start.stress);
  const HardeningPoint<T> end = hardening.meet(start, trial, stiffness);
  const T left = end.stress / trial;
  keep_plastic_strain<T>(yields, start, end, history);
  SymmetricTensor<T> returned = isotropic(trace(stress) * (1.0 / 3.0)) + left * xi;
  if constexpr (has_back_stress<History>) {
    // The part of the trial stress that flow takes away, shared between elastic unloading and the back
    // stress.
    const SymmetricTensor<T> back_stress = history.back_stress + (kinematic_share * (1.0 - left)) * xi;
    history.back_stress = where(yields, back_stress, history.back_stress);
    returned = returned + history.back_stress;
  }
  stress = where(yields, returned, stress);
}

/// xi of a state of plane stress: the back stress enters with the plane-stress components whose deviator it
/// is.
template <class T, class History>
BRIO_INLINE ShellTensor<T> relative_stress(const ShellTensor<T>& stress, const History& history) {
  if constexpr (has_back_stress<History>) {
    const SymmetricTensor<T>& back = history.back_stress;
    return stress -
           ShellTensor<T>{2.0 * back.xx + back.yy, back.xx + 2.0 * back.yy, back.xy, back.yz, back.xz};
  } else {
    return stress;
  }
}

/// Return in plane stress. The transverse shears take part in the yield function.
/// \param[out] thickness_strain_increment eps_zz of this increment, elastic and plastic.
template <class T, class Law, class History>
BRIO_INLINE void plastic_update_plane_stress(const Law& law, const ShellTensor<T>& strain_increment,
                                             double shear_factor, ShellTensor<T>& stress, History& history,
                                             T& thickness_strain_increment) {
  const ElasticConstants elastic = law.elastic();
  const auto hardening = law.hardening();
  // Here and not where it is needed, so that it leaves the loops over points: it depends on parameters alone.
  const double unit = 2 * elastic.shear();
  const T kinematic_rate(2.0 / 3.0 * law.kinematic_modulus() / unit);
  PlaneStressFlow<T> flow;
  flow.unit = unit;
  flow.sum_rate = T((1 + elastic.poissons_ratio) / (3 * (1 - elastic.poissons_ratio))) + kinematic_rate;
  flow.shear_rate = 1.0 + kinematic_rate;
  flow.transverse_rate = T(shear_factor) + kinematic_rate;

  const ShellTensor<T> elastic_increment = elastic.plane_stress(strain_increment, shear_factor);
  const ShellTensor<T> old_stress = stress;
  stress = stress + elastic_increment;
  thickness_strain_increment = elastic.thickness_strain(elastic_increment);

  const ShellTensor<T> xi = relative_stress(stress, history);
  const T sum = 0.5 * (xi.xx + xi.yy);
  const T difference = 0.5 * (xi.xx - xi.yy);
  flow.sum_squared = square(sum);
  flow.shear_squared = 3.0 * (square(difference) + square(xi.xy));
  flow.transverse_squared = 3.0 * (square(xi.yz) + square(xi.xz));
  const T squared = flow.sum_squared + flow.shear_squared + flow.transverse_squared;
  if (!any(squared > T(square(hardening.initial_yield_stress())))) return;

  const HardeningPoint<T> start = point_of(hardening, history);
  const auto yields = squared > square(start.stress);
  if (!any(yields)) return;
  // Lanes that do not yield are given a state on the yield surface.
  flow.sum_squared = where(yields, flow.sum_squared, square(start.stress));
  flow.shear_squared = where(yields, flow.shear_squared, 0.0);
  flow.transverse_squared = where(yields, flow.transverse_squared, 0.0);
  const PlaneStressEnd<T> end = flow_in_plane_stress(flow, hardening, start, yields);
  const T sum_shrunk = end.factors.sum * sum;
  const T difference_shrunk = end.factors.shear * difference;
  const ShellTensor<T> shrunk{sum_shrunk + difference_shrunk, sum_shrunk - difference_shrunk,
                              end.factors.shear * xi.xy, end.factors.transverse * xi.yz,
                              end.factors.transverse * xi.xz};
  keep_plastic_strain<T>(yields, start, end, history);
  ShellTensor<T> returned = end.scale * shrunk;
  if constexpr (has_back_stress<History>) {
    // 2/3 kinematic_modulus r dev(xi)
    const T growth = kinematic_rate * end.multiplier;
    const SymmetricTensor<T> direction{(2.0 * shrunk.xx - shrunk.yy) * (1.0 / 3.0),
                                       (2.0 * shrunk.yy - shrunk.xx) * (1.0 / 3.0),
                                       (shrunk.xx + shrunk.yy) * (-1.0 / 3.0),
                                       shrunk.xy,
                                       shrunk.yz,
                                       shrunk.xz};
    history.back_stress = where(yields, history.back_stress + growth * direction, history.back_stress);
    returned = returned - relative_stress(ShellTensor<T>{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)}, history);
  }
  stress = where(yields, returned, stress);
  const T plastic_thickness = T(-2.0 / 3.0 / unit) * end.multiplier * sum_shrunk;
  const T thickness = elastic.thickness_strain(stress - old_stress) + plastic_thickness;
  thickness_strain_increment = where(yields, thickness, thickness_strain_increment);
}

/// Return in a fibre, which is free to contract: the axial stress shrinks as 1 / (1 + 2/3 (1 + nu) r), the
/// shears as 1 / (1 + r).
template <class T, class Law, class History>
BRIO_INLINE void plastic_update_fibre(const Law& law, const FibreTensor<T>& strain_increment,
                                      FibreTensor<T>& stress, History& history) {
  const ElasticConstants elastic = law.elastic();
  const auto hardening = law.hardening();
  const double unit = 2 * elastic.shear();
  const T kinematic_rate(2.0 / 3.0 * law.kinematic_modulus() / unit);
  PlaneStressFlow<T> flow;
  flow.unit = unit;
  flow.sum_rate = T(2.0 / 3.0 * (1 + elastic.poissons_ratio)) + kinematic_rate;
  flow.shear_rate = flow.transverse_rate = 1.0 + kinematic_rate;

  stress = stress + elastic.fibre(strain_increment);
  FibreTensor<T> xi = stress;
  if constexpr (has_back_stress<History>)
    xi = xi - FibreTensor<T>{1.5 * history.back_stress.xx, history.back_stress.xy, history.back_stress.xz};
  flow.sum_squared = square(xi.xx);
  flow.shear_squared = 3.0 * square(xi.xy);
  flow.transverse_squared = 3.0 * square(xi.xz);
  const T squared = flow.sum_squared + flow.shear_squared + flow.transverse_squared;
  if (!any(squared > T(square(hardening.initial_yield_stress())))) return;

  const HardeningPoint<T> start = point_of(hardening, history);
  const auto yields = squared > square(start.stress);
  if (!any(yields)) return;
  // Lanes that do not yield are given a state on the yield surface.
  flow.sum_squared = where(yields, flow.sum_squared, square(start.stress));
  flow.shear_squared = where(yields, flow.shear_squared, 0.0);
  flow.transverse_squared = where(yields, flow.transverse_squared, 0.0);
  const PlaneStressEnd<T> end = flow_in_plane_stress(flow, hardening, start, yields);
  const FibreTensor<T> shrunk{end.factors.sum * xi.xx, end.factors.shear * xi.xy,
                              end.factors.transverse * xi.xz};
  keep_plastic_strain<T>(yields, start, end, history);
  FibreTensor<T> returned = end.scale * shrunk;
  if constexpr (has_back_stress<History>) {
    // 2/3 kinematic_modulus r dev(xi)
    const T growth = kinematic_rate * end.multiplier;
    const T along = (2.0 / 3.0) * shrunk.xx;
    const SymmetricTensor<T> direction{along, -0.5 * along, -0.5 * along, shrunk.xy, T(0.0), shrunk.xz};
    history.back_stress = where(yields, history.back_stress + growth * direction, history.back_stress);
    const SymmetricTensor<T>& back = history.back_stress;
    returned = returned + FibreTensor<T>{1.5 * back.xx, back.xy, back.xz};
  }
  stress = where(yields, returned, stress);
}

}  // namespace brio
