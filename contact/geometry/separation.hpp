#pragma once
/// Separating plane of two features over a time step: along a direction d every point of one stays above
/// every point of the other. Points move linearly, so heights are linear in time, and what is positive at
/// both ends of the step is positive all the while; so are the heights of every point of the hulls.

#include <array>

#include "contact/geometry/number.hpp"

namespace brio {

/// Least height of the first feature minus the greatest of the second, times |d|, at the step's start and
/// end. The true values are greater than `start` - `bound` and `end` - `bound`.
template <class T>
struct StepSeparation {
  T start, end;
  T bound;

  /// Surely never nearer than the distance whose product with |d| is given (rounded up).
  BRIO_INLINE MaskOf<T> exceeds(T distance_times_length) const {
    return min(start, end) > distance_times_length + bound;
  }
  BRIO_INLINE MaskOf<T> is_certain() const { return min(start, end) > bound; }
};

/// Rounding of a separation along d whose points are, by component, within `extent` of the first point of the
/// second feature, at either end of the step: 12 units of |d_x| extent_x + |d_y| extent_y + |d_z| extent_z.
/// (A height has the rounding of a difference, a product and two sums, 4 units of it; there are two, and
/// their difference: 10.) The constant is for numbers so small that products lose digits.
template <class T>
BRIO_INLINE T separation_bound(const Vector3<T>& d, const Vector3<T>& extent) {
  const T height = magnitude(d.x) * extent.x + magnitude(d.y) * extent.y + magnitude(d.z) * extent.z;
  return T(12 * unit_roundoff) * height + T(0x1p-1000);
}

/// At one time; heights are taken over the first point of the second feature, so that the distance from the
/// origin is no matter.
template <class T, std::size_t N, std::size_t M>
BRIO_INLINE T height_between(const Vector3<T>& d, const std::array<Vector3<T>, N>& first,
                             const std::array<Vector3<T>, M>& second) {
  T least = dot(d, first[0] - second[0]);
#pragma GCC unroll 8
  for (std::size_t k = 1; k < N; ++k) least = min(least, dot(d, first[k] - second[0]));
  T greatest(0.0);
#pragma GCC unroll 8
  for (std::size_t k = 1; k < M; ++k) greatest = max(greatest, dot(d, second[k] - second[0]));
  return least - greatest;
}

/// Grows to hold the differences that heights are taken of.
template <class T, std::size_t N, std::size_t M>
BRIO_INLINE void include(Vector3<T>& extent, const std::array<Vector3<T>, N>& first,
                         const std::array<Vector3<T>, M>& second) {
  const auto include_one = [&](const Vector3<T>& difference) {
    extent.x = max(extent.x, magnitude(difference.x));
    extent.y = max(extent.y, magnitude(difference.y));
    extent.z = max(extent.z, magnitude(difference.z));
  };
#pragma GCC unroll 8
  for (std::size_t k = 0; k < N; ++k) include_one(first[k] - second[0]);
#pragma GCC unroll 8
  for (std::size_t k = 1; k < M; ++k) include_one(second[k] - second[0]);
}

/// Of any two features, by the positions of their points at the start and the end of the step. d need not
/// have unit length; a direction kept in single precision is widened, nothing is lost. This one takes the
/// extent as known: a pair that a search has found is no larger than two of its boxes.
template <class T, std::size_t N, std::size_t M>
BRIO_INLINE StepSeparation<T> separation_within(const Vector3<T>& extent, const Vector3<T>& d,
                                                const std::array<Vector3<T>, N>& first_start,
                                                const std::array<Vector3<T>, N>& first_end,
                                                const std::array<Vector3<T>, M>& second_start,
                                                const std::array<Vector3<T>, M>& second_end) {
  return {height_between(d, first_start, second_start), height_between(d, first_end, second_end),
          separation_bound(d, extent)};
}

/// The same with the extent found from the points.
template <class T, std::size_t N, std::size_t M>
BRIO_INLINE StepSeparation<T> separation(const Vector3<T>& d, const std::array<Vector3<T>, N>& first_start,
                                         const std::array<Vector3<T>, N>& first_end,
                                         const std::array<Vector3<T>, M>& second_start,
                                         const std::array<Vector3<T>, M>& second_end) {
  Vector3<T> extent{T(0.0), T(0.0), T(0.0)};
  include(extent, first_start, second_start);
  include(extent, first_end, second_end);
  return separation_within(extent, d, first_start, first_end, second_start, second_end);
}

/// A node over the hull of a face: d points from face to node.
template <class T>
BRIO_INLINE StepSeparation<T> separation(const Vector3<T>& d, const Vector3<T>& node_start,
                                         const Vector3<T>& node_end,
                                         const std::array<Vector3<T>, 4>& face_start,
                                         const std::array<Vector3<T>, 4>& face_end) {
  return separation<T, 1, 4>(d, {node_start}, {node_end}, face_start, face_end);
}

}  // namespace brio
