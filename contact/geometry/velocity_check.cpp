#include "contact/geometry/velocity_check.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "contact/geometry/advancement.hpp"
#include "contact/geometry/apart.hpp"
#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

using namespace advancement;

namespace {

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
    pair.size = std::max(pair.size,
                         maximum_norm(pair.vertices[k].start) + maximum_norm(pair.vertices[k].displacement));
  }
  pair.centroid = {
      0.25 * (pair.vertices[1].start + pair.vertices[2].start + pair.vertices[3].start),
      0.25 * (pair.vertices[1].displacement + pair.vertices[2].displacement + pair.vertices[3].displacement)};
  pair.scale = maximum_norm(pair.node.start) + maximum_norm(pair.node.displacement) + pair.size + reach;
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

Cubic coplanarity(const Triangle& triangle) {
  const auto& [a, b, c] = triangle.vertices;
  return volume(triangle.node - a, b - a, c - a, triangle.scale, triangle.size * triangle.size);
}

// What is seen from the node at a time: the vertices, and how they move until the end of the step.
struct SightOfTriangle {
  std::array<Vector3d, 3> vertices;
  std::array<Vector3d, 3> motions;
  TrianglePoint closest;
};

// Direction along which a feature separates the triangle best from the node, if it is the closest: it follows
// the turn of the normal in the interior and of the edge on an edge. No direction (zero) if the feature has
// no extent.
Direction separating_direction(const SightOfTriangle& sight, Feature feature, int number) {
  const auto k = index(number);
  const std::size_t next = (k + 1) % 3;
  if (feature == Feature::vertex) return {normalized(sight.vertices[k]), Vector3d{}};
  const Vector3d edge = sight.vertices[next] - sight.vertices[k];
  const Vector3d edge_motion = sight.motions[next] - sight.motions[k];
  if (feature == Feature::edge) return across(edge, edge_motion, sight.closest.offset);
  const Vector3d other = sight.vertices[2] - sight.vertices[0];
  const Vector3d other_motion = sight.motions[2] - sight.motions[0];
  return along_normal(sight.closest.area_vector, cross(edge_motion, other) + cross(edge, other_motion),
                      sight.closest.offset);
}

double separated_for(const Triangle& triangle, const SightOfTriangle& sight, const Direction& direction) {
  return separated_for(sight.vertices, sight.motions, direction, triangle.scale, triangle.reach);
}

// For how long some direction is known to separate the triangle from the node; 0 if none is.
double separated_for(const Triangle& triangle, const SightOfTriangle& sight) {
  const auto along = [&](Feature feature, int number) {
    const Direction direction = separating_direction(sight, feature, number);
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

struct TouchOfTriangle {
  double time;
  TrianglePoint closest;
};

// First touch of a sub-triangle not later than `limit`: the time moves forward for as long as a direction
// separates.
std::optional<TouchOfTriangle> first_touch(const Triangle& triangle, double limit) {
  double tolerance = touch_roundings * unit_roundoff * triangle.scale;
  SightOfTriangle sight;
  std::array<Path, 3> paths;
  for (std::size_t k = 0; k < 3; ++k) {
    paths[k] = triangle.vertices[k] - triangle.node;
    sight.motions[k] = paths[k].displacement;
  }
  double time = 0;
  for (int count = 1;; ++count) {
    for (std::size_t k = 0; k < 3; ++k) sight.vertices[k] = paths[k].at(time);
    sight.closest = closest_point_on_triangle(Vector3d{}, sight.vertices);
    const double touching = triangle.reach + tolerance;
    if (sight.closest.squared_distance <= touching * touching) return TouchOfTriangle{time, sight.closest};
    const double elapsed = separated_for(triangle, sight);
    const double until = time + elapsed * kept_time;
    if (until > limit) return std::nullopt;
    if (!(until > time)) return TouchOfTriangle{time, sight.closest};  // no certificate: in doubt, contact
    time = until;
    if (count % patience == 0) tolerance *= 2;
  }
}

MovingPair<double> moving_pair(const MovingNode& node, const MovingFace& face) {
  MovingPair<double> pair{{node.start}, {node.displacement}};
  for (std::size_t k = 0; k < 4; ++k) {
    pair.start[k + 1] = face.start[k];
    pair.displacement[k + 1] = face.displacement[k];
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
    const auto first = index(k);
    const auto second = index((k + 1) % 4);
    Triangle triangle{pair.node,
                      {pair.centroid, pair.vertices[first], pair.vertices[second]},
                      pair.scale,
                      pair.size,
                      reach};
    if (single) triangle.vertices = {pair.vertices[0], pair.vertices[1], pair.vertices[2]};
    const Cubic cubic = coplanarity(triangle);
    const std::optional<TouchOfTriangle> touch = first_touch(triangle, contact ? contact->time : 1.0);
    if (!touch || (contact && touch->time >= contact->time)) continue;
    const Vector3d face_area =
        accurate_cross(pair.vertices[2].at(touch->time) - pair.vertices[0].at(touch->time),
                       pair.vertices[3].at(touch->time) - pair.vertices[1].at(touch->time));
    const std::array<double, 3>& w = touch->closest.weights;
    contact.emplace();
    contact->time = touch->time;
    contact->normal = unit_or(touch->closest.area_vector, face_area);
    contact->distance = std::sqrt(touch->closest.squared_distance);
    contact->side = sign_before(cubic, touch->time);
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
