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
  // Here and not where it is needed, so that it leaves the loops over points: it depends on parameters alone.
  const T stiffness(3 * elastic.shear() + law.kinematic_modulus());
  const T kinematic_share(law.kinematic_modulus() / (3 * elastic.shear() + law.kinematic_modulus()));

  stress = stress + elastic.stress(strain_increment);
  SymmetricTensor<T> xi = deviator(stress);
  if constexpr (has_back_stress<History>) xi = xi - history.back_stress;
  const T squared = 1.5 * contract(xi, xi);
  if (!any(squared > T(square(hardening.initial_yield_stress())))) return;

  const HardeningPoint<T> start = hardening.at(history.equivalent_plastic_strain);
  const auto yields = squared > square(start.stress);
  if (!any(yields)) return;
  const T trial = where(yields, sqrt(squared), start.stress);
  const HardeningPoint<T> end = hardening.meet(start, trial, stiffness);
  const T left = end.stress / trial;
  history.equivalent_plastic_strain = where(yields, end.plastic_strain, start.plastic_strain);
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

/// Effective stress along the plane-stress return. In the sum and the difference of the normal stresses and
/// in the shears the equations fall apart: each component of xi shrinks as 1 / (1 + rate r), where r = 3/2 dp
/// / q is the plastic multiplier. The transverse shears have their own rate because of the shear factor.
template <class T>
struct PlaneStressReturn {
  T sum_squared, shear_squared,
      transverse_squared;                   ///< their shares of the square of the trial effective stress
  T sum_rate, shear_rate, transverse_rate;  ///< over `unit`; r is taken times `unit`
  T unit;                                   ///< a modulus
  T plastic_unit;                           ///< 2/3 over unit: dp = plastic_unit r q

  /// xi at r over trial xi
  struct Factors {
    T sum, shear, transverse;
  };
  BRIO_INLINE Factors factors(T r) const {
    const T sum_base = 1.0 + sum_rate * r;
    const T shear_base = 1.0 + shear_rate * r;
    const T transverse_base = 1.0 + transverse_rate * r;
    const T pair = shear_base * transverse_base;
    const T inverse = 1.0 / (sum_base * pair);
    return {pair * inverse, sum_base * transverse_base * inverse, sum_base * shear_base * inverse};
  }
  BRIO_INLINE T squared(const Factors& f) const {
    return sum_squared * square(f.sum) + shear_squared * square(f.shear) +
           transverse_squared * square(f.transverse);
  }

  /// The return at r: effective stress q, and what its slopes are made of.
  struct Point {
    T squared, effective_stress;  ///< q^2, q
    T first, second;              ///< first = -q dq/dr; d(first)/dr = -3 second
    T stiffness;                  ///< -dq/dp, p = 2/3 r q / unit
  };
  BRIO_INLINE Point at(const Factors& f) const {
    const T sum_part = sum_squared * square(f.sum);
    const T shear_part = shear_squared * square(f.shear);
    const T transverse_part = transverse_squared * square(f.transverse);
    const T sum_weight = sum_part * f.sum;
    const T shear_weight = shear_part * f.shear;
    const T transverse_weight = transverse_part * f.transverse;
    const T sum_first = sum_rate * sum_weight;
    const T shear_first = shear_rate * shear_weight;
    const T transverse_first = transverse_rate * transverse_weight;
    Point point;
    point.squared = sum_part + shear_part + transverse_part;
    point.effective_stress = sqrt(point.squared);
    point.first = sum_first + shear_first + transverse_first;
    point.second = sum_rate * f.sum * sum_first + shear_rate * f.shear * shear_first +
                   transverse_rate * f.transverse * transverse_first;
    point.stiffness = 1.5 * unit * point.first / (sum_weight + shear_weight + transverse_weight);
    return point;
  }
};

template <class T>
struct PlaneStressEnd {
  HardeningPoint<T> hardening;
  T multiplier;  ///< r times unit
};

/// r at which the effective stress has come down to the yield stress. The line that touches q(p), which is
/// convex, gives the yield stress to come down to; r follows by Chebyshev's method on 1/q, which is nearly
/// linear in r: two or three steps where strain increments are small. Lanes that start on the yield surface
/// stay there with r = 0.
///
/// q falls and p rises with r, so that there is one root, on the side to which the step points. It is kept in
/// a bracket that, after `free_steps`, is halved every other step: the loop ends at the latest when no number
/// is left between its ends, and at once for what is not a number.
template <class T, class Hardening>
BRIO_INLINE PlaneStressEnd<T> solve_plane_stress(const PlaneStressReturn<T>& flow, const Hardening& hardening,
                                                 const HardeningPoint<T>& start) {
  // What is left after a relative change of this size is below round-off.
  constexpr double small_change = sizeof(RealOf<T>) == 8 ? 1e-6 : 1e-3;
  constexpr int free_steps = 8;
  PlaneStressEnd<T> end{start, T(0.0)};
  typename PlaneStressReturn<T>::Factors factors{T(1.0), T(1.0), T(1.0)};
  T low(0.0);
  T high(std::numeric_limits<RealOf<T>>::max());
  for (int step = 0;; ++step) {
    const auto point = flow.at(factors);
    if (step == 0) {
      // There q has come down to the yield stress without hardening, even at the slowest of the rates.
      const T slowest = min(flow.sum_rate, min(flow.shear_rate, flow.transverse_rate));
      high = max(point.effective_stress / start.stress - 1.0, 0.0) / slowest;
    }
    const T ahead = (start.plastic_strain - end.hardening.plastic_strain) +
                    flow.plastic_unit * end.multiplier * point.effective_stress;
    const T line = point.effective_stress + point.stiffness * ahead;
    end.hardening = hardening.meet(end.hardening, line, point.stiffness);
    const T stress = end.hardening.stress;
    const T newton = (point.effective_stress - stress) * point.squared / (stress * point.first);
    const T bend = 1.5 * newton * (point.second / point.first - point.first / point.squared);
    const T old = end.multiplier;
    end.multiplier = max(old + newton * (1.0 + min(max(bend, -0.5), 1.0)), 0.0);
    const auto moves =
        abs(end.multiplier - old) * flow.shear_rate > small_change * (1.0 + flow.shear_rate * end.multiplier);
    low = where(newton > T(0.0), old, low);
    high = where(newton < T(0.0), old, high);
    const T middle = 0.5 * (low + high);
    const auto goes_on = moves & (middle > low) & (middle < high);
    if (!any(goes_on)) return end;
    const auto leaves = (end.multiplier < low) | (end.multiplier > high);
    const bool halves = step >= free_steps && step % 2 == 0;
    end.multiplier = where(halves ? goes_on : goes_on & leaves, middle, end.multiplier);
    factors = flow.factors(end.multiplier);
  }
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
  PlaneStressReturn<T> flow;
  flow.unit = T(unit);
  flow.plastic_unit = T(2.0 / 3.0 / unit);
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

  const HardeningPoint<T> start = hardening.at(history.equivalent_plastic_strain);
  const auto yields = squared > square(start.stress);
  if (!any(yields)) return;
  // Lanes that do not yield are given a state on the yield surface.
  flow.sum_squared = where(yields, flow.sum_squared, square(start.stress));
  flow.shear_squared = where(yields, flow.shear_squared, 0.0);
  flow.transverse_squared = where(yields, flow.transverse_squared, 0.0);
  const PlaneStressEnd<T> end = solve_plane_stress(flow, hardening, start);
  const auto factors = flow.factors(end.multiplier);
  // The root of a ratio that is 1 to round-off.
  const T onto_surface = 0.5 + 0.5 * square(end.hardening.stress) / flow.squared(factors);
  const T sum_left = factors.sum * onto_surface * sum;
  const T shear_left = factors.shear * onto_surface;
  const T difference_left = shear_left * difference;
  const T transverse_left = factors.transverse * onto_surface;
  const ShellTensor<T> left{sum_left + difference_left, sum_left - difference_left, shear_left * xi.xy,
                            transverse_left * xi.yz, transverse_left * xi.xz};
  history.equivalent_plastic_strain = where(yields, end.hardening.plastic_strain, start.plastic_strain);
  ShellTensor<T> returned = left;
  if constexpr (has_back_stress<History>) {
    // 2/3 kinematic_modulus r dev(xi)
    const T growth = kinematic_rate * end.multiplier;
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
  const T thickness =
      elastic.thickness_strain(stress - old_stress) - flow.plastic_unit * end.multiplier * sum_left;
  thickness_strain_increment = where(yields, thickness, thickness_strain_increment);
}

}  // namespace brio
