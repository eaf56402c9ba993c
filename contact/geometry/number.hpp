#pragma once
/// What the kernels of this folder share: choices between vectors, inverses that are never infinite, and the
/// size by which rounding is judged. A kernel is written once on T: plain `double`, or `Lanes<double>`, eight
/// numbers side by side; both give the same bits.

#include "src/base/floating_point.hpp"
#include "src/base/tensor.hpp"

namespace brio {

template <class T>
BRIO_INLINE Vector3<T> where(MaskOf<T> condition, const Vector3<T>& a, const Vector3<T>& b) {
  return {where(condition, a.x, b.x), where(condition, a.y, b.y), where(condition, a.z, b.z)};
}

/// Squares of lengths below this one are those of a point: their inverses would not be numbers.
inline constexpr double least_square = 0x1p-900;

template <class T>
BRIO_INLINE T inverse_or_zero(T a) {
  const MaskOf<T> is_regular = a > T(least_square);
  return where(is_regular, T(1.0) / where(is_regular, a, T(1.0)), T(0.0));
}

template <class T>
BRIO_INLINE T clamp_to_unit(T a) {
  return min(max(a, T(0.0)), T(1.0));
}

template <class T>
BRIO_INLINE T magnitude(T a) {
  return max(a, -a);
}

/// The largest component, without its sign.
template <class T>
BRIO_INLINE T largest_magnitude(const Vector3<T>& a) {
  return max(max(magnitude(a.x), magnitude(a.y)), magnitude(a.z));
}

}  // namespace brio
