#pragma once
/// The cubic B-spline in three dimensions (Monaghan & Lattanzio 1985), and moments of neighbourhoods.

#include <cmath>
#include <numbers>

#include "elements/particle/particle_pairs.hpp"
#include "src/base/index.hpp"
#include "src/base/lane_math.hpp"

namespace brio {

/// W(r) h^3 pi at r / h.
template <class T>
BRIO_INLINE T kernel_shape(T q) {
  const T near = 1.0 + q * q * (0.75 * q - 1.5);
  const T rest = 2.0 - q;
  return where(q < T(1.0), near, where(q < T(2.0), 0.25 * rest * rest * rest, T(0.0)));
}

/// 1 / r, a large number where r = 0.
template <class T>
BRIO_INLINE T inverse_distance(T distance_squared) {
  constexpr double hardly_apart = 1e-290;
  return inverse_square_root(max(distance_squared, hardly_apart));
}

/// -W'(r) / r. \param length h
template <class T>
BRIO_INLINE T kernel_weight(T distance_squared, T length) {
  const T inverse_length = 1.0 / length;
  const T inverse = inverse_distance(distance_squared);
  const T q = distance_squared * inverse * inverse_length;
  const T rest = 2.0 - q;
  const T inverse_squared = inverse_length * inverse_length;
  const T size = std::numbers::inv_pi * inverse_squared * inverse_squared * inverse_length;
  const T shape = where(q < T(1.0), 3.0 - 2.25 * q, 0.75 * rest * rest * (length * inverse));
  return where(q < T(2.0), size * shape, T(0.0));
}

/// A neighbourhood whose moments have a determinant below this share of that of a round one lies in a plane
/// or on a line.
inline constexpr double least_roundness = 1e-6;

/// The inverse times the determinant.
template <class T>
BRIO_INLINE SymmetricTensor<T> adjugate(const SymmetricTensor<T>& m) {
  return {m.yy * m.zz - m.yz * m.yz, m.xx * m.zz - m.xz * m.xz, m.xx * m.yy - m.xy * m.xy,
          m.xz * m.yz - m.xy * m.zz, m.xy * m.xz - m.yz * m.xx, m.xy * m.yz - m.xz * m.yy};
}

/// The inverse; 0 where the neighbours do not stand in three directions.
template <class T>
BRIO_INLINE SymmetricTensor<T> inverse_moments(const SymmetricTensor<T>& m) {
  const SymmetricTensor<T> cofactor = adjugate(m);
  const T determinant = m.xx * cofactor.xx + m.xy * cofactor.xy + m.xz * cofactor.xz;
  const T mean = trace(m) / 3.0;
  const MaskOf<T> is_round = determinant > least_roundness * mean * mean * mean;
  const T inverse = where(is_round, 1.0 / where(is_round, determinant, T(1.0)), T(0.0));
  return inverse * cofactor;
}

/// Fills the lanes behind the first `count` with the last of these.
inline void repeat_last_lane(NeighbourSums& sums, int count) {
  constexpr std::size_t width = lane_count<double>;
  auto* number = reinterpret_cast<double*>(&sums);  // nothing but numbers by lanes
  for (std::size_t row = 0; row < sizeof(NeighbourSums) / sizeof(double); row += width)
    for (auto lane = index(count); lane < width; ++lane) number[row + lane] = number[row + index(count) - 1];
}

}  // namespace brio
