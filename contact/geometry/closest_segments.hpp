#pragma once
/// Closest points of two segments, with the feature of each that they lie on: its inside or one of its ends.

#include <array>

#include "src/base/tensor.hpp"

namespace brio {

using Segment = std::array<Vector3d, 2>;

enum class SegmentFeature { first_end, inside, second_end };

struct ClosestSegments {
  std::array<double, 2> parameters;  // on a and on b: 0 at the first end, 1 at the second
  std::array<SegmentFeature, 2> features;
  Vector3d offset;  // from the point of b to the point of a
  Vector3d normal;  // (a1 - a0) x (b1 - b0); zero where they are parallel but for rounding
  double squared_distance;
};

/// The two segments as differences: exact negatives of each other if they change places.
struct SegmentPair {
  std::array<Segment, 2> between;  // between[i][j]: end i of a minus end j of b
  Vector3d along_a;                // from the first end to the second
  Vector3d along_b;
};

/// The points lie on the segments and are the closest within a few roundings of the distances and lengths
/// involved, also for parallel segments and such of no or hardly any length. Where parallel segments lie
/// side by side, the points are in the middle of what they share, inside both. If a and b change places so do
/// the results, to the bit, and so do they in another unit that is a power of two times this one.
ClosestSegments closest_points_of_segments(const Segment& a, const Segment& b);
ClosestSegments closest_points_of_segments(const SegmentPair& pair);

}  // namespace brio
