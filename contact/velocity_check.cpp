#include "contact/velocity_check.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "contact/apart.hpp"

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

Path operator-(const Path& a, const Path& b) { return {a.start - b.start, a.displacement - b.displacement}; }

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
  return cubic;
}

// Roundings of scale in the distance of a vertex along a unit direction: at most 7 for each component of node
// - vertex at a time (differences, mean of four, product and sum), 4 more for the scalar product, times the
// sum of the direction's components, at most sqrt(3), and 8 for solving and for the rounding of a time: 28.
constexpr double direction_roundings = 32;
// The same for the part that grows with the turn of the direction.
constexpr double turning_roundings = 48;
// A touch is accepted within so many; what is promised adds the rounding of the accepted distance itself.
constexpr double touch_roundings = 96;
constexpr double promised_roundings = 128;

// What is seen from the node at a time: the vertices, and how they move until the end of the step.
struct Sight {
  std::array<Vector3d, 3> vertices;
  std::array<Vector3d, 3> motions;
  TrianglePoint closest;
};

// A direction from the node that turns linearly: `towards` + elapsed `turning`; `towards` is a unit vector
// and `turning` at right angles to it.
struct Direction {
  Vector3d towards;
  Vector3d turning;
};

Direction without_turn(const Direction& direction) { return {direction.towards, Vector3d::Zero()}; }

// Direction along which a feature separates the triangle best from the node, if it is the closest: it follows
// the turn of the normal in the interior and of the edge on an edge. No direction (zero) if the feature has
// no extent.
Direction separating_direction(const Sight& sight, Feature feature, int index) {
  const auto k = static_cast<std::size_t>(index);
  const std::size_t next = (k + 1) % 3;
  if (feature == Feature::vertex) return {sight.vertices[k].normalized(), Vector3d::Zero()};
  const Vector3d edge = sight.vertices[next] - sight.vertices[k];
  const Vector3d edge_motion = sight.motions[next] - sight.motions[k];
  if (feature == Feature::edge) {
    const double length_squared = edge.squaredNorm();
    if (!(length_squared > 0)) return {Vector3d::Zero(), Vector3d::Zero()};
    const Vector3d& offset = sight.closest.offset;
    const Vector3d across = (offset - edge * (edge.dot(offset) / length_squared)).normalized();
    return {across, edge * (-across.dot(edge_motion) / length_squared)};
  }
  const double length = sight.closest.area_vector.norm();
  if (!(length > 0)) return {Vector3d::Zero(), Vector3d::Zero()};
  const Vector3d other = sight.vertices[2] - sight.vertices[0];
  const Vector3d other_motion = sight.motions[2] - sight.motions[0];
  const double sign = sight.closest.area_vector.dot(sight.closest.offset) < 0 ? -1 : 1;
  const Vector3d normal = sight.closest.area_vector * (sign / length);
  const Vector3d change = (edge_motion.cross(other) + edge.cross(other_motion)) * (sign / length);
  return {normal, change - normal * normal.dot(change)};
}

// For how long c + b x + a x^2 stays positive from x = 0 on.
double positive_until(double a, double b, double c) {
  if (!(c > 0)) return 0;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return std::numeric_limits<double>::infinity();  // then a > 0
  const double root = std::sqrt(discriminant);
  if (b >= 0) return a < 0 ? (b + root) / (-2 * a) : std::numeric_limits<double>::infinity();
  return 2 * c / (root - b);
}

// For how long all vertices stay farther than reach along the direction.
double separated_for(const Triangle& triangle, const Sight& sight, const Direction& direction) {
  const double rounding = unit_roundoff * triangle.scale;
  const double nearest = triangle.reach + direction_roundings * rounding;
  const double turn = direction.turning.norm();
  // Beyond half a right angle the direction is useless, and its length 1 + (turn elapsed)^2 / 2 too rough.
  double elapsed = turn > 1 ? 1 / turn : std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = direction.towards.dot(sight.vertices[k]) - nearest;
    const double b = direction.towards.dot(sight.motions[k]) + direction.turning.dot(sight.vertices[k]) -
                     turning_roundings * rounding * turn;
    const double a = direction.turning.dot(sight.motions[k]) - 0.5 * nearest * turn * turn;
    elapsed = std::min(elapsed, positive_until(a, b, c));
  }
  return elapsed;
}

// For how long some direction is known to separate the triangle from the node; 0 if none is.
double separated_for(const Triangle& triangle, const Sight& sight) {
  const auto along = [&](Feature feature, int index) {
    const Direction direction = separating_direction(sight, feature, index);
    return std::max(separated_for(triangle, sight, direction),
                    separated_for(triangle, sight, without_turn(direction)));
  };
  double elapsed = along(sight.closest.feature, sight.closest.index);
  if (elapsed > 0) return elapsed;
  // Where two features meet, rounding may name the wrong one.
  elapsed = along(Feature::interior, 0);
  for (int k = 0; k < 3; ++k)
    elapsed = std::max({elapsed, along(Feature::edge, k), along(Feature::vertex, k)});
  return elapsed;
}

struct Touch {
  double time;
  TrianglePoint closest;
};

// So many certificates are tried within the promised tolerance; each as many more double it. Only motion that
// keeps within rounding of a turning edge for long needs more.
constexpr int patience = 1024;

// First touch of a sub-triangle not later than `limit`: the time moves forward for as long as a direction
// separates.
std::optional<Touch> first_touch(const Triangle& triangle, double limit) {
  double tolerance = touch_roundings * unit_roundoff * triangle.scale;
  Sight sight;
  std::array<Path, 3> paths;
  for (std::size_t k = 0; k < 3; ++k) {
    paths[k] = triangle.vertices[k] - triangle.node;
    sight.motions[k] = paths[k].displacement;
  }
  double time = 0;
  for (int count = 1;; ++count) {
    for (std::size_t k = 0; k < 3; ++k) sight.vertices[k] = paths[k].at(time);
    sight.closest = closest_point_on_triangle(Vector3d::Zero(), sight.vertices);
    const double touching = triangle.reach + tolerance;
    if (sight.closest.squared_distance <= touching * touching) return Touch{time, sight.closest};
    const double elapsed = separated_for(triangle, sight);
    const double until = time + elapsed * (1 - 8 * unit_roundoff);
    if (until > limit) return std::nullopt;
    if (!(until > time)) return Touch{time, sight.closest};  // no certificate: in doubt, contact
    time = until;
    if (count % patience == 0) tolerance *= 2;
  }
}

// The side from which the cubic came to its value at `time`: the last of its coefficients on [0, time] that
// is surely not zero.
int side_before(const Cubic& cubic, double time) {
  const std::array<double, 4> c = cubic.on(0, time);
  for (std::size_t k = 4; k-- > 0;)
    if (std::abs(c[k]) > cubic.error) return c[k] > 0 ? 1 : -1;
  return 0;
}

Vector3<double> components(const Vector3d& a) { return {a[0], a[1], a[2]}; }

MovingPair<double> moving_pair(const MovingNode& node, const MovingFace& face) {
  MovingPair<double> pair{{components(node.start)}, {components(node.displacement)}};
  for (std::size_t k = 0; k < 4; ++k) {
    pair.start[k + 1] = components(face.start[k]);
    pair.displacement[k + 1] = components(face.displacement[k]);
  }
  return pair;
}

}  // namespace

double touch_tolerance(const MovingNode& node, const MovingFace& face, double reach) {
  return promised_roundings * unit_roundoff * local_pair(node, face, reach).scale;
}

std::optional<VelocityContact> velocity_check(const MovingNode& node, const MovingFace& face, double reach) {
  assert(reach >= 0);
  if (surely_apart(moving_pair(node, face), reach)) return std::nullopt;
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
    const std::optional<Touch> touch = first_touch(triangle, contact ? contact->time : 1.0);
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
