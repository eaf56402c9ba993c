#include "contact/closest_segments.hpp"

#include <algorithm>
#include <cmath>

#include "contact/closest_point.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

// Segments whose directions differ by fewer roundings are parallel: the rounding of their own differences.
constexpr double parallel_roundings = 4;
// Distances that differ by fewer roundings are the same, for parallel segments.
constexpr double distance_roundings = 8;

// a x b, right to about one rounding, and exactly the negative of b x a.
Vector3d antisymmetric_cross(const Vector3d& a, const Vector3d& b) {
  return 0.5 * (accurate_cross(a, b) - accurate_cross(b, a));
}

// The point closest to the origin on a segment from `first` to `second`.
struct Foot {
  double share;
  Vector3d offset;
};

Foot foot_of_origin(const Vector3d& first, const Vector3d& second, const Vector3d& along) {
  const double length_squared = along.squaredNorm();
  const double reach = -first.dot(along);
  if (reach <= 0 || length_squared == 0) return {0, first};
  if (reach >= length_squared) return {1, second};
  const double share = reach / length_squared;
  return {share, first + share * along};
}

SegmentFeature feature_at(double parameter) {
  return parameter <= 0   ? SegmentFeature::first_end
         : parameter >= 1 ? SegmentFeature::second_end
                          : SegmentFeature::inside;
}

ClosestSegments points_at(double on_a, double on_b, const Vector3d& offset) {
  return {{on_a, on_b}, {feature_at(on_a), feature_at(on_b)}, offset, Vector3d::Zero(), offset.squaredNorm()};
}

Vector3d offset_at(const SegmentPair& pair, double on_a, double on_b) {
  return pair.between[0][0] + (on_a * pair.along_a - on_b * pair.along_b);
}

// Every end against the other segment: one of these pairs is the closest unless both points are inside.
std::array<ClosestSegments, 4> feet_of_ends(const SegmentPair& pair) {
  std::array<ClosestSegments, 4> feet;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& c = pair.between;
    const Foot on_b = foot_of_origin(c[k][0], c[k][1], -pair.along_b);
    const Foot on_a = foot_of_origin(c[0][k], c[1][k], pair.along_a);
    feet[k] = points_at(static_cast<double>(k), on_b.share, on_b.offset);
    feet[k + 2] = points_at(on_a.share, static_cast<double>(k), on_a.offset);
  }
  return feet;
}

// How far a pair of points is from the ends.
double insideness(const ClosestSegments& points) {
  const auto& [s, t] = points.parameters;
  return s * (1 - s) + t * (1 - t);
}

// A choice among equals that is no matter of which edge is called a, nor of the order in which feet are
// tried.
bool closer(const ClosestSegments& points, const ClosestSegments& best) {
  if (points.squared_distance != best.squared_distance)
    return points.squared_distance < best.squared_distance;
  if (insideness(points) != insideness(best)) return insideness(points) > insideness(best);
  const Vector3d size = points.offset.cwiseAbs();
  const Vector3d best_size = best.offset.cwiseAbs();
  return std::lexicographical_compare(size.begin(), size.end(), best_size.begin(), best_size.end());
}

// The middle of those feet that are as close as the closest: the distance is a convex function, so it is no
// greater there.
ClosestSegments middle_of_shared(const SegmentPair& pair, const std::array<ClosestSegments, 4>& feet,
                                 const ClosestSegments& best) {
  const double lengths = pair.along_a.norm() + pair.along_b.norm();
  const double nearest = std::sqrt(best.squared_distance);
  const double limit = nearest + distance_roundings * unit_roundoff * (nearest + lengths);
  std::array<double, 2> least = best.parameters;
  std::array<double, 2> greatest = best.parameters;
  for (const ClosestSegments& foot : feet) {
    if (foot.squared_distance > limit * limit) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      least[k] = std::min(least[k], foot.parameters[k]);
      greatest[k] = std::max(greatest[k], foot.parameters[k]);
    }
  }
  const double on_a = 0.5 * (least[0] + greatest[0]);
  const double on_b = 0.5 * (least[1] + greatest[1]);
  if (feature_at(on_a) != SegmentFeature::inside || feature_at(on_b) != SegmentFeature::inside) return best;
  return points_at(on_a, on_b, offset_at(pair, on_a, on_b));
}

// How far the foot of the common perpendicular lies from the end at `offset` of one segment, along it, times
// the square of the normal.
double along_from(const Vector3d& offset, const Vector3d& along_other, const Vector3d& normal) {
  return -normal.dot(accurate_cross(offset, along_other));
}

// Takes out what is left of the offset at right angles to the normal: of directions that are nearly parallel
// the first parameters are good only to (1 / angle) roundings.
void refine(const SegmentPair& pair, double normal_squared, ClosestSegments& points) {
  const Vector3d normal = points.normal;
  const double resolution =
      4 * unit_roundoff *
      (pair.between[0][0].lpNorm<1>() + (pair.along_a.lpNorm<1>() + pair.along_b.lpNorm<1>()));
  for (int pass = 0; pass < 3; ++pass) {
    const Vector3d in_plane = points.offset - normal * (normal.dot(points.offset) / normal_squared);
    if (in_plane.lpNorm<Eigen::Infinity>() <= resolution) return;
    const double on_a = points.parameters[0] + along_from(in_plane, pair.along_b, normal) / normal_squared;
    const double on_b = points.parameters[1] + along_from(in_plane, pair.along_a, normal) / normal_squared;
    if (!(on_a > 0 && on_a < 1 && on_b > 0 && on_b < 1)) return;
    ClosestSegments better = points_at(on_a, on_b, offset_at(pair, on_a, on_b));
    better.normal = normal;
    if (!(better.squared_distance < points.squared_distance)) return;
    points = better;
  }
}

// The feet of the common perpendicular if both fall inside.
bool feet_inside(const SegmentPair& pair, const Vector3d& normal, double normal_squared,
                 ClosestSegments& points) {
  const double from_first_a = along_from(pair.between[0][0], pair.along_b, normal);
  const double from_second_a = -along_from(pair.between[1][0], pair.along_b, normal);
  const double from_first_b = along_from(pair.between[0][0], pair.along_a, normal);
  const double from_second_b = -along_from(pair.between[0][1], pair.along_a, normal);
  if (!(from_first_a > 0 && from_second_a > 0 && from_first_b > 0 && from_second_b > 0)) return false;
  const double on_a = from_first_a / (from_first_a + from_second_a);
  const double on_b = from_first_b / (from_first_b + from_second_b);
  points = points_at(on_a, on_b, offset_at(pair, on_a, on_b));
  points.normal = normal;
  refine(pair, normal_squared, points);
  return true;
}

}  // namespace

ClosestSegments closest_points_of_segments(const SegmentPair& pair) {
  const Vector3d normal = antisymmetric_cross(pair.along_a, pair.along_b);
  const double normal_squared = normal.squaredNorm();
  constexpr double parallel = parallel_roundings * unit_roundoff;
  const bool is_parallel =
      !(normal_squared > parallel * parallel * (pair.along_a.squaredNorm() * pair.along_b.squaredNorm()));
  const std::array<ClosestSegments, 4> feet = feet_of_ends(pair);
  ClosestSegments best = feet[0];
  for (std::size_t k = 1; k < 4; ++k)
    if (closer(feet[k], best)) best = feet[k];
  if (is_parallel) return middle_of_shared(pair, feet, best);
  ClosestSegments inside;
  if (feet_inside(pair, normal, normal_squared, inside) && inside.squared_distance <= best.squared_distance)
    return inside;
  best.normal = normal;
  return best;
}

ClosestSegments closest_points_of_segments(const Segment& a, const Segment& b) {
  return closest_points_of_segments(SegmentPair{
      {Segment{a[0] - b[0], a[0] - b[1]}, Segment{a[1] - b[0], a[1] - b[1]}}, a[1] - a[0], b[1] - b[0]});
}

}  // namespace brio
