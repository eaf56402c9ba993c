#include "contact/geometry/closest_segments.hpp"

#include "contact/geometry/closest_on_segments.hpp"
#include "contact/geometry/closest_point.hpp"
#include "src/base/tensor.hpp"

namespace brio {

namespace {

// a x b, right to about one rounding, and exactly the negative of b x a.
Vector3d antisymmetric_cross(const Vector3d& a, const Vector3d& b) {
  return 0.5 * (accurate_cross(a, b) - accurate_cross(b, a));
}

SegmentFeature feature_at(double parameter) {
  return parameter <= 0   ? SegmentFeature::first_end
         : parameter >= 1 ? SegmentFeature::second_end
                          : SegmentFeature::inside;
}

}  // namespace

ClosestSegments closest_points_of_segments(const SegmentPair& pair) {
  const auto between = [&](std::size_t i, std::size_t j) { return pair.between[i][j]; };
  const ClosestOnSegments<double> found = closest_on_segments(SegmentDifferences<double>{
      between(0, 0), between(0, 1), between(1, 0), between(1, 1), pair.along_a, pair.along_b});
  const Vector3d normal = found.parallel ? Vector3d{} : antisymmetric_cross(pair.along_a, pair.along_b);
  return {{found.on_a, found.on_b},
          {feature_at(found.on_a), feature_at(found.on_b)},
          found.offset,
          normal,
          found.squared_distance};
}

ClosestSegments closest_points_of_segments(const Segment& a, const Segment& b) {
  return closest_points_of_segments(SegmentPair{
      {Segment{a[0] - b[0], a[0] - b[1]}, Segment{a[1] - b[0], a[1] - b[1]}}, a[1] - a[0], b[1] - b[0]});
}

}  // namespace brio
