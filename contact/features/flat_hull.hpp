#pragma once
/// How flat the convex hull of a face is, and that of two faces at a side.

#include <array>
#include <limits>

#include "contact/geometry/number.hpp"

namespace brio {

/// Edges that end at a corner of a shape are not kept from the faces that they share it with. They pass over
/// what counts as no feature the lower the nearer the corner is to it: there the hull must be the thinner.
template <class T>
struct FlatHull {
  T thickness;
  /// How far every corner may move until the shape is folded: a quadrilateral that is not convex, two faces
  /// on one side of their common side; not positive: it is.
  T unfolded;
  /// How thin the hull must be, of what is asked of a square.
  T share;

  /// How far every corner may move until the hull is thicker than that, or nearly folded: what begins to be a
  /// feature must still be apart from the corners; negative: it is. Corners that move by d change the
  /// thickness by up to 2 d, and by less than 0.5 d what the share allows.
  T slack(T most) const { return min(T(0.4) * (most * min(share, T(1.0)) - thickness), unfolded - most); }
};

/// Of a quadrilateral: between both diagonals. An edge at one of its corners that is, where it ends or leaves
/// the face, by twice the hull of a square above it, passes over the diagonal; in others the hull is thinner
/// in the ratio of how near the corner is.
template <class T>
BRIO_INLINE FlatHull<T> flat_hull(const std::array<Vector3<T>, 4>& at) {
  const Vector3<T> a = at[2] - at[0], b = at[3] - at[1], across = cross(a, b);
  const T squared = dot(across, across);
  const MaskOf<T> has_area = squared > T(0.0);
  const T inverse = T(1.0) / sqrt(where(has_area, squared, T(1.0)));
  // Of each corner from the other diagonal, in the mean plane.
  const auto beside = [&](const Vector3<T>& diagonal, const Vector3<T>& arm) {
    return dot(cross(diagonal, arm), across) * (inverse / sqrt(dot(diagonal, diagonal)));
  };
  const T unfolded = min(min(beside(a, at[3] - at[0]), -beside(a, at[1] - at[0])),
                         min(beside(b, at[0] - at[1]), -beside(b, at[2] - at[1])));
  const T longest = where(has_area, sqrt(max(dot(a, a), dot(b, b))), T(1.0));
  return {magnitude(dot(at[1] - at[0], across)) * inverse, where(has_area, T(0.25) * unfolded, T(-1.0)),
          T(2.0) * unfolded / longest};
}

/// Of two faces at a side: its ends, then the other corners of either face, of a triangle the same twice. In
/// the plane along the side and between the middles of what lies beyond it. Edges at its corners are not
/// longer than the narrower face is wide.
template <class T>
BRIO_INLINE FlatHull<T> flat_hull(const std::array<Vector3<T>, 6>& at) {
  const Vector3<T> along = at[1] - at[0], across = T(0.5) * ((at[4] + at[5]) - (at[2] + at[3])),
                   normal = cross(across, along);
  const T squared = dot(normal, normal);
  const MaskOf<T> has_area = squared > T(0.0);
  const T inverse = T(1.0) / sqrt(where(has_area, squared, T(1.0)));
  const Vector3<T> outward = (inverse / sqrt(dot(along, along))) * cross(along, normal);
  T lowest(0.0), highest(0.0), unfolded(std::numeric_limits<double>::infinity()), sum(0.0);
  for (std::size_t k = 2; k < 6; ++k) {
    const Vector3<T> arm = at[k] - at[0];
    const T height = dot(arm, normal), beyond = dot(arm, outward);
    lowest = min(lowest, height);
    highest = max(highest, height);
    const T distance = k < 4 ? -beyond : beyond;
    unfolded = min(unfolded, distance);
    sum = sum + distance;
  }
  const MaskOf<T> is_wide = sum > T(0.0);
  return {(highest - lowest) * inverse, where(has_area, T(0.25) * unfolded, T(-1.0)),
          T(16.0) * unfolded / where(is_wide, sum, T(1.0))};
}

}  // namespace brio
