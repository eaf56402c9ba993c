#pragma once
/// What the velocity checks share: certificates that a moving point set stays away from the origin for a time
/// (conservative advancement, Mirtich 1996, along directions that turn), and the cubic of four moving points.
/// The points are relative positions: of a face's vertices to a node, or of one edge's ends to the other's.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "src/base/floating_point.hpp"
#include "src/base/tensor.hpp"

namespace brio::advancement {

/// A point that moves linearly with the fraction of the step.
struct Path {
  Vector3d start;
  Vector3d displacement;
  Vector3d at(double time) const { return start + time * displacement; }
};

inline Path operator-(const Path& a, const Path& b) {
  return {a.start - b.start, a.displacement - b.displacement};
}

/// Six times the signed volume of four moving points over the step: a cubic, by its Bernstein coefficients.
/// `error` bounds their rounding and that of `on`.
struct Cubic {
  std::array<double, 4> coefficients;
  double error;

  // Blossom: multiaffine form of the cubic.
  double blossom(double a, double b, double c) const {
    std::array<double, 4> p = coefficients;
    for (std::size_t k = 0; k < 3; ++k) p[k] = (1 - a) * p[k] + a * p[k + 1];
    for (std::size_t k = 0; k < 2; ++k) p[k] = (1 - b) * p[k] + b * p[k + 1];
    return (1 - c) * p[0] + c * p[1];
  }
  std::array<double, 4> on(double from, double to) const {
    return {blossom(from, from, from), blossom(from, from, to), blossom(from, to, to), blossom(to, to, to)};
  }
};

// Rounding: a component of an edge is wrong by at most 6 roundings of 2 size, one of the offset by 6 of
// scale; their triple product sums 6 terms of at most scale (2 size)^2 each, with 8 roundings on the way,
// hence (6 + 12 + 8) x 24 < 640; the blossom adds 9 x 24 for its values and as much for the rounding of a
// time. 1100 covers them.
inline constexpr double cubic_roundings = 1100;

/// offset . (e x f), where at any time `scale` bounds the components of the offset, and `area` a quarter of
/// the product of a component of e and one of f.
inline Cubic volume(const Path& offset, const Path& e, const Path& f, double scale, double area) {
  const Vector3d& u0 = offset.start;
  const Vector3d u1 = u0 + offset.displacement;
  const Vector3d& e0 = e.start;
  const Vector3d e1 = e0 + e.displacement;
  const Vector3d& f0 = f.start;
  const Vector3d f1 = f0 + f.displacement;
  const Vector3d n0 = cross(e0, f0);
  const Vector3d n1 = 0.5 * (cross(e0, f1) + cross(e1, f0));
  const Vector3d n2 = cross(e1, f1);
  Cubic cubic;
  cubic.coefficients = {dot(u0, n0), (dot(u1, n0) + 2 * dot(u0, n1)) / 3, (2 * dot(u1, n1) + dot(u0, n2)) / 3,
                        dot(u1, n2)};
  cubic.error = cubic_roundings * unit_roundoff * scale * area;
  return cubic;
}

/// The sign from which the cubic came to its value at `time`: the last of its coefficients on [0, time] that
/// is surely not zero.
inline int sign_before(const Cubic& cubic, double time) {
  const std::array<double, 4> c = cubic.on(0, time);
  for (std::size_t k = 4; k-- > 0;)
    if (std::abs(c[k]) > cubic.error) return c[k] > 0 ? 1 : -1;
  return 0;
}

// Roundings of scale in the distance of a point along a unit direction: at most 7 for each component of a
// relative position at a time (differences, mean of four, product and sum), 4 more for the scalar product,
// times the sum of the direction's components, at most sqrt(3), and 8 for solving and for the rounding of a
// time: 28.
inline constexpr double direction_roundings = 32;
// The same for the part that grows with the turn of the direction.
inline constexpr double turning_roundings = 48;
// A touch is accepted within so many; what is promised adds the rounding of the accepted distance itself.
inline constexpr double touch_roundings = 96;
inline constexpr double promised_roundings = 128;
// A time is taken back by so much of itself, for its own rounding.
inline constexpr double kept_time = 1 - 8 * unit_roundoff;

// So many certificates are tried within the promised tolerance; each as many more double it. Only motion that
// keeps within rounding of a turning edge for long needs more.
inline constexpr int patience = 1024;

/// A direction from the origin that changes linearly: `towards` (1 + elapsed `growth`) + elapsed `turning`.
/// `towards` is a unit vector and `turning` at right angles to it. Both zero: no direction.
struct Direction {
  Vector3d towards;
  Vector3d turning;
  double growth = 0;
};

inline Direction no_direction() { return {Vector3d{}, Vector3d{}}; }
inline Direction without_turn(const Direction& direction) { return {direction.towards, Vector3d{}}; }

/// Across a segment that turns, towards the side of the offset.
inline Direction across(const Vector3d& edge, const Vector3d& edge_motion, const Vector3d& offset) {
  const double length_squared = squared_norm(edge);
  if (!(length_squared > 0)) return no_direction();
  const Vector3d towards = normalized(offset - edge * (dot(edge, offset) / length_squared));
  return {towards, edge * (-dot(towards, edge_motion) / length_squared)};
}

/// The same, exactly at right angles to the segment however long and far it turns.
inline Direction strictly_across(const Vector3d& edge, const Vector3d& edge_motion, const Vector3d& offset) {
  Direction direction = across(edge, edge_motion, offset);
  if (!is_zero(direction.towards)) direction.growth = dot(edge_motion, edge) / squared_norm(edge);
  return direction;
}

/// Along a normal that changes, towards the side of the offset.
inline Direction along_normal(const Vector3d& normal, const Vector3d& change, const Vector3d& offset) {
  const double length = norm(normal);
  if (!(length > 0)) return no_direction();
  const double sign = dot(normal, offset) < 0 ? -1 : 1;
  const Vector3d towards = normal * (sign / length);
  const Vector3d rate = change * (sign / length);
  return {towards, rate - towards * dot(towards, rate)};
}

/// For how long c + b x + a x^2 stays positive from x = 0 on.
inline double positive_until(double a, double b, double c) {
  if (!(c > 0)) return 0;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return infinity;  // then a > 0
  const double root = std::sqrt(discriminant);
  if (b >= 0) return a < 0 ? (b + root) / (-2 * a) : infinity;
  return 2 * c / (root - b);
}

/// For how long all points, which move on by `motions` each step, stay farther than `reach` along the
/// direction. `scale` bounds their components at any time of the step, and `reach`.
template <std::size_t count>
double separated_for(const std::array<Vector3d, count>& points, const std::array<Vector3d, count>& motions,
                     const Direction& direction, double scale, double reach) {
  const double rounding = unit_roundoff * scale;
  const double nearest = reach + direction_roundings * rounding;
  const double turn = norm(direction.turning);
  const double growth = direction.growth;
  // Beyond half a right angle the direction is useless, and its length, 1 + growth elapsed + (turn elapsed)^2
  // / (2 (1 + growth elapsed)), too rough; that it shrinks by no more than half bounds the length.
  double elapsed = turn > 1 ? 1 / turn : infinity;
  if (growth < 0) elapsed = std::min(elapsed, -0.5 / growth);
  const double bend = growth < 0 ? 1 : 0.5;
  for (std::size_t k = 0; k < count; ++k) {
    const double rise = dot(direction.towards, motions[k]);
    const double c = dot(direction.towards, points[k]) - nearest;
    const double b =
        rise + dot(direction.turning, points[k]) - turning_roundings * rounding * turn + growth * c;
    const double a = dot(direction.turning, motions[k]) - bend * nearest * turn * turn + growth * rise;
    elapsed = std::min(elapsed, positive_until(a, b, c));
  }
  return elapsed;
}

}  // namespace brio::advancement
