#pragma once
/// The consistency condition of plastic flow in plane stress (Simo & Taylor 1986).
///
/// Of xi, the trial stress less the back stress, the sum and the difference of the normal stresses and the
/// shears fall apart: each part shrinks as 1 / (1 + rate_i r), where r = 3/2 unit dp / q is the plastic
/// multiplier and q the effective stress. The transverse shears have their own rate because of the shear
/// factor. So, with the yield stress K,
///
///     q^2 = sum_i squared_i / (1 + rate_i r)^2,     q = K(p + dp),     dp = 2/3 r q / unit.
///
/// Where K is straight, of slope H, set h = 2/3 H / unit and r = s / (1 + h s): hardening only adds to the
/// rates,
///
///     sum_i squared_i / (1 + (rate_i + h) s)^2 = K(p)^2,     dp = 2/3 K(p) s / unit,     q = K(p) (1 + h s).
///
/// The left side to the power of -1/2 is an increasing concave function of s, nearly straight because the
/// rates are of one size: Chebyshev's method on it comes to round-off in one or two evaluations. Curved
/// hardening is met along its tangents. Where that does not serve, as at the end of a plateau, the root is
/// sought within a bracket.

#include <limits>

#include "materials/hardening.hpp"

namespace brio {

template <class T>
struct PlaneStressFlow {
  /// Parts of the square of the trial effective stress.
  T sum_squared, shear_squared, transverse_squared;
  T sum_rate, shear_rate, transverse_rate;
  double unit;  ///< a modulus

  /// xi at r over trial xi
  struct Factors {
    T sum, shear, transverse;
  };
  BRIO_INLINE Factors factors(T r, T added_rate = T(0.0)) const {
    const T sum_base = 1.0 + (sum_rate + added_rate) * r;
    const T shear_base = 1.0 + (shear_rate + added_rate) * r;
    const T transverse_base = 1.0 + (transverse_rate + added_rate) * r;
    const T pair = shear_base * transverse_base;
    const T inverse = 1.0 / (sum_base * pair);
    const T sum_inverse = sum_base * inverse;
    return {pair * inverse, transverse_base * sum_inverse, shear_base * sum_inverse};
  }
  BRIO_INLINE T squared(const Factors& f) const {
    return sum_squared * square(f.sum) + shear_squared * square(f.shear) +
           transverse_squared * square(f.transverse);
  }

  /// The derivative of r q by r, times q.
  BRIO_INLINE T cubed(const Factors& f) const {
    return sum_squared * square(f.sum) * f.sum + shear_squared * square(f.shear) * f.shear +
           transverse_squared * square(f.transverse) * f.transverse;
  }

  /// Taylor series of q^2: squared - 2 first ds + 3 second ds^2 - 4 third ds^3 + ...
  struct Series {
    T squared, first, second, third;
  };
  BRIO_INLINE Series series(const Factors& f, T added_rate) const {
    const T sum_rate_now = (sum_rate + added_rate) * f.sum;
    const T shear_rate_now = (shear_rate + added_rate) * f.shear;
    const T transverse_rate_now = (transverse_rate + added_rate) * f.transverse;
    const T sum_part = sum_squared * square(f.sum);
    const T shear_part = shear_squared * square(f.shear);
    const T transverse_part = transverse_squared * square(f.transverse);
    const T sum_first = sum_part * sum_rate_now;
    const T shear_first = shear_part * shear_rate_now;
    const T transverse_first = transverse_part * transverse_rate_now;
    const T sum_second = sum_first * sum_rate_now;
    const T shear_second = shear_first * shear_rate_now;
    const T transverse_second = transverse_first * transverse_rate_now;
    return {
        sum_part + shear_part + transverse_part, sum_first + shear_first + transverse_first,
        sum_second + shear_second + transverse_second,
        sum_second * sum_rate_now + shear_second * shear_rate_now + transverse_second * transverse_rate_now};
  }
};

/// What flow leaves of xi: each part times its factor and `scale`.
template <class T>
struct PlaneStressEnd {
  T plastic_strain, rest;  ///< as in HardeningPoint
  typename PlaneStressFlow<T>::Factors factors;
  T scale;
  T multiplier;  ///< r scale: r times what is left is `multiplier` times the factors
};

/// The inverse series of the power -1/2 of q^2: with `over` = q / target - 1 the step in s towards the target
/// is over / mean rate (1 + bend), up to the fourth order. `share` is target / q, and makes it hold its size
/// from afar.
template <class T>
BRIO_INLINE T bend_of(T over, T share, T variance, T skewness) {
  const T a = 1.5 * variance;
  const T ahead = over * share;
  return ahead * (a + 2.0 * (square(a) - skewness) * ahead);
}

/// Step of that series. \param over q / target - 1. \param share target / q.
template <class T>
BRIO_INLINE T step_of(const typename PlaneStressFlow<T>::Series& series, T inverse_first, T inverse_rate,
                      T over, T share) {
  const T variance = series.second * inverse_rate * inverse_first - 1.0;
  const T skewness = series.third * square(inverse_rate) * inverse_first - 1.0 - 3.0 * variance;
  const T newton = over * inverse_rate;
  return newton + newton * min(max(bend_of(over, share, variance, skewness), -0.5), 1.0);
}

/// Step towards the target from near by. \param excess q^2 / target^2 - 1.
template <class T>
BRIO_INLINE T step_to(const typename PlaneStressFlow<T>::Series& series, T excess) {
  // sqrt(1 + z) + 1, by which z is divided for q / target - 1
  const T z = min(excess, 1.0);
  const T root = 2.0 + excess * (0.5 - z * (0.125 - 0.0625 * z));
  const T inverse = 1.0 / (series.first * root);
  const T inverse_first = inverse * root;
  const T over = excess * (inverse * series.first);
  return step_of<T>(series, inverse_first, series.squared * inverse_first, over, max(1.0 - over, 0.0));
}

/// Step from no flow, however far. \param[out] inverse_target, inverse_rate
template <class T>
BRIO_INLINE T first_step_to(T target, const typename PlaneStressFlow<T>::Series& series, T& inverse_target,
                            T& inverse_rate) {
  const T inverse = 1.0 / (series.first * target * series.squared);
  const T stress = sqrt(series.squared);
  inverse_target = inverse * series.first * series.squared;
  const T inverse_first = inverse * target * series.squared;
  inverse_rate = inverse_first * series.squared;
  const T share = stress * target * (inverse * series.first * target);
  return max(step_of<T>(series, inverse_first, inverse_rate, stress * inverse_target - 1.0, share), 0.0);
}

/// Where hardening is straight as far as plane stress needs it.
template <class Hardening>
inline constexpr bool is_straight = Hardening::shape == HardeningShape::straight;
/// Where its tangents serve.
template <class Hardening>
inline constexpr bool has_tangents = Hardening::shape == HardeningShape::has_tangents;
/// Where it is straight between corners.
template <class Hardening>
inline constexpr bool has_pieces = Hardening::shape == HardeningShape::piecewise_straight;

/// Flow along tangents of the hardening curve. \param yields lanes that flow at all. \return whether all of
/// them have come to the root.
template <class T, class Hardening>
BRIO_INLINE bool flow_along_tangents(const PlaneStressFlow<T>& trial, const Hardening& hardening,
                                     const HardeningPoint<T>& start, MaskOf<T> yields,
                                     PlaneStressEnd<T>& end) {
  // What the series leaves after a relative change of this size is below round-off.
  constexpr double small_change = sizeof(RealOf<T>) == 8 ? 2e-4 : 2e-2;
  constexpr double round_off = 4.0 * std::numeric_limits<RealOf<T>>::epsilon();
  constexpr int most_evaluations = 20;
  // Stress over `unit`: numbers of the size of strains, whose products stay in range.
  const T scale(1 / trial.unit), squared_scale(1 / (trial.unit * trial.unit));
  const T slope_scale(2.0 / 3.0 / trial.unit);
  PlaneStressFlow<T> flow = trial;
  flow.sum_squared *= squared_scale;
  flow.shear_squared *= squared_scale;
  flow.transverse_squared *= squared_scale;

  T yield = scale * start.stress;  // of the tangent, at the plastic strain at the start of the step
  T h = slope_scale * start.slope;
  T inverse_yield, inverse_rate;
  const auto at_start = flow.series({T(1.0), T(1.0), T(1.0)}, h);
  T multiplier = where(yields, first_step_to(yield, at_start, inverse_yield, inverse_rate), T(0.0));
  HardeningPoint<T> point = start;
  if constexpr (!is_straight<Hardening>) {
    const T strain = (2.0 / 3.0) * yield * multiplier;
    const T bent = strain - strain * (0.5 * slope_scale) * hardening.curvature(start) * strain * inverse_rate;
    if (all(hardening.has_tangent_over(start, bent))) {
      point = hardening.along(start, bent);
    } else {
      const auto elastic = flow.series({T(1.0), T(1.0), T(1.0)}, T(0.0));
      point = hardening.meet(start, trial.unit * sqrt(elastic.squared),
                             (1.5 * trial.unit) * elastic.first / elastic.squared);
    }
  }
  T flowed(0.0);
  for (int evaluation = 0; evaluation < most_evaluations; ++evaluation) {
    if constexpr (!is_straight<Hardening>) {
      flowed = where(yields, flow_between(start, point), T(0.0));
      h = slope_scale * point.slope;
      yield = scale * point.stress - 1.5 * h * flowed;
      inverse_yield = 1.0 / yield;
      multiplier = 1.5 * flowed * inverse_yield;
    }
    const auto factors = flow.factors(multiplier, h);
    const auto series = flow.series(factors, h);
    const T inverse_square = square(inverse_yield);
    T excess = series.squared * inverse_square - 1.0;
    // Where the curve is steep, strains are felt that the excess no longer shows.
    if constexpr (!is_straight<Hardening>) excess = where(abs(excess) > T(round_off), excess, T(0.0));
    const T next = max(multiplier + step_to<T>(series, excess), 0.0);
    const T change = next - multiplier;
    const T strain = (2.0 / 3.0) * yield * next;
    auto moves = abs((flow.shear_rate + h) * factors.shear * change) > T(small_change);
    if constexpr (!is_straight<Hardening>) moves = moves | hardening.bends(point, strain - flowed);
    if (!any(moves & yields)) {
      const auto after = [&](T factor, T rate) {
        const T x = (rate + h) * factor * change;
        return factor - factor * x * (1.0 - x * (1.0 - x * (1.0 - x)));
      };
      HardeningPoint<T> stored = start;
      stored.flow_by(strain);
      end.plastic_strain = stored.plastic_strain;
      end.rest = stored.rest;
      end.factors = {after(factors.sum, flow.sum_rate), after(factors.shear, flow.shear_rate),
                     after(factors.transverse, flow.transverse_rate)};
      // The last digits: the stress of that strain.
      const T onto_surface = 1.5 - 0.5 * flow.squared(end.factors) * inverse_square;
      end.scale = onto_surface * (1.0 + h * next);
      end.multiplier = onto_surface * next;
      return true;
    }
    if constexpr (is_straight<Hardening>) {
      multiplier = next;
    } else {
      point = hardening.along(point, strain - flowed);
    }
  }
  return false;
}

/// r at which the effective stress has come down to the yield stress. The line that touches q(p), which is
/// convex, gives the yield stress to come down to; r follows by Chebyshev's method on 1/q. Lanes that start
/// on the yield surface stay there with r = 0.
///
/// q falls and p rises with r, so that there is one root, on the side to which the step points. It is kept in
/// a bracket that, after `free_steps`, is halved every other step: the loop ends at the latest when no number
/// is left between its ends, and at once for what is not a number.
template <class T, class Hardening>
BRIO_CALLED PlaneStressEnd<T> flow_within_bracket(const PlaneStressFlow<T>& flow, const Hardening& hardening,
                                                  const HardeningPoint<T>& start) {
  constexpr double small_change = sizeof(RealOf<T>) == 8 ? 1e-6 : 1e-3;
  constexpr int free_steps = 8;
  const T strain_unit(2.0 / 3.0 / flow.unit);
  HardeningPoint<T> point = start;
  T multiplier(0.0), low(0.0), high(std::numeric_limits<RealOf<T>>::max());
  typename PlaneStressFlow<T>::Factors factors{T(1.0), T(1.0), T(1.0)};
  for (int step = 0;; ++step) {
    const auto series = flow.series(factors, T(0.0));
    const T effective_stress = sqrt(series.squared);
    if (step == 0) {
      // There q has come down to the yield stress without hardening, even at the slowest of the rates.
      const T slowest = min(flow.sum_rate, min(flow.shear_rate, flow.transverse_rate));
      high = max(effective_stress / start.stress - 1.0, 0.0) / slowest;
    }
    const T stiffness = 1.5 * flow.unit * series.first / flow.cubed(factors);  // -dq/dp
    const T ahead = flow_between(point, start) + strain_unit * multiplier * effective_stress;
    point = hardening.meet(point, effective_stress + stiffness * ahead, stiffness);
    const T newton = (effective_stress - point.stress) * series.squared / (point.stress * series.first);
    const T bend = 1.5 * newton * (series.second / series.first - series.first / series.squared);
    const T old = multiplier;
    multiplier = max(old + newton * (1.0 + min(max(bend, -0.5), 1.0)), 0.0);
    const auto is_number = (newton > T(0.0)) | (newton <= T(0.0));
    multiplier = where(is_number, multiplier, newton);
    const auto moves =
        abs(multiplier - old) * flow.shear_rate > small_change * (1.0 + flow.shear_rate * multiplier);
    low = where(newton > T(0.0), old, low);
    high = where(newton < T(0.0), old, high);
    const T middle = 0.5 * (low + high);
    const auto goes_on = moves & (middle > low) & (middle < high);
    if (!any(goes_on)) break;
    const auto leaves = (multiplier < low) | (multiplier > high);
    const bool halves = step >= free_steps && step % 2 == 0;
    multiplier = where(halves ? goes_on : goes_on & leaves, middle, multiplier);
    factors = flow.factors(multiplier);
  }
  factors = flow.factors(multiplier);
  // The root of a ratio that is 1 to round-off.
  const T onto_surface = 0.5 + 0.5 * square(point.stress) / flow.squared(factors);
  return {point.plastic_strain, point.rest, factors, onto_surface, multiplier * onto_surface};
}

/// \param yields lanes whose trial state is beyond the yield surface; the others are on it.
template <class T, class Hardening>
BRIO_INLINE PlaneStressEnd<T> flow_in_plane_stress(const PlaneStressFlow<T>& flow, const Hardening& hardening,
                                                   const HardeningPoint<T>& start, MaskOf<T> yields) {
  PlaneStressEnd<T> end;
  if constexpr (is_straight<Hardening>) {
    if (flow_along_tangents(flow, hardening, start, yields, end)) return end;
  } else if constexpr (has_tangents<Hardening>) {
    if (all(hardening.is_concave_from(start) | !yields) &&
        flow_along_tangents(flow, hardening, start, yields, end))
      return end;
  } else if constexpr (has_pieces<Hardening>) {
    // A step that ends on the piece on which it starts is that of a straight curve.
    if (flow_along_tangents(flow, LinearHardening{}, start, yields, end) &&
        all((end.plastic_strain <= hardening.end_of_piece(start)) | !yields))
      return end;
  }
  return flow_within_bracket(flow, hardening, start);
}

}  // namespace brio
