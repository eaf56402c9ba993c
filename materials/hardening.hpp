#pragma once
/// The yield stress as a function of the equivalent plastic strain. A hardening law is a small struct that
/// provides
///
///     HardeningPoint<T> at(T plastic_strain) const;  // also at(plastic_strain, rest) if histories keep that
///     HardeningPoint<T> meet(HardeningPoint<T> near, T effective_stress, T stiffness) const;
///     double initial_yield_stress() const;
///
/// `meet` is the point where the hardening curve crosses the falling line
///
///     q(p) = effective_stress - stiffness (p - near.plastic_strain)
///
/// on which elastic unloading by plastic flow takes the effective stress: the solution of the consistency
/// condition of a radial return; its stress is NaN if none is found. The line starts on or above the curve,
/// but for the last digits; stiffness > 0. Everything that flows (solids, shells, fibres) is written on these
/// three. `static constexpr HardeningShape shape` says how much more plane stress may ask of the curve
/// (plane_stress_flow.hpp): nothing of one that is straight or any; of one that has tangents also
///
///     HardeningPoint<T> along(HardeningPoint<T> near, T distance) const;        // cheaper than at()
///     T curvature(HardeningPoint<T>) const;                                     // second derivative
///     mask is_concave_from(HardeningPoint<T>) const;
///     mask has_tangent_over(HardeningPoint<T>, T distance) const;               // that is near the curve
///     mask bends(HardeningPoint<T>, T distance) const;                          // visibly, for round-off
///
/// and of one of straight pieces
///
///     T end_of_piece(HardeningPoint<T>) const;     // plastic strain up to which it is straight from a point

#include "src/base/lanes.hpp"

namespace brio {

enum class HardeningShape {
  any,
  straight,
  has_tangents,       ///< with the members above
  piecewise_straight  ///< with end_of_piece
};

template <class T>
struct HardeningPoint {
  T plastic_strain;  ///< equivalent plastic strain p, -
  T stress;          ///< yield stress at p + rest
  T slope;           ///< of the yield stress
  T rest{};          ///< plastic strain below the last digit of p; 0 in laws that do not keep it

  /// Adds plastic strain and keeps what the sum leaves off (two-sum of Knuth, The Art of Computer Programming
  /// 2, 4.2.2).
  BRIO_INLINE void flow_by(T increment) {
    const T small = rest + increment;
    const T sum = plastic_strain + small;
    const T added = sum - plastic_strain;
    rest = (plastic_strain - (sum - added)) + (small - added);
    plastic_strain = sum;
  }
};

/// Plastic strain from `start` to `end`.
template <class T>
BRIO_INLINE T flow_between(const HardeningPoint<T>& start, const HardeningPoint<T>& end) {
  return (end.plastic_strain - start.plastic_strain) + (end.rest - start.rest);
}

/// Histories that keep the plastic strain as a sum of two numbers: the second is what does not fit into the
/// digits of the first. Where the curve is steep, stress needs it; and many small steps do.
template <class History>
inline constexpr bool keeps_rest = requires(History history) {
  history.plastic_strain_rest;
};

/// The point of a curve at which a history stands.
template <class Hardening, class History>
BRIO_INLINE auto point_of(const Hardening& hardening, const History& history) {
  if constexpr (keeps_rest<History>) {
    return hardening.at(history.equivalent_plastic_strain, history.plastic_strain_rest);
  } else {
    return hardening.at(history.equivalent_plastic_strain);
  }
}

/// yield_stress + modulus p
struct LinearHardening {
  double yield_stress;
  double modulus;  ///< d(yield stress)/dp >= 0
  static constexpr HardeningShape shape = HardeningShape::straight;

  double initial_yield_stress() const { return yield_stress; }

  template <class T>
  BRIO_INLINE HardeningPoint<T> at(T plastic_strain) const {
    return {plastic_strain, T(yield_stress) + T(modulus) * plastic_strain, T(modulus)};
  }

  template <class T>
  BRIO_INLINE HardeningPoint<T> meet(HardeningPoint<T> near, T effective_stress, T stiffness) const {
    return at(near.plastic_strain + (effective_stress - near.stress) / (stiffness + T(modulus)));
  }
};

}  // namespace brio
