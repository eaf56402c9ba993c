#pragma once
/// What the velocity checks share: certificates that a moving point set stays away from the origin for a time
/// (conservative advancement, Mirtich 1996, along directions that turn), and the cubic of four moving points.
/// The points are relative positions: of a face's vertices to a node, or of one edge's ends to the other's.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "src/base/floating_point.hpp"

namespace brio::advancement {

inline double largest(const Eigen::Vector3d& a) { return a.lpNorm<Eigen::Infinity>(); }

/// A point that moves linearly with the fraction of the step.
struct Path {
  Eigen::Vector3d start;
  Eigen::Vector3d displacement;
  Eigen::Vector3d at(double time) const { return start + time * displacement; }
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
  const Eigen::Vector3d& u0 = offset.start;
  const Eigen::Vector3d u1 = u0 + offset.displacement;
  const Eigen::Vector3d& e0 = e.start;
  const Eigen::Vector3d e1 = e0 + e.displacement;
  const Eigen::Vector3d& f0 = f.start;
  const Eigen::Vector3d f1 = f0 + f.displacement;
  const Eigen::Vector3d n0 = e0.cross(f0);
  const Eigen::Vector3d n1 = 0.5 * (e0.cross(f1) + e1.cross(f0));
  const Eigen::Vector3d n2 = e1.cross(f1);
  Cubic cubic;
  cubic.coefficients = {u0.dot(n0), (u1.dot(n0) + 2 * u0.dot(n1)) / 3, (2 * u1.dot(n1) + u0.dot(n2)) / 3,
                        u1.dot(n2)};
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
  Eigen::Vector3d towards;
  Eigen::Vector3d turning;
  double growth = 0;
};

inline Direction no_direction() { return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }
inline Direction without_turn(const Direction& direction) {
  return {direction.towards, Eigen::Vector3d::Zero()};
}

/// Across a segment that turns, towards the side of the offset.
inline Direction across(const Eigen::Vector3d& edge, const Eigen::Vector3d& edge_motion,
                        const Eigen::Vector3d& offset) {
  const double length_squared = edge.squaredNorm();
  if (!(length_squared > 0)) return no_direction();
  const Eigen::Vector3d towards = (offset - edge * (edge.dot(offset) / length_squared)).normalized();
  return {towards, edge * (-towards.dot(edge_motion) / length_squared)};
}

/// The same, exactly at right angles to the segment however long and far it turns.
inline Direction strictly_across(const Eigen::Vector3d& edge, const Eigen::Vector3d& edge_motion,
                                 const Eigen::Vector3d& offset) {
  Direction direction = across(edge, edge_motion, offset);
  if (!direction.towards.isZero(0)) direction.growth = edge_motion.dot(edge) / edge.squaredNorm();
  return direction;
}

/// Along a normal that changes, towards the side of the offset.
inline Direction along_normal(const Eigen::Vector3d& normal, const Eigen::Vector3d& change,
                              const Eigen::Vector3d& offset) {
  const double length = normal.norm();
  if (!(length > 0)) return no_direction();
  const double sign = normal.dot(offset) < 0 ? -1 : 1;
  const Eigen::Vector3d towards = normal * (sign / length);
  const Eigen::Vector3d rate = change * (sign / length);
  return {towards, rate - towards * towards.dot(rate)};
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
double separated_for(const std::array<Eigen::Vector3d, count>& points,
                     const std::array<Eigen::Vector3d, count>& motions, const Direction& direction,
                     double scale, double reach) {
  const double rounding = unit_roundoff * scale;
  const double nearest = reach + direction_roundings * rounding;
  const double turn = direction.turning.norm();
  const double growth = direction.growth;
  // Beyond half a right angle the direction is useless, and its length, 1 + growth elapsed + (turn elapsed)^2
  // / (2 (1 + growth elapsed)), too rough; that it shrinks by no more than half bounds the length.
  double elapsed = turn > 1 ? 1 / turn : infinity;
  if (growth < 0) elapsed = std::min(elapsed, -0.5 / growth);
  const double bend = growth < 0 ? 1 : 0.5;
  for (std::size_t k = 0; k < count; ++k) {
    const double rise = direction.towards.dot(motions[k]);
    const double c = direction.towards.dot(points[k]) - nearest;
    const double b =
        rise + direction.turning.dot(points[k]) - turning_roundings * rounding * turn + growth * c;
    const double a = direction.turning.dot(motions[k]) - bend * nearest * turn * turn + growth * rise;
    elapsed = std::min(elapsed, positive_until(a, b, c));
  }
  return elapsed;
}

}  // namespace brio::advancement
