#pragma once
/// Closest points of two segments.
///
/// Inside both, the feet of the common perpendicular are found by projections, as in the triangle: what one
/// segment has at right angles to the other, and the offset as seen along it. So their distance is right to
/// rounding at any angle, with no normal and nothing refined. It is done with either segment as the first and
/// the mean is taken: then a and b can change places.

#include "contact/geometry/segment_foot.hpp"

namespace brio {

template <class T>
struct ClosestOnSegments {
  T on_a, on_b;       ///< parameters: 0 at the first end, 1 at the second
  Vector3<T> offset;  ///< point of a minus point of b
  T squared_distance;
  MaskOf<T> parallel;  ///< but for rounding, or one of them is a point
};

template <class T>
BRIO_INLINE ClosestOnSegments<T> where(MaskOf<T> condition, const ClosestOnSegments<T>& p,
                                       const ClosestOnSegments<T>& q) {
  return {where(condition, p.on_a, q.on_a), where(condition, p.on_b, q.on_b),
          where<T>(condition, p.offset, q.offset), where(condition, p.squared_distance, q.squared_distance),
          p.parallel};
}

/// The differences of two segments; all are negatives of each other, or exchanged, if a and b change places.
template <class T>
struct SegmentDifferences {
  Vector3<T> a0_b0, a0_b1, a1_b0, a1_b1;  ///< end of a minus end of b
  Vector3<T> along_a, along_b;            ///< second minus first end
  T square_a = dot(along_a, along_a), square_b = dot(along_b, along_b);
  T inverse_a = inverse_or_zero(square_a), inverse_b = inverse_or_zero(square_b);
};

template <class T>
BRIO_INLINE ClosestOnSegments<T> points_at(const SegmentDifferences<T>& d, T on_a, T on_b,
                                           MaskOf<T> parallel) {
  const Vector3<T> offset = d.a0_b0 + (on_a * d.along_a - on_b * d.along_b);
  return {on_a, on_b, offset, dot(offset, offset), parallel};
}

/// The nearer of two; of two equally near the mean, which is no farther, the distance being convex.
template <class T>
BRIO_INLINE ClosestOnSegments<T> nearer(const ClosestOnSegments<T>& p, const ClosestOnSegments<T>& q) {
  ClosestOnSegments<T> best = where<T>(q.squared_distance < p.squared_distance, q, p);
  const MaskOf<T> is_equal = q.squared_distance == p.squared_distance;
  best.on_a = where(is_equal, T(0.5) * (p.on_a + q.on_a), best.on_a);
  best.on_b = where(is_equal, T(0.5) * (p.on_b + q.on_b), best.on_b);
  best.offset = where<T>(is_equal, T(0.5) * (p.offset + q.offset), best.offset);
  return best;
}

/// Parameters of the common perpendicular, found with `along` as the base.
template <class T>
struct CommonPerpendicular {
  T on_base, on_other;
  T square;  ///< of what the other segment has at right angles to the base
};

/// `between` is the first end of the base minus that of the other.
template <class T>
BRIO_INLINE CommonPerpendicular<T> common_perpendicular(const Vector3<T>& between, const Vector3<T>& base,
                                                        T inverse_square, const Vector3<T>& other,
                                                        T product) {
  const T lean = product * inverse_square;
  const Vector3<T> across = other - lean * base;
  const T shift = dot(between, base) * inverse_square;
  const Vector3<T> rest = between - shift * base;
  const T square = dot(across, across);
  const T on_other = dot(rest, across) * inverse_or_zero(square);
  return {on_other * lean - shift, on_other, square};
}

template <class T>
BRIO_INLINE MaskOf<T> is_within_unit(T a) {
  return (a > T(0.0)) & (a < T(1.0));
}

/// In roundings: segments whose directions differ by less are parallel, and distances that differ by less are
/// the same for them.
inline constexpr double parallel_resolution = 8;

/// Every end against the other segment.
template <class T>
struct FeetOfEnds {
  ClosestOnSegments<T> a0, a1, b0, b1;
};

template <class T>
BRIO_INLINE FeetOfEnds<T> feet_of_ends(const SegmentDifferences<T>& d, MaskOf<T> parallel) {
  const auto of_a = [&](double end, const Vector3<T>& from_first, const Vector3<T>& from_second) {
    const SegmentFoot<T> foot = segment_foot(from_first, from_second, d.along_b, d.inverse_b);
    return ClosestOnSegments<T>{T(end), foot.share, foot.offset, foot.squared_distance, parallel};
  };
  const auto of_b = [&](double end, const Vector3<T>& from_first, const Vector3<T>& from_second) {
    const T minus(-1.0);
    const SegmentFoot<T> foot = segment_foot(minus * from_first, minus * from_second, d.along_a, d.inverse_a);
    return ClosestOnSegments<T>{foot.share, T(end), minus * foot.offset, foot.squared_distance, parallel};
  };
  return {of_a(0, d.a0_b0, d.a0_b1), of_a(1, d.a1_b0, d.a1_b1), of_b(0, d.a0_b0, d.a1_b0),
          of_b(1, d.a0_b1, d.a1_b1)};
}

/// The middle of those feet that are as near as the nearest. \param is_inside of both segments
template <class T>
BRIO_INLINE ClosestOnSegments<T> middle_of_shared(const SegmentDifferences<T>& d, const FeetOfEnds<T>& feet,
                                                  const ClosestOnSegments<T>& best, MaskOf<T>& is_inside) {
  const T nearest = sqrt(best.squared_distance);
  const T lengths = sqrt(d.square_a) + sqrt(d.square_b);
  const T limit = nearest + T(parallel_resolution * unit_roundoff) * (nearest + lengths);
  const T limit_squared = limit * limit;
  T least_a = best.on_a;
  T least_b = best.on_b;
  T greatest_a = best.on_a;
  T greatest_b = best.on_b;
  const auto include = [&](const ClosestOnSegments<T>& foot) {
    const MaskOf<T> is_near = foot.squared_distance <= limit_squared;
    least_a = where(is_near, min(least_a, foot.on_a), least_a);
    least_b = where(is_near, min(least_b, foot.on_b), least_b);
    greatest_a = where(is_near, max(greatest_a, foot.on_a), greatest_a);
    greatest_b = where(is_near, max(greatest_b, foot.on_b), greatest_b);
  };
  include(feet.a0);
  include(feet.a1);
  include(feet.b0);
  include(feet.b1);
  const T on_a = T(0.5) * (least_a + greatest_a);
  const T on_b = T(0.5) * (least_b + greatest_b);
  is_inside = is_within_unit(on_a) & is_within_unit(on_b);
  return points_at<T>(d, on_a, on_b, best.parallel);
}

/// The closest points, within a few roundings of the distances and lengths involved; also of parallel
/// segments, which meet in the middle of what they share, and of such without length, which are points. If a
/// and b change places, so do the results, to the bit.
template <class T>
BRIO_INLINE ClosestOnSegments<T> closest_on_segments(const SegmentDifferences<T>& d) {
  const T product = dot(d.along_a, d.along_b);
  const CommonPerpendicular<T> by_a =
      common_perpendicular(d.a0_b0, d.along_a, d.inverse_a, d.along_b, product);
  const CommonPerpendicular<T> by_b =
      common_perpendicular(T(-1.0) * d.a0_b0, d.along_b, d.inverse_b, d.along_a, product);
  constexpr double sine = parallel_resolution * unit_roundoff;
  const MaskOf<T> is_parallel =
      !(by_a.square * d.square_a + by_b.square * d.square_b > T(2 * sine * sine) * (d.square_a * d.square_b));

  const FeetOfEnds<T> feet = feet_of_ends<T>(d, is_parallel);
  ClosestOnSegments<T> best = nearer(nearer(feet.a0, feet.a1), nearer(feet.b0, feet.b1));
  best.squared_distance = dot(best.offset, best.offset);  // also of means
  const MaskOf<T> is_inside = is_within_unit(by_a.on_base) & is_within_unit(by_a.on_other) &
                              is_within_unit(by_b.on_base) & is_within_unit(by_b.on_other);
  const ClosestOnSegments<T> inside = points_at<T>(d, T(0.5) * (by_a.on_base + by_b.on_other),
                                                   T(0.5) * (by_a.on_other + by_b.on_base), is_parallel);
  const MaskOf<T> is_inside_best =
      (!is_parallel) & is_inside & (inside.squared_distance <= best.squared_distance);
  const ClosestOnSegments<T> crossing = where<T>(is_inside_best, inside, best);
  MaskOf<T> is_shared;
  const ClosestOnSegments<T> middle = middle_of_shared(d, feet, best, is_shared);
  return where<T>(is_parallel & is_shared, middle, crossing);
}
template <class T>
BRIO_INLINE ClosestOnSegments<T> closest_on_segments(const Vector3<T>& a0, const Vector3<T>& a1,
                                                     const Vector3<T>& b0, const Vector3<T>& b1) {
  return closest_on_segments(SegmentDifferences<T>{a0 - b0, a0 - b1, a1 - b0, a1 - b1, a1 - a0, b1 - b0});
}

}  // namespace brio
