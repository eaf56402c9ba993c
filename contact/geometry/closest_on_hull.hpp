#pragma once
/// Closest point of the convex hull of a face's four vertices to a node: the nearest of the triangles
/// (0,1,2), (0,2,3), (0,1,3), (1,2,3). The hull holds either triangulation of the face, so a node that stays
/// outside of it crosses neither, and it favours no diagonal, so mirror images are mirror images.
///
/// **Weights.** The point of a face that is not flat has one set of weights only, those of the triangle it
/// lies on. On a flat face each inner point lies on one triangle of either triangulation, and every mean of
/// the two sets of weights gives it. There the mean is taken that makes w0 w2 = w1 w3, which are the face's
/// own bilinear shape functions at the point: smooth inside, linear along the sides, and the same whatever
/// the order in which the face lists its vertices. Flat is a face whose two sheets, seen from the node, are
/// within `flatness` of each other, and not less than 16 roundings of the coordinates; up to twice as much
/// the mean passes over linearly into the weights of the nearer sheet. So sum w_k x_k is the closest point to
/// a few roundings, or within twice the flatness: along the offset, and across it by no more than the angle
/// between the sheets times the distance. (With a flatness, forces along node minus sum w_k x_k leave angular
/// momentum alone; such along the offset do but for the part across.)

#include "contact/geometry/closest_on_triangle.hpp"
#include "src/base/index.hpp"

namespace brio {

template <class T>
struct ClosestOnHull {
  Vector3<T> offset;         ///< node minus closest point; of a node inside: from the nearest triangle
  std::array<T, 4> weights;  ///< of the vertices: none negative, their sum is 1; a repeated one has none
  T squared_distance;        ///< |offset|^2; 0 inside
  MaskOf<T> inside;          ///< surely inside: beyond rounding
};

/// A point of the hull and its weights.
template <class T>
struct HullFoot {
  Vector3<T> offset;
  std::array<T, 4> weights;
  T squared_distance;
};

template <class T>
BRIO_INLINE HullFoot<T> where(MaskOf<T> condition, const HullFoot<T>& a, const HullFoot<T>& b) {
  return {where<T>(condition, a.offset, b.offset),
          {where(condition, a.weights[0], b.weights[0]), where(condition, a.weights[1], b.weights[1]),
           where(condition, a.weights[2], b.weights[2]), where(condition, a.weights[3], b.weights[3])},
          where(condition, a.squared_distance, b.squared_distance)};
}

template <class T>
BRIO_INLINE HullFoot<T> nearer(const HullFoot<T>& a, const HullFoot<T>& b) {
  return where<T>(b.squared_distance < a.squared_distance, b, a);
}

/// (1 - share) a + share b of the weights.
template <class T>
BRIO_INLINE std::array<T, 4> mean_weights(const std::array<T, 4>& a, const std::array<T, 4>& b, T share) {
  const T rest = T(1.0) - share;
  return {rest * a[0] + share * b[0], rest * a[1] + share * b[1], rest * a[2] + share * b[2],
          rest * a[3] + share * b[3]};
}

/// The share of b in the mean of two sets of weights of one point that makes w0 w2 = w1 w3. `a` are those on
/// the diagonal 0-2, where w1 or w3 is zero, `b` those on the other, where w0 or w2 is: the difference of the
/// products is not negative at a and not positive at b, and vanishes once between.
template <class T>
BRIO_INLINE T bilinear_share(const std::array<T, 4>& a, const std::array<T, 4>& b) {
  const T at_a = a[0] * a[2];
  const T at_b = b[1] * b[3];
  const T half = T(0.5) * ((a[0] * b[2] + a[2] * b[0]) - (a[1] * b[3] + a[3] * b[1]));
  const T root = sqrt(half * half + at_a * at_b);
  const MaskOf<T> is_rising = half > T(0.0);
  const T larger = where(is_rising, root + half, root - half);
  const T sum = larger + where(is_rising, at_b, at_a);
  const MaskOf<T> is_regular = sum > T(least_square);
  const T numerator = where(is_rising, larger, at_a);
  return where(is_regular, numerator / where(is_regular, sum, T(1.0)), T(0.5));
}

/// The closest point of two triangles on one diagonal, the sides left out. On a flat face that is not convex
/// both can have it inside: then the mean of both.
template <class T>
BRIO_INLINE HullFoot<T> closest_of_two(const PlaneFoot<T>& p, const std::array<T, 4>& p_weights,
                                       const PlaneFoot<T>& q, const std::array<T, 4>& q_weights,
                                       const HullFoot<T>& on_edges, T resolution) {
  const MaskOf<T> is_same =
      p.is_inside & q.is_inside & (largest_magnitude(p.offset - q.offset) <= resolution);
  const MaskOf<T> is_q = q.is_inside & ((!p.is_inside) | (q.squared_distance < p.squared_distance));
  const T share = where(is_same, T(0.5), where(is_q, T(1.0), T(0.0)));
  const Vector3<T> offset = where<T>(is_q, q.offset, p.offset);
  const T squared_distance = where(is_q, q.squared_distance, p.squared_distance);
  const MaskOf<T> is_inside = (p.is_inside | q.is_inside) & (squared_distance < on_edges.squared_distance);
  return where<T>(is_inside, HullFoot<T>{offset, mean_weights(p_weights, q_weights, share), squared_distance},
                  on_edges);
}

/// Whether a node is inside of four vertices beyond rounding, from its differences to them: the volumes with
/// the four triangles have one sign. A volume is good to 48 roundings of the cube of the largest difference.
template <class T>
BRIO_INLINE MaskOf<T> surely_inside(const std::array<Vector3<T>, 4>& from, T largest) {
  const Vector3<T> c01 = cross(from[0], from[1]);
  const Vector3<T> c23 = cross(from[2], from[3]);
  const T v0 = dot(c23, from[1]);
  const T v1 = -dot(c23, from[0]);
  const T v2 = dot(c01, from[3]);
  const T v3 = -dot(c01, from[2]);
  const T bound = T(64 * unit_roundoff) * (largest * largest * largest);
  return (min(min(v0, v1), min(v2, v3)) > bound) | (max(max(v0, v1), max(v2, v3)) < -bound);
}

/// Closest point of the hull of the vertices to the node, in any shape: triangular faces repeat the third
/// vertex as the fourth. `flatness`: a length, see above.
template <class T>
BRIO_INLINE ClosestOnHull<T> closest_on_hull(const Vector3<T>& node,
                                             const std::array<Vector3<T>, 4>& vertices, T flatness = T(0.0)) {
  const T zero(0.0);
  const T one(1.0);
  const std::array<Vector3<T>, 4> from = {node - vertices[0], node - vertices[1], node - vertices[2],
                                          node - vertices[3]};
  const T largest = max(max(largest_magnitude(from[0]), largest_magnitude(from[1])),
                        max(largest_magnitude(from[2]), largest_magnitude(from[3])));
  const T resolution =
      max(flatness, T(16 * unit_roundoff) * (largest + largest_magnitude(node)) + T(0x1p-1000));

  const auto foot_on = [&](int i, int j, const Vector3<T>& along, T inverse_square) {
    const SegmentFoot<T> foot = segment_foot(from[index(i)], from[index(j)], along, inverse_square);
    HullFoot<T> result{foot.offset, {zero, zero, zero, zero}, foot.squared_distance};
    result.weights[index(i)] = one - foot.share;
    result.weights[index(j)] = foot.share;
    return result;
  };
  const Vector3<T> e01 = vertices[1] - vertices[0];
  const Vector3<T> e12 = vertices[2] - vertices[1];
  const Vector3<T> e23 = vertices[3] - vertices[2];
  const Vector3<T> e03 = vertices[3] - vertices[0];
  const Vector3<T> e02 = vertices[2] - vertices[0];
  const Vector3<T> e13 = vertices[3] - vertices[1];
  const T i02 = inverse_or_zero(dot(e02, e02));
  const T i13 = inverse_or_zero(dot(e13, e13));
  const HullFoot<T> on_sides = nearer(nearer(foot_on(0, 1, e01, inverse_or_zero(dot(e01, e01))),
                                             foot_on(1, 2, e12, inverse_or_zero(dot(e12, e12)))),
                                      nearer(foot_on(2, 3, e23, inverse_or_zero(dot(e23, e23))),
                                             foot_on(0, 3, e03, inverse_or_zero(dot(e03, e03)))));

  // The sheet of either diagonal.
  const TriangleBase<T> base_02 = triangle_base(from[0], e02, i02);
  const PlaneFoot<T> in_021 = plane_foot(base_02, e01);
  const PlaneFoot<T> in_023 = plane_foot(base_02, e03);
  const HullFoot<T> a = closest_of_two<T>(in_021, {in_021.first, in_021.third, in_021.second, zero}, in_023,
                                          {in_023.first, zero, in_023.second, in_023.third},
                                          nearer(on_sides, foot_on(0, 2, e02, i02)), resolution);
  const TriangleBase<T> base_13 = triangle_base(from[1], e13, i13);
  const PlaneFoot<T> in_130 = plane_foot(base_13, -one * e01);
  const PlaneFoot<T> in_132 = plane_foot(base_13, e12);
  const HullFoot<T> b = closest_of_two<T>(in_130, {in_130.third, in_130.first, zero, in_130.second}, in_132,
                                          {zero, in_132.first, in_132.third, in_132.second},
                                          nearer(on_sides, foot_on(1, 3, e13, i13)), resolution);

  const T flat = clamp_to_unit(T(2.0) - largest_magnitude(a.offset - b.offset) / resolution);
  const T bilinear = bilinear_share(a.weights, b.weights);
  const MaskOf<T> is_b = b.squared_distance < a.squared_distance;
  const T share = where(is_b, one - flat * (one - bilinear), flat * bilinear);
  ClosestOnHull<T> result;
  result.offset = where<T>(is_b, b.offset, a.offset);
  result.inside = surely_inside(from, largest);
  result.squared_distance = where(result.inside, zero, where(is_b, b.squared_distance, a.squared_distance));
  result.weights = mean_weights(a.weights, b.weights, share);
  const MaskOf<T> is_repeated =
      (vertices[2].x == vertices[3].x) & (vertices[2].y == vertices[3].y) & (vertices[2].z == vertices[3].z);
  result.weights[2] = where(is_repeated, result.weights[2] + result.weights[3], result.weights[2]);
  result.weights[3] = where(is_repeated, zero, result.weights[3]);
  return result;
}

}  // namespace brio
