#pragma once
/// Closest point of a triangle to a node.
///
/// The foot of the perpendicular is found by two projections: on the line of one edge, the base, and, of what
/// is left, on the altitude of the third vertex over it. Each carries the rounding of the lengths it is made
/// of, whatever the shape: in a sliver of height h and length L the altitude's direction is good to L / h
/// roundings, which turns the offset by as much, but the distance only by the square of it, and never by more
/// than a few roundings of L, because the foot stays in the sliver. No normal is formed, and nothing refined.

#include <array>

#include "contact/geometry/segment_foot.hpp"

namespace brio {

template <class T>
struct ClosestOnTriangle {
  Vector3<T> offset;         ///< node minus closest point
  std::array<T, 3> weights;  ///< of the vertices: none negative, their sum is 1
  T squared_distance;
};

/// An edge as the base of triangles, and the node's projection on its line.
template <class T>
struct TriangleBase {
  Vector3<T> along;  ///< second minus first vertex
  T inverse_square;
  T share;          ///< of the projection: 0 at the first vertex, 1 at the second, not limited to them
  Vector3<T> rest;  ///< node minus projection
};

template <class T>
BRIO_INLINE TriangleBase<T> triangle_base(const Vector3<T>& from_first, const Vector3<T>& along,
                                          T inverse_square) {
  const T share = dot(from_first, along) * inverse_square;
  return {along, inverse_square, share, from_first - share * along};
}

/// The foot of the perpendicular on the plane of the triangle, where it falls inside.
template <class T>
struct PlaneFoot {
  MaskOf<T> is_inside;  ///< strictly; in other lanes the rest is without meaning, though finite
  Vector3<T> offset;
  T first, second, third;  ///< weights: the two vertices of the base, and that over it
  T squared_distance;
};

/// `side` is the third vertex minus the first of the base.
template <class T>
BRIO_INLINE PlaneFoot<T> plane_foot(const TriangleBase<T>& base, const Vector3<T>& side) {
  const T lean = dot(side, base.along) * base.inverse_square;
  const Vector3<T> altitude = side - lean * base.along;
  const T inverse_square = inverse_or_zero(dot(altitude, altitude));
  PlaneFoot<T> foot;
  foot.third = clamp_to_unit(dot(base.rest, altitude) * inverse_square);
  foot.second = base.share - foot.third * lean;
  foot.first = (T(1.0) - foot.third) - foot.second;
  foot.is_inside =
      (foot.third > T(0.0)) & (foot.second > T(0.0)) & (foot.first > T(0.0)) & (base.inverse_square > T(0.0));
  foot.offset = base.rest - foot.third * altitude;
  foot.squared_distance = dot(foot.offset, foot.offset);
  return foot;
}

/// Any triangle: slivers and such without area are segments or points, to rounding. Of the distances involved
/// the offset's length is right to a few roundings; the weights give the point as well as the offset does.
template <class T>
BRIO_INLINE ClosestOnTriangle<T> closest_on_triangle(const Vector3<T>& node, const Vector3<T>& a,
                                                     const Vector3<T>& b, const Vector3<T>& c) {
  const Vector3<T> from_a = node - a;
  const Vector3<T> from_b = node - b;
  const Vector3<T> from_c = node - c;
  const Vector3<T> ab = b - a;
  const Vector3<T> ac = c - a;
  const Vector3<T> bc = c - b;
  const T inverse_ab = inverse_or_zero(dot(ab, ab));
  const SegmentFoot<T> on_ab = segment_foot(from_a, from_b, ab, inverse_ab);
  const SegmentFoot<T> on_ac = segment_foot(from_a, from_c, ac, inverse_or_zero(dot(ac, ac)));
  const SegmentFoot<T> on_bc = segment_foot(from_b, from_c, bc, inverse_or_zero(dot(bc, bc)));
  const PlaneFoot<T> inside = plane_foot(triangle_base(from_a, ab, inverse_ab), ac);

  ClosestOnTriangle<T> best{
      on_ab.offset, {T(1.0) - on_ab.share, on_ab.share, T(0.0)}, on_ab.squared_distance};
  const auto take = [&](MaskOf<T> chosen, const Vector3<T>& offset, T wa, T wb, T wc, T squared_distance) {
    best.offset = where<T>(chosen, offset, best.offset);
    best.weights[0] = where(chosen, wa, best.weights[0]);
    best.weights[1] = where(chosen, wb, best.weights[1]);
    best.weights[2] = where(chosen, wc, best.weights[2]);
    best.squared_distance = where(chosen, squared_distance, best.squared_distance);
  };
  take(on_ac.squared_distance < best.squared_distance, on_ac.offset, T(1.0) - on_ac.share, T(0.0),
       on_ac.share, on_ac.squared_distance);
  take(on_bc.squared_distance < best.squared_distance, on_bc.offset, T(0.0), T(1.0) - on_bc.share,
       on_bc.share, on_bc.squared_distance);
  take(inside.is_inside & (inside.squared_distance < best.squared_distance), inside.offset, inside.first,
       inside.second, inside.third, inside.squared_distance);
  return best;
}

}  // namespace brio
