#pragma once
/// Closest point of a segment to a node.

#include "contact/geometry/number.hpp"

namespace brio {

template <class T>
struct SegmentFoot {
  Vector3<T> offset;   ///< node minus closest point; exactly node minus end where that is the closest
  T share;             ///< 0 at the first end, 1 at the second
  T squared_distance;  ///< |offset|^2
};

/// From the differences alone: node minus first and second end, second minus first end, and the inverse of
/// its square (zero for a segment that is a point).
template <class T>
BRIO_INLINE SegmentFoot<T> segment_foot(const Vector3<T>& from_first, const Vector3<T>& from_second,
                                        const Vector3<T>& along, T inverse_square) {
  SegmentFoot<T> foot;
  foot.share = clamp_to_unit(dot(from_first, along) * inverse_square);
  // From the nearer end, so that the foot carries the rounding of its own small distance to it.
  const MaskOf<T> is_second = foot.share > T(0.5);
  const T beyond = where(is_second, foot.share - T(1.0), foot.share);
  foot.offset = where<T>(is_second, from_second, from_first) - beyond * along;
  foot.squared_distance = dot(foot.offset, foot.offset);
  return foot;
}

}  // namespace brio
