#pragma once
/// J2 plasticity with any hardening law (hardening.hpp) and a kinematic share, by backward Euler: in three
/// dimensions the radial return (Krieg & Krieg 1977), in plane stress the return in the plane (Simo & Taylor
/// 1986). Both solve the consistency condition; the yield stress that remains is that of the plastic strain
/// that is stored.
///
/// The back stress of a history, where it has one, is the deviatoric tensor alpha of the three-dimensional
/// law, and the effective stress is that of xi = dev(stress) - alpha. Prager's rule: d(alpha) = 2/3
/// kinematic_modulus d(eps_p).

#include <limits>

#include "materials/elastic_constants.hpp"
#include "materials/hardening.hpp"
#include "materials/stress_state.hpp"

namespace brio {

template <class History>
inline constexpr bool has_back_stress = requires(History history) {
  history.back_stress;
};

/// Radial return in three dimensions.
template <class T, class Law, class History>
BRIO_INLINE void plastic_update(const Law& law, const SymmetricTensor<T>& strain_increment,
                                SymmetricTensor<T>& stress, History& history) {
  const ElasticConstants elastic = law.elastic();
  const auto hardening = law.hardening();
  stress = stress + elastic.stress(strain_increment);
  SymmetricTensor<T> xi = deviator(stress);
  if constexpr (has_back_stress<History>) xi = xi - history.back_stress;
  const T squared = 1.5 * contract(xi, xi);
  if (!any(squared > T(square(hardening.initial_yield_stress())))) return;

  const HardeningPoint<T> start = hardening.at(history.equivalent_plastic_strain);
  const auto yields = squared > square(start.stress);
  if (!any(yields)) return;
  const T trial = where(yields, sqrt(squared), start.stress);
  const double kinematic_modulus = law.kinematic_modulus();
  const HardeningPoint<T> end = hardening.meet(start, trial, T(3 * elastic.shear() + kinematic_modulus));
  history.equivalent_plastic_strain = where(yields, end.plastic_strain, start.plastic_strain);
  SymmetricTensor<T> returned = isotropic(trace(stress) * (1.0 / 3.0)) + (end.stress / trial) * xi;
  if constexpr (has_back_stress<History>) {
    // The part of the trial stress that flow takes away, shared between elastic unloading and the back
    // stress.
    const T share = kinematic_modulus / (3 * elastic.shear() + kinematic_modulus);
    const SymmetricTensor<T> back_stress = history.back_stress + (share * (trial - end.stress) / trial) * xi;
    history.back_stress = where(yields, back_stress, history.back_stress);
    returned = returned + history.back_stress;
  }
  stress = where(yields, returned, stress);
}

/// Effective stress along the plane-stress return. In the sum and the difference of the normal stresses and
/// in the shears the equations fall apart: each component of xi shrinks as 1 / (1 + rate r), where r = 3/2 dp
/// / q is the plastic multiplier. The transverse shears have their own rate because of the shear factor.
template <class T>
struct PlaneStressReturn {
  T sum_squared, shear_squared,
      transverse_squared;  ///< their shares of the square of the trial effective stress
  T sum_rate, shear_rate, transverse_rate;

  struct Point {
    T sum_factor, shear_factor, transverse_factor;  ///< xi at r over trial xi
    T effective_stress;                             ///< q(r)
    T plastic_increment;                            ///< dp = 2/3 r q
    T decline;                                      ///< -dq/dr
    T stiffness;                                    ///< -dq/dp
  };

  BRIO_INLINE Point at(T r) const {
    const T sum_base = 1.0 + sum_rate * r;
    const T shear_base = 1.0 + shear_rate * r;
    const T transverse_base = 1.0 + transverse_rate * r;
    const T inverse = 1.0 / (sum_base * shear_base * transverse_base);
    Point point;
    point.sum_factor = shear_base * transverse_base * inverse;
    point.shear_factor = sum_base * transverse_base * inverse;
    point.transverse_factor = sum_base * shear_base * inverse;
    const T sum_part = sum_squared * square(point.sum_factor);
    const T shear_part = shear_squared * square(point.shear_factor);
    const T transverse_part = transverse_squared * square(point.transverse_factor);
    point.effective_stress = sqrt(sum_part + shear_part + transverse_part);
    point.plastic_increment = (2.0 / 3.0) * r * point.effective_stress;
    const T sum_weight = sum_part * point.sum_factor;
    const T shear_weight = shear_part * point.shear_factor;
    const T transverse_weight = transverse_part * point.transverse_factor;
    const T weighted =
        sum_rate * sum_weight + shear_rate * shear_weight + transverse_rate * transverse_weight;
    point.decline = weighted / point.effective_stress;
    point.stiffness = 1.5 * weighted / (sum_weight + shear_weight + transverse_weight);
    return point;
  }
};

/// Relative error at which a return has converged: a few units in the last place.
template <class T>
inline constexpr double return_tolerance = 32 * std::numeric_limits<RealOf<T>>::epsilon();
/// No return needs more; the iterations converge quadratically (five at most in the tests' extremes).
inline constexpr int most_return_iterations = 40;

template <class T>
struct PlaneStressEnd {
  HardeningPoint<T> hardening;
  T multiplier;  ///< r
  typename PlaneStressReturn<T>::Point point;
};

/// r at which the effective stress has come down to the yield stress: Newton's method, on dp with the line
/// that touches q(p), and on r with 1/q, which is nearly linear in r. q(p) is convex and falls, so that dp
/// approaches from below. Lanes that start on the yield surface stay there with r = 0.
template <class T, class Hardening>
BRIO_INLINE PlaneStressEnd<T> solve_plane_stress(const PlaneStressReturn<T>& flow, const Hardening& hardening,
                                                 const HardeningPoint<T>& start) {
  constexpr double tolerance = return_tolerance<T>;
  PlaneStressEnd<T> end{start, T(0.0), flow.at(T(0.0))};
  for (int iteration = 0; iteration < most_return_iterations; ++iteration) {
    const auto& point = end.point;
    const T ahead = (start.plastic_strain - end.hardening.plastic_strain) + point.plastic_increment;
    const T line = point.effective_stress + point.stiffness * ahead;
    end.hardening = hardening.meet(end.hardening, line, point.stiffness);
    const T stress = end.hardening.stress;
    end.multiplier = max(end.multiplier + (point.effective_stress - stress) * point.effective_stress /
                                              (stress * point.decline),
                         0.0);
    end.point = flow.at(end.multiplier);
    const T gap = abs(end.point.effective_stress - stress);
    const T behind = abs((start.plastic_strain - end.hardening.plastic_strain) + end.point.plastic_increment);
    if (all((gap <= tolerance * stress) & ((behind * end.point.stiffness <= tolerance * stress) |
                                           (behind <= tolerance * end.hardening.plastic_strain))))
      break;
  }
  return end;
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
  const ShellTensor<T> elastic_increment = elastic.plane_stress(strain_increment, shear_factor);
  const ShellTensor<T> old_stress = stress;
  stress = stress + elastic_increment;
  thickness_strain_increment = elastic.thickness_strain(elastic_increment);

  const ShellTensor<T> xi = relative_stress(stress, history);
  const T sum = 0.5 * (xi.xx + xi.yy);
  const T difference = 0.5 * (xi.xx - xi.yy);
  PlaneStressReturn<T> flow;
  flow.sum_squared = square(sum);
  flow.shear_squared = 3.0 * (square(difference) + square(xi.xy));
  flow.transverse_squared = 3.0 * (square(xi.yz) + square(xi.xz));
  const T squared = flow.sum_squared + flow.shear_squared + flow.transverse_squared;
  if (!any(squared > T(square(hardening.initial_yield_stress())))) return;

  const HardeningPoint<T> start = hardening.at(history.equivalent_plastic_strain);
  const auto yields = squared > square(start.stress);
  if (!any(yields)) return;
  // Lanes that do not yield are given a state on the yield surface.
  flow.sum_squared = where(yields, flow.sum_squared, square(start.stress));
  flow.shear_squared = where(yields, flow.shear_squared, 0.0);
  flow.transverse_squared = where(yields, flow.transverse_squared, 0.0);
  const double kinematic = 2.0 / 3.0 * law.kinematic_modulus();
  const double shear = 2 * elastic.shear();
  flow.sum_rate = T(elastic.youngs_modulus / (3 * (1 - elastic.poissons_ratio)) + kinematic);
  flow.shear_rate = T(shear + kinematic);
  flow.transverse_rate = T(shear_factor * shear + kinematic);

  const PlaneStressEnd<T> end = solve_plane_stress(flow, hardening, start);
  const T onto_surface = end.hardening.stress / end.point.effective_stress;  // 1 to round-off
  const T sum_left = end.point.sum_factor * onto_surface * sum;
  const T difference_left = end.point.shear_factor * onto_surface * difference;
  const T shear_left = end.point.shear_factor * onto_surface;
  const T transverse_left = end.point.transverse_factor * onto_surface;
  const ShellTensor<T> left{sum_left + difference_left, sum_left - difference_left, shear_left * xi.xy,
                            transverse_left * xi.yz, transverse_left * xi.xz};
  history.equivalent_plastic_strain = where(yields, end.hardening.plastic_strain, start.plastic_strain);
  ShellTensor<T> returned = left;
  if constexpr (has_back_stress<History>) {
    // 2/3 kinematic_modulus r dev(xi)
    const T growth = T(kinematic) * end.multiplier;
    const SymmetricTensor<T> direction{(2.0 * left.xx - left.yy) * (1.0 / 3.0),
                                       (2.0 * left.yy - left.xx) * (1.0 / 3.0),
                                       (left.xx + left.yy) * (-1.0 / 3.0),
                                       left.xy,
                                       left.yz,
                                       left.xz};
    history.back_stress = where(yields, history.back_stress + growth * direction, history.back_stress);
    returned = returned - relative_stress(ShellTensor<T>{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)}, history);
  }
  stress = where(yields, returned, stress);
  const T thickness = elastic.thickness_strain(stress - old_stress) - (2.0 / 3.0) * end.multiplier * sum_left;
  thickness_strain_increment = where(yields, thickness, thickness_strain_increment);
}

}  // namespace brio
