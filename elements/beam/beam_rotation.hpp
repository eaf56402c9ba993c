#pragma once
/// Rotations of the ends of a beam as unit quaternions, on lanes.

#include "elements/base/quaternion.hpp"

namespace brio {

/// Largest square of half a turn within which the series of `turned` hold: a step does not turn a node by
/// more than three radians.
inline constexpr double largest_half_turn_square = 2.25;

/// q after a turn by the vector `turn` in space. Scaled back to unit length, from which it is round-off away.
template <class T>
BRIO_INLINE Quaternion<T> turned(const Vector3<T>& turn, const Quaternion<T>& q) {
  const T x = 0.25 * dot(turn, turn);
  // sin(a) / a and cos(a) for a^2 = x, by Horner's scheme
  T sine(1.0), cosine(1.0);
#pragma GCC unroll 10
  for (int k = 10; k >= 1; --k) {
    sine = 1.0 - x * sine * (1.0 / (2 * k * (2 * k + 1)));
    cosine = 1.0 - x * cosine * (1.0 / (2 * k * (2 * k - 1)));
  }
  const T half = 0.5 * sine;
  const Quaternion<T> end = Quaternion<T>{cosine, half * turn.x, half * turn.y, half * turn.z} * q;
  return scaled(1.5 - 0.5 * squared_length(end), end);
}

/// The rotation halfway between two that are less than a turn apart.
template <class T>
BRIO_INLINE Quaternion<T> middle_of(const Quaternion<T>& a, const Quaternion<T>& b) {
  const Quaternion<T> sum{a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
  return scaled(1.0 / sqrt(max(squared_length(sum), 1e-30)), sum);
}

/// The quaternion of a right-handed triad.
template <class T>
BRIO_INLINE Quaternion<T> quaternion_of(const Vector3<T>& e1, const Vector3<T>& e2, const Vector3<T>& e3) {
  // Each is four times the square of a component; the largest is used.
  const T w = 1.0 + e1.x + e2.y + e3.z;
  const T x = 1.0 + e1.x - e2.y - e3.z;
  const T y = 1.0 - e1.x + e2.y - e3.z;
  const T z = 1.0 - e1.x - e2.y + e3.z;
  const T yz = e2.z + e3.y, zx = e3.x + e1.z, xy = e1.y + e2.x;
  const T wx = e2.z - e3.y, wy = e3.x - e1.z, wz = e1.y - e2.x;
  T largest = w;
  Quaternion<T> q{w, wx, wy, wz};
  const auto choose = [&](const T& size, const Quaternion<T>& other) {
    const auto is_larger = size > largest;
    largest = where(is_larger, size, largest);
    q.w = where(is_larger, other.w, q.w);
    q.x = where(is_larger, other.x, q.x);
    q.y = where(is_larger, other.y, q.y);
    q.z = where(is_larger, other.z, q.z);
  };
  choose(x, {wx, x, xy, zx});
  choose(y, {wy, xy, y, yz});
  choose(z, {wz, zx, yz, z});
  return scaled(0.5 / sqrt(largest), q);
}

/// a / sin(a) for the angle a in [0, pi/2] whose cosine is given.
template <class T>
BRIO_INLINE T angle_over_sine(const T& cosine) {
  // tan(a/2)^2, then of a quarter and an eighth of a, where the series of the arc tangent is short.
  const T half = max(1.0 - cosine, 0.0) / (1.0 + cosine);
  const T first = 1.0 + sqrt(1.0 + half);
  const T quarter = half / square(first);
  const T second = 1.0 + sqrt(1.0 + quarter);
  const T eighth = quarter / square(second);
  T series(1.0 / 25);
#pragma GCC unroll 12
  for (int k = 11; k >= 0; --k) series = 1.0 / (2 * k + 1) - eighth * series;
  return 4.0 * series * (1.0 + half) / (first * second);
}

}  // namespace brio
