#include "contact/geometry/edge_check.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "contact/geometry/advancement.hpp"
#include "contact/geometry/closest_point.hpp"
#include "contact/geometry/edges_apart.hpp"
#include "src/base/tensor.hpp"

namespace brio {
using namespace advancement;

namespace {

// The edges relative to each other: every difference of given numbers is formed once and is right to one
// rounding, so neither the origin nor a common velocity is ever seen.
struct RelativeEdges {
  std::array<Path, 4> between;  // at 2 i + j: end i of a minus end j of b
  Path along_a;
  Path along_b;
  double reach;
  double scale;  // bounds any component of `between` at any time of the step and of its two terms, and reach
};

double bound(const Path& path) { return maximum_norm(path.start) + maximum_norm(path.displacement); }

RelativeEdges relative_edges(const MovingEdge& a, const MovingEdge& b) {
  RelativeEdges edges;
  edges.reach = a.radius + b.radius;
  edges.scale = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    edges.between[k] =
        Path{a.start[k / 2], a.displacement[k / 2]} - Path{b.start[k % 2], b.displacement[k % 2]};
    edges.scale = std::max(edges.scale, bound(edges.between[k]));
  }
  edges.scale += edges.reach;
  edges.along_a = Path{a.start[1], a.displacement[1]} - Path{a.start[0], a.displacement[0]};
  edges.along_b = Path{b.start[1], b.displacement[1]} - Path{b.start[0], b.displacement[0]};
  return edges;
}

// What is seen at a time: the corners of the parallelogram of differences, and how they move until the end of
// the step.
struct SightOfEdges {
  std::array<Vector3d, 4> corners;
  std::array<Vector3d, 4> motions;
  Vector3d along_a;
  Vector3d along_b;
  ClosestSegments closest;
};

void look(const RelativeEdges& edges, double time, SightOfEdges& sight) {
  for (std::size_t k = 0; k < 4; ++k) sight.corners[k] = edges.between[k].at(time);
  sight.along_a = edges.along_a.at(time);
  sight.along_b = edges.along_b.at(time);
  const auto& c = sight.corners;
  sight.closest = closest_points_of_segments(
      SegmentPair{{Segment{c[0], c[1]}, Segment{c[2], c[3]}}, sight.along_a, sight.along_b});
}

// For how long some direction is known to separate the edges; 0 if none is.
class Certificates {
 public:
  Certificates(const RelativeEdges& edges, const SightOfEdges& sight, double left)
      : edges_(edges), sight_(sight), left_(left) {}

  // By the feature that the closest points are on.
  double by_feature() const {
    const auto& [on_a, on_b] = sight_.closest.features;
    const bool inside_a = on_a == SegmentFeature::inside;
    const bool inside_b = on_b == SegmentFeature::inside;
    double elapsed = 0;
    if (inside_a && inside_b) elapsed = along_perpendicular();
    // Parallel edges have no perpendicular of their own, and that of nearly parallel ones turns too fast.
    const bool by_edges = !(elapsed > left_) && !(inside_a && inside_b && surely_crossed());
    if (inside_b && by_edges) elapsed = std::max(elapsed, along(across_b()));
    if (inside_a && by_edges) elapsed = std::max(elapsed, along(across_a()));
    if (!inside_a && !inside_b) elapsed = along(between_points());
    return elapsed;
  }

  // Where two features meet, rounding may name the wrong one, and the next one takes over soon.
  double by_any() const {
    return std::max({along_perpendicular(), along(across_a()), along(across_b()), along(between_points())});
  }

 private:
  bool surely_crossed() const {
    constexpr double sine = 0.1;
    return squared_norm(sight_.closest.normal) >
           sine * sine * (squared_norm(sight_.along_a) * squared_norm(sight_.along_b));
  }

  double along(const Direction& direction) const {
    return std::max(over(direction), over(without_turn(direction)));
  }
  double over(const Direction& direction) const {
    return separated_for(sight_.corners, sight_.motions, direction, edges_.scale, edges_.reach);
  }

  // The common perpendicular, as it turns: along_a x along_b is quadratic in time. It is followed to the end
  // of the time for which it is seen to separate, then, less roughly, only for that time and a little more.
  double along_perpendicular() const {
    const double length = norm(sight_.closest.normal);
    if (!(length > 0)) return 0;
    const double scale = (dot(sight_.closest.normal, sight_.closest.offset) < 0 ? -1 : 1) / length;
    const Perpendicular perpendicular{
        scale * sight_.closest.normal,
        scale * (cross(edges_.along_a.displacement, sight_.along_b) +
                 cross(sight_.along_a, edges_.along_b.displacement)),
        scale * cross(edges_.along_a.displacement, edges_.along_b.displacement)};
    double elapsed = 0;
    double most = 1.01 * left_;
    for (int pass = 0; pass < 4; ++pass) {
      const double here = over(perpendicular, most);
      elapsed = std::max(elapsed, here);
      if (!(here > 0) || here >= 0.5 * most) break;
      most = 2 * here;
    }
    return elapsed > left_ ? elapsed : std::max(elapsed, over({perpendicular.towards, Vector3d{}}));
  }

  // A direction that is `towards`, a unit vector, + elapsed `turning` + elapsed^2 `bending`.
  struct Perpendicular {
    Vector3d towards, turning, bending;
  };

  // For how long, but no longer than `most`, all corners stay farther than the reach along it. Its length is
  // at most along + across^2 / (2 along), where along is its part along `towards`; this is kept above a half.
  double over(const Perpendicular& direction, double most) const {
    const double rounding = unit_roundoff * edges_.scale;
    const double nearest = edges_.reach + direction_roundings * rounding;
    const double growth = dot(direction.towards, direction.turning);
    const double second_growth = dot(direction.towards, direction.bending);
    if (growth < 0) most = std::min(most, -0.25 / growth);
    if (second_growth < 0) most = std::min(most, 0.5 / std::sqrt(-second_growth));
    const double shortest = 1 + std::min(growth, 0.0) * most + std::min(second_growth, 0.0) * most * most;
    const double turn = norm(direction.turning - growth * direction.towards) +
                        most * norm(direction.bending - second_growth * direction.towards);
    const double turning_rounding =
        turning_roundings * rounding * (norm(direction.turning) + most * norm(direction.bending));
    double elapsed = most;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3d& point = sight_.corners[k];
      const Vector3d& motion = sight_.motions[k];
      const double c = dot(direction.towards, point) - nearest;
      const double b = dot(direction.towards, motion) + dot(direction.turning, point) - nearest * growth -
                       turning_rounding;
      const double a = dot(direction.turning, motion) + dot(direction.bending, point) +
                       most * std::min(dot(direction.bending, motion), 0.0) -
                       nearest * (second_growth + turn * turn / (2 * shortest));
      elapsed = std::min(elapsed, positive_until(a, b, c));
    }
    return elapsed;
  }

  Direction across_a() const {
    return strictly_across(sight_.along_a, edges_.along_a.displacement, sight_.closest.offset);
  }
  Direction across_b() const {
    return strictly_across(sight_.along_b, edges_.along_b.displacement, sight_.closest.offset);
  }
  Direction between_points() const { return {normalized(sight_.closest.offset), Vector3d{}}; }

  const RelativeEdges& edges_;
  const SightOfEdges& sight_;
  double left_;  // of the step: no certificate need last longer
};

// An offset that is longer than so many roundings has a direction (to 1e-9), a shorter one may be all
// rounding.
constexpr double offset_roundings = 0x1p30;

struct TouchOfEdges {
  double time;
  ClosestSegments closest;
  Vector3d approach;  // from b to a when there last was a direction, or zero
};

// More certificates than usual: directions that cost more are tried as well.
constexpr int usual = 16;

// The time moves forward for as long as a direction separates.
std::optional<TouchOfEdges> first_touch(const RelativeEdges& edges) {
  const double rounding = unit_roundoff * edges.scale;
  const double directed = offset_roundings * rounding;
  double tolerance = touch_roundings * rounding;
  Vector3d approach{};
  SightOfEdges sight;
  for (std::size_t k = 0; k < 4; ++k) sight.motions[k] = edges.between[k].displacement;
  double time = 0;
  for (int count = 1;; ++count) {
    look(edges, time, sight);
    const ClosestSegments& closest = sight.closest;
    if (closest.squared_distance > directed * directed || is_zero(approach)) approach = closest.offset;
    const double touching = edges.reach + tolerance;
    if (closest.squared_distance <= touching * touching) return TouchOfEdges{time, closest, approach};
    const Certificates certificates(edges, sight, 1 - time);
    double until = time + certificates.by_feature() * kept_time;
    if (!(until > time) || (count > usual && until <= 1))
      until = std::max(until, time + certificates.by_any() * kept_time);
    if (until > 1) return std::nullopt;
    if (!(until > time)) return TouchOfEdges{time, closest, approach};  // no certificate: in doubt, contact
    time = until;
    if (count % patience == 0) tolerance *= 2;
  }
}

int side_before(const RelativeEdges& edges, const TouchOfEdges& touch) {
  if (is_zero(touch.closest.normal)) return 0;
  // Where an edge is long the scale bounds half of it.
  const double area = 0.25 * bound(edges.along_a) * bound(edges.along_b);
  return sign_before(volume(edges.between[0], edges.along_a, edges.along_b, edges.scale, area), touch.time);
}

Vector3d contact_normal(const RelativeEdges& edges, const TouchOfEdges& touch, int side) {
  const ClosestSegments& closest = touch.closest;
  const double directed = offset_roundings * unit_roundoff * edges.scale;
  if (closest.squared_distance > directed * directed) return unit_or(closest.offset, touch.approach);
  const bool both_inside =
      closest.features[0] == SegmentFeature::inside && closest.features[1] == SegmentFeature::inside;
  if (side != 0 && (both_inside || touch.time == 0)) return unit_or(side * closest.normal, touch.approach);
  return touch.time > 0 ? unit_or(touch.approach, closest.normal) : unit_or(closest.normal, touch.approach);
}

MovingEdgePair<double> edge_pair(const MovingEdge& a, const MovingEdge& b) {
  MovingEdgePair<double> pair;
  for (std::size_t k = 0; k < 2; ++k) {
    pair.start_a[k] = a.start[k];
    pair.displacement_a[k] = a.displacement[k];
    pair.start_b[k] = b.start[k];
    pair.displacement_b[k] = b.displacement[k];
  }
  return pair;
}

}  // namespace

double touch_tolerance(const MovingEdge& a, const MovingEdge& b) {
  return promised_roundings * unit_roundoff * relative_edges(a, b).scale;
}

std::optional<EdgeContact> edge_check(const MovingEdge& a, const MovingEdge& b) {
  assert(a.radius >= 0 && b.radius >= 0);
  if (surely_apart(edge_pair(a, b), a.radius + b.radius)) return std::nullopt;
  const RelativeEdges edges = relative_edges(a, b);
  const std::optional<TouchOfEdges> touch = first_touch(edges);
  if (!touch) return std::nullopt;
  const ClosestSegments& closest = touch->closest;
  const int side = side_before(edges, *touch);
  return EdgeContact{touch->time,
                     closest.parameters,
                     closest.features,
                     contact_normal(edges, *touch, side),
                     std::sqrt(closest.squared_distance),
                     side};
}

}  // namespace brio
