#pragma once
/// yield_stress + constant <p - luders_strain>^exponent, whose slope is infinite where hardening sets in, and
/// where a falling line meets it.
///
/// With u = p - luders_strain the crossing beyond the plateau solves
///
///     stiffness u + constant u^exponent = C,     u > 0, C > 0.
///
/// The left side rises and is concave in u: Chebyshev's method from a near point takes few steps, kept within
/// a bracket. In log(u) the logarithm of the left side is convex with a slope between the exponent and 1: a
/// start from the smaller of the two asymptotes comes down on the root without fail, however steep the curve.

#include <cmath>
#include <limits>

#include "materials/hardening.hpp"
#include "src/base/fields.hpp"
#include "src/base/lane_math.hpp"

namespace brio {

inline constexpr Range hardening_exponent_range{.lower = 0, .upper = 1, .lower_open = true};

struct PowerHardening {
  double yield_stress;
  double constant;       ///< >= 0, stress
  double exponent;       ///< in (0, 1]
  double luders_strain;  ///< >= 0
  static constexpr HardeningShape shape = HardeningShape::has_tangents;

  double initial_yield_stress() const { return yield_stress; }

  template <class T>
  BRIO_INLINE HardeningPoint<T> at(T plastic_strain, T rest = T(0.0)) const {
    const T beyond = max((plastic_strain - T(luders_strain)) + rest, 0.0);
    const T rise = T(constant) * pow(beyond, exponent);
    return {plastic_strain, T(yield_stress) + rise, T(exponent) * rise * inverse_of(beyond), rest};
  }

  /// The curve at a distance from `near`.
  template <class T>
  BRIO_INLINE HardeningPoint<T> along(const HardeningPoint<T>& near, T distance) const {
    HardeningPoint<T> end = near;
    end.flow_by(distance);
    if (!all(is_near(near, distance))) return at(end.plastic_strain, end.rest);
    const T relative = distance * inverse_of(max(beyond(near), 0.0));
    const T power = binomial_series(relative);
    end.stress = T(yield_stress) + (near.stress - T(yield_stress)) * power;
    // 1 / (1 + x), as far as a slope needs it that acts over a small distance.
    const T inverse =
        1.0 - relative * (1.0 - relative * (1.0 - relative * (1.0 - relative * (1.0 - relative))));
    end.slope = near.slope * power * inverse;
    return end;
  }
  template <class T>
  BRIO_INLINE T curvature(const HardeningPoint<T>& point) const {
    return T(exponent - 1) * point.slope * inverse_of(max(beyond(point), 0.0));
  }
  template <class T>
  BRIO_INLINE MaskOf<T> is_near(const HardeningPoint<T>& point, T distance) const {
    return abs(distance) <= T(series_reach) * max(beyond(point), 0.0);
  }
  template <class T>
  BRIO_INLINE MaskOf<T> has_tangent_over(const HardeningPoint<T>& point, T distance) const {
    return abs(distance) <= max(beyond(point), 0.0);
  }
  template <class T>
  BRIO_INLINE MaskOf<T> bends(const HardeningPoint<T>& point, T distance) const {
    constexpr double round_off = 0.5 * std::numeric_limits<RealOf<T>>::epsilon();
    return point.slope * square(distance) > round_off * point.stress * beyond(point);
  }
  template <class T>
  BRIO_INLINE MaskOf<T> is_concave_from(const HardeningPoint<T>& point) const {
    return beyond(point) >= T(0.0);
  }

  template <class T>
  BRIO_INLINE HardeningPoint<T> meet(const HardeningPoint<T>& near, T effective_stress, T stiffness) const {
    const T near_u = beyond(near);
    const T newton = (effective_stress - near.stress) / (stiffness + near.slope);
    if (all(abs(newton) <= T(straight<T>) * near_u)) {
      HardeningPoint<T> end = near;
      end.flow_by(newton);
      end.stress = near.stress + newton * near.slope;
      return end;
    }
    Crossing<T> crossing;
    crossing.stiffness = stiffness;
    crossing.base_rise = near.stress - T(yield_stress);
    crossing.base = max(near_u, 0.0);
    // Where the rise at `near` is below the last digit of the yield stress, the base is the end of the
    // plateau.
    if (constant > 0) crossing.base = where(crossing.base_rise > T(0.0), crossing.base, 0.0);
    crossing.excess = (effective_stress - near.stress) + stiffness * (near_u - crossing.base);
    const T height = crossing.excess + stiffness * crossing.base + crossing.base_rise;  // C
    const auto hardens = height > T(0.0);
    if (all(hardens)) return beyond_plateau(crossing, height, near, near_u);
    HardeningPoint<T> plateau = near;
    const T to_plateau = (effective_stress - T(yield_stress)) / stiffness;
    plateau.flow_by(where(near_u > T(0.0), to_plateau, min(to_plateau, -near_u)));
    plateau.stress = T(yield_stress);
    plateau.slope = T(0.0);
    if (!any(hardens)) return plateau;
    crossing.excess = where(hardens, crossing.excess, 0.0);
    const HardeningPoint<T> end = beyond_plateau(crossing, where(hardens, height, stiffness), near, near_u);
    return {where(hardens, end.plastic_strain, plateau.plastic_strain),
            where(hardens, end.stress, yield_stress), where(hardens, end.slope, 0.0),
            where(hardens, end.rest, plateau.rest)};
  }

 private:
  /// stiffness d + constant (base + d)^exponent - base_rise = excess, for the step d from a base on the
  /// curve.
  template <class T>
  struct Crossing {
    T stiffness;
    T base;       ///< u >= 0 of the base
    T base_rise;  ///< constant base^exponent
    T excess;     ///< of the line over the curve at the base
  };
  /// Crossings that are taken for one at the base: none of the strain between is a number that serves.
  template <class T>
  struct VerticalPart {
    MaskOf<T> meets;
    T rise;  ///< of the curve at its end
  };
  /// constant u^exponent at u.
  template <class T>
  struct Rise {
    T u, value;
    MaskOf<T> found;
  };

  /// Relative distance in u over which the cubic remainder of a Taylor series is below round-off.
  template <class T>
  static constexpr double near_enough = sizeof(RealOf<T>) == 8 ? 4e-6 : 2e-3;
  /// Relative distance in u over which the curve is straight to round-off.
  template <class T>
  static constexpr double straight = sizeof(RealOf<T>) == 8 ? 2e-7 : 5e-4;
  /// Up to this plastic strain beyond the plateau the curve is taken for vertical, so that derivatives stay
  /// finite: a line that ends there keeps its stress and flows no further than the plateau. In single
  /// precision that is a visible share of the hardening constant where the exponent is below about 0.2.
  template <class T>
  static constexpr double least = sizeof(RealOf<T>) == 8 ? 1e-200 : 1e-25;
  /// Distance, relative to the base, within which the binomial series gives the power to round-off.
  static constexpr double series_reach = 1.0 / 32;
  template <class T>
  static constexpr int series_terms = sizeof(RealOf<T>) == 8 ? 10 : 5;
  /// What goes to and fro between two digits of the rise by then is halved.
  static constexpr int newton_iterations = 6;
  static constexpr int most_iterations = 40;

  /// u, also below 0; without loss next to the end of the plateau.
  template <class T>
  BRIO_INLINE T beyond(const HardeningPoint<T>& point) const {
    return (point.plastic_strain - T(luders_strain)) + point.rest;
  }
  template <class T>
  BRIO_INLINE T inverse_of(T u) const {
    return 1.0 / max(u, least<T>);
  }

  /// (1 + x)^exponent for small x: 1 + n x (1 + (n-1)/2 x (1 + (n-2)/3 x (...))).
  template <class T>
  BRIO_INLINE T binomial_series(T x) const {
    T sum(1.0);
#pragma GCC unroll 16
    for (int k = series_terms<T> - 1; k >= 0; --k) {
      const double share = 1.0 / (k + 1);
      sum = 1.0 + (T(exponent * share - k * share) * x) * sum;
    }
    return sum;
  }

  template <class T>
  BRIO_CALLED HardeningPoint<T> beyond_plateau(const Crossing<T>& crossing, T height,
                                               const HardeningPoint<T>& near, T near_u) const {
    const VerticalPart<T> vertical = vertical_part(crossing);
    T step = first_guess(crossing, height);
    const Rise<T> rise = solve(crossing, vertical.meets, step);
    const T inverse_u = 1.0 / rise.u;
    const T correction = (max(crossing.base + step, least<T>) - rise.u) * inverse_u;
    const T bend = 1.0 + T(0.5 * (exponent - 1)) * correction;
    T stress = T(yield_stress) + rise.value * (1.0 + T(exponent) * correction * bend);
    stress = where(vertical.meets, T(yield_stress) + min(height, vertical.rise), stress);
    stress = where(rise.found, stress, T(std::numeric_limits<RealOf<T>>::quiet_NaN()));
    const auto flowed = (near_u > T(0.0)) & (vertical.meets | (crossing.base > T(0.0)));
    HardeningPoint<T> end{where(flowed, near.plastic_strain, luders_strain), stress,
                          where(vertical.meets, 0.0, T(exponent) * rise.value * inverse_u),
                          where(flowed, near.rest, 0.0)};
    end.flow_by(step);
    return end;
  }

  template <class T>
  BRIO_INLINE VerticalPart<T> vertical_part(const Crossing<T>& crossing) const {
    VerticalPart<T> vertical{crossing.base < T(least<T>), crossing.base_rise};
    if (!any(vertical.meets & (crossing.excess > T(0.0)))) return vertical;
    vertical.rise = T(constant) * pow(T(least<T>), exponent);
    const T reach = crossing.stiffness * (T(least<T>) - crossing.base) + (vertical.rise - crossing.base_rise);
    vertical.meets = vertical.meets & (crossing.excess <= reach);
    return vertical;
  }

  /// Chebyshev's step towards a rise larger by `missing`, relative to u: Newton's step and at most as much
  /// again for the curvature.
  template <class T>
  BRIO_INLINE T relative_step(T missing, T stiffness, T u, T rise) const {
    const T hardening_part = T(exponent) * rise;
    const T inverse = 1.0 / (stiffness * u + hardening_part);
    const T newton = missing * inverse;
    return newton + newton * min(T(0.5 * (1 - exponent)) * (hardening_part * inverse) * newton, 1.0);
  }

  template <class T>
  BRIO_INLINE T first_guess(const Crossing<T>& crossing, T height) const {
    const T u = max(crossing.base, least<T>);
    const T relative = relative_step(crossing.excess, crossing.stiffness, u, crossing.base_rise);
    const T step = relative * u;
    const auto leaves = relative > T(0.5);
    if (!(constant > 0) || !any(leaves)) return step;
    return where(leaves, max(exp(log_of_crossing(crossing.stiffness, height)) - crossing.base, 0.0), step);
  }

  /// log(u), from the right within a few percent of u.
  template <class T>
  BRIO_INLINE T log_of_crossing(T stiffness, T height) const {
    T w = min(log(height / stiffness), T(1 / exponent) * log(height * T(1 / constant)));
    w = max(w, std::log(least<T>));
    for (int iteration = 0; iteration < 3; ++iteration) {
      const T linear = stiffness * exp(w);
      const T power = T(constant) * exp(T(exponent) * w);
      const T sum = linear + power;
      // 2 (sum - C) / (sum + C) stands below log(sum / C), so that the root is not overshot.
      w -= 2.0 * (sum - height) / (sum + height) * sum / (linear + T(exponent) * power);
    }
    return w;
  }

  /// Takes the step to the root, but for a change that a Taylor series from the rise returned covers. Comes
  /// to an end by far before most_iterations, unless the input is not a number.
  template <class T>
  BRIO_INLINE Rise<T> solve(const Crossing<T>& crossing, MaskOf<T> vertical, T& step) const {
    const T unbounded(std::numeric_limits<RealOf<T>>::max());
    T low = -crossing.base;
    T high = unbounded;
    const T inverse_base = 1.0 / max(crossing.base, least<T>);
    const MaskOf<T> has_series = vertical | (crossing.base >= T(least<T>));
    T u(least<T>), value(0.0);
    step = where(vertical, 0.0, step);
    MaskOf<T> found = vertical;
    for (int iteration = 0; iteration < most_iterations && !all(found); ++iteration) {
      u = max(crossing.base + step, least<T>);
      const T relative = step * inverse_base;
      if (all(has_series & (abs(relative) <= T(series_reach)))) {
        value = crossing.base_rise * binomial_series(relative);
      } else {
        value = T(constant) * pow(u, exponent);
      }
      const T missing = crossing.excess - crossing.stiffness * step - (value - crossing.base_rise);
      low = where(missing > T(0.0), step, low);
      high = where(missing > T(0.0), high, step);
      T next = step + u * relative_step(missing, crossing.stiffness, u, value);
      MaskOf<T> newton = (next >= low) & (next <= high);
      if (iteration >= newton_iterations) newton = newton & (high >= unbounded);
      next = where(newton, next, 0.5 * (low + high));
      next = where(found, step, next);
      found = found | (abs(next - step) <= near_enough<T> * u);
      step = next;
    }
    return {u, value, found};
  }
};

}  // namespace brio
