#include "contact/velocity_check.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace brio {

using Eigen::Vector3d;

namespace {

constexpr double unit_roundoff = 0x1p-53;

double largest(const Vector3d& a) { return a.lpNorm<Eigen::Infinity>(); }

// A point that moves linearly with the fraction of the step.
struct Path {
  Vector3d start;
  Vector3d displacement;
  Vector3d at(double time) const { return start + time * displacement; }
};

// Node and face relative to the face's first vertex and its motion: every difference of given numbers is
// formed once and is right to one rounding, so neither the origin nor a common velocity is ever seen.
struct LocalPair {
  Path node;
  std::array<Path, 4> vertices;
  Path centroid;
  double
      scale;  // bounds any component of node - vertex at any time of the step and of its two terms, and reach
  double size;  // the same for vertex - vertex
};

LocalPair local_pair(const MovingNode& node, const MovingFace& face, double reach) {
  LocalPair pair;
  pair.node = {node.start - face.start[0], node.displacement - face.displacement[0]};
  pair.size = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    pair.vertices[k] = {face.start[k] - face.start[0], face.displacement[k] - face.displacement[0]};
    pair.size = std::max(pair.size, largest(pair.vertices[k].start) + largest(pair.vertices[k].displacement));
  }
  pair.centroid = {
      0.25 * (pair.vertices[1].start + pair.vertices[2].start + pair.vertices[3].start),
      0.25 * (pair.vertices[1].displacement + pair.vertices[2].displacement + pair.vertices[3].displacement)};
  pair.scale = largest(pair.node.start) + largest(pair.node.displacement) + pair.size + reach;
  return pair;
}

// One sub-triangle and the node.
struct Triangle {
  Path node;
  std::array<Path, 3> vertices;
  double scale;
  double size;
  double reach;
};

// Six times the signed volume of node and triangle over the step, positive where the node is on the side of
// the normal: a cubic, by its Bernstein coefficients. `error` bounds their rounding and that of `on`.
struct Cubic {
  std::array<double, 4> coefficients;
  double error;
  double area;  // bounds twice the area of the triangle over the step

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

// Rounding: a component of an edge is wrong by at most 6 roundings of 2 size, one of node - vertex by 6 of
// scale; their triple product sums 6 terms of at most scale (2 size)^2 each, with 8 roundings on the way,
// hence (6 + 12 + 8) x 24 < 640; the blossom adds 9 x 24 for its values and as much for the rounding of a
// time. 1100 covers them.
constexpr double cubic_roundings = 1100;

Cubic coplanarity(const Triangle& triangle) {
  const auto& [a, b, c] = triangle.vertices;
  const Vector3d u0 = triangle.node.start - a.start;
  const Vector3d u1 = u0 + (triangle.node.displacement - a.displacement);
  const Vector3d e0 = b.start - a.start;
  const Vector3d e1 = e0 + (b.displacement - a.displacement);
  const Vector3d f0 = c.start - a.start;
  const Vector3d f1 = f0 + (c.displacement - a.displacement);
  const Vector3d n0 = e0.cross(f0);
  const Vector3d n1 = 0.5 * (e0.cross(f1) + e1.cross(f0));
  const Vector3d n2 = e1.cross(f1);
  Cubic cubic;
  cubic.coefficients = {u0.dot(n0), (u1.dot(n0) + 2 * u0.dot(n1)) / 3, (2 * u1.dot(n1) + u0.dot(n2)) / 3,
                        u1.dot(n2)};
  cubic.error = cubic_roundings * unit_roundoff * triangle.scale * triangle.size * triangle.size;
  cubic.area = std::sqrt(std::max({n0.squaredNorm(), n1.squaredNorm(), n2.squaredNorm()})) +
               cubic_roundings * unit_roundoff * triangle.size * triangle.size;
  return cubic;
}

struct Interval {
  double from;
  double to;
  bool empty() const { return !(from <= to); }
};

// Part of the interval outside of which the cubic is off zero by more than `band`: where the convex hull of
// its control polygon meets the band (Bezier clipping: Sederberg and Nishita 1990).
Interval clipped(const Cubic& cubic, double band, Interval interval) {
  const std::array<double, 4> c = cubic.on(interval.from, interval.to);
  double first = 2;
  double last = -1;
  const auto keep = [&](double x) {
    first = std::min(first, x);
    last = std::max(last, x);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = static_cast<double>(i) / 3;
    if (std::abs(c[i]) <= band) keep(x);
    for (std::size_t j = i + 1; j < 4; ++j) {
      for (const double level : {-band, band}) {
        if ((c[i] < level) == (c[j] < level)) continue;
        keep(x + static_cast<double>(j - i) / 3 * ((level - c[i]) / (c[j] - c[i])));
      }
    }
  }
  if (first > last) return {1, 0};
  constexpr double margin = 16 * unit_roundoff;
  const double width = interval.to - interval.from;
  if (first > margin)
    first -= margin;
  else
    first = 0;
  const double from = first > 0 ? interval.from + first * width : interval.from;
  const double to = last + margin < 1 ? interval.from + (last + margin) * width : interval.to;
  return {from, std::min(to, interval.to)};
}

// Direction from the node along which the closest feature separates it best from the triangle.
Vector3d separating_direction(const TrianglePoint& closest, const std::array<Vector3d, 3>& vertices) {
  if (closest.feature == Feature::interior) {
    const Vector3d normal = closest.area_vector.normalized();
    return normal.dot(closest.offset) < 0 ? Vector3d(-normal) : normal;
  }
  if (closest.feature == Feature::vertex) return closest.offset.normalized();
  const auto k = static_cast<std::size_t>(closest.index);
  const Vector3d edge = vertices[(k + 1) % 3] - vertices[k];
  const Vector3d across = closest.offset - edge * (edge.dot(closest.offset) / edge.squaredNorm());
  return across.normalized();
}

// Roundings of scale in the distance of a vertex along a unit direction: 8 per component of node - vertex at
// a time and of the product, times the sum of the direction's components, at most sqrt(3).
constexpr double direction_roundings = 24;
// A touch is accepted within so many; `touch_tolerance` adds the rounding of the accepted distance itself.
constexpr double touch_roundings = 96;
constexpr double reported_roundings = 128;

// Latest time until which all vertices stay beyond reach along the direction, from `time` on; `time` itself
// if not even then.
double separated_until(const Triangle& triangle, const Vector3d& direction, double time) {
  const double error = direction_roundings * unit_roundoff * triangle.scale;
  double until = std::numeric_limits<double>::infinity();
  for (const Path& vertex : triangle.vertices) {
    const double beyond = direction.dot(vertex.start - triangle.node.start) - triangle.reach - error;
    const double approach = -direction.dot(vertex.displacement - triangle.node.displacement);
    if (!(beyond - time * approach > 0)) return time;
    if (approach > 0) until = std::min(until, beyond / approach);
  }
  return std::max(until, time);
}

struct Touch {
  double time;
  TrianglePoint closest;
};

// First touch of a sub-triangle not later than `limit`.
std::optional<Touch> first_touch(const Triangle& triangle, const Cubic& cubic, double limit) {
  double speed = 0;
  for (const Path& vertex : triangle.vertices)
    speed = std::max(speed, largest(vertex.displacement - triangle.node.displacement));
  const double touching = triangle.reach + touch_roundings * unit_roundoff * triangle.scale;
  const double shortest = 8 * unit_roundoff * triangle.scale;  // moved in less time than this: no move
  const double band = cubic.error + triangle.reach * cubic.area;

  std::array<double, 64> ends;  // of the intervals still to be searched, the next one last
  std::size_t open = 0;
  ends[open++] = limit;
  double from = 0;
  while (open > 0) {
    const Interval interval = clipped(cubic, band, {from, ends[open - 1]});
    if (interval.empty()) {
      from = ends[--open];
      continue;
    }
    std::array<Vector3d, 3> vertices;
    for (std::size_t k = 0; k < 3; ++k) vertices[k] = triangle.vertices[k].at(interval.from);
    const TrianglePoint closest = closest_point_on_triangle(triangle.node.at(interval.from), vertices);
    if (closest.squared_distance <= touching * touching) return Touch{interval.from, closest};
    const double until = separated_until(triangle, separating_direction(closest, vertices), interval.from);
    if (until > interval.from && until >= interval.to) {
      from = std::max(until, ends[--open]);
      while (open > 0 && ends[open - 1] <= from) --open;
      if (open == 0) break;
      continue;
    }
    const double rest = interval.to - until;
    const bool indivisible = rest * speed <= shortest;
    if (indivisible && until == interval.from) return Touch{interval.from, closest};  // in doubt, contact
    const double width = ends[open - 1] - from;
    from = until;
    ends[open - 1] = interval.to;
    if (!indivisible && rest > 0.5 * width) ends[open++] = from + 0.5 * rest;
    assert(open < ends.size());
  }
  return std::nullopt;
}

// The side from which the cubic came to its value at `time`: the last of its coefficients on [0, time] that
// is surely not zero.
int side_before(const Cubic& cubic, double time) {
  const std::array<double, 4> c = cubic.on(0, time);
  for (std::size_t k = 4; k-- > 0;)
    if (std::abs(c[k]) > cubic.error) return c[k] > 0 ? 1 : -1;
  return 0;
}

}  // namespace

double touch_tolerance(const MovingNode& node, const MovingFace& face, double reach) {
  return reported_roundings * unit_roundoff * local_pair(node, face, reach).scale;
}

std::optional<VelocityContact> velocity_check(const MovingNode& node, const MovingFace& face, double reach) {
  assert(reach >= 0);
  const LocalPair pair = local_pair(node, face, reach);
  const bool single = is_triangle(face.start) && is_triangle(face.displacement);
  std::optional<VelocityContact> contact;
  for (int k = 0; k < (single ? 1 : 4); ++k) {
    const auto first = static_cast<std::size_t>(k);
    const auto second = static_cast<std::size_t>((k + 1) % 4);
    Triangle triangle{pair.node,
                      {pair.centroid, pair.vertices[first], pair.vertices[second]},
                      pair.scale,
                      pair.size,
                      reach};
    if (single) triangle.vertices = {pair.vertices[0], pair.vertices[1], pair.vertices[2]};
    const Cubic cubic = coplanarity(triangle);
    const std::optional<Touch> touch = first_touch(triangle, cubic, contact ? contact->time : 1.0);
    if (!touch || (contact && touch->time >= contact->time)) continue;
    const Vector3d face_area =
        accurate_cross(pair.vertices[2].at(touch->time) - pair.vertices[0].at(touch->time),
                       pair.vertices[3].at(touch->time) - pair.vertices[1].at(touch->time));
    const std::array<double, 3>& w = touch->closest.weights;
    contact.emplace();
    contact->time = touch->time;
    contact->normal = unit_or(touch->closest.area_vector, face_area);
    contact->distance = std::sqrt(touch->closest.squared_distance);
    contact->side = side_before(cubic, touch->time);
    contact->sub_triangle = k;
    if (single) {
      contact->weights = {w[0], w[1], w[2], 0};
      continue;
    }
    contact->weights.fill(0.25 * w[0]);
    contact->weights[first] += w[1];
    contact->weights[second] += w[2];
  }
  return contact;
}

}  // namespace brio
