/// What goes through a face at the start, judged by exact rational arithmetic (GMP) on pairs chosen to be
/// difficult.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/geometry/closest_point.hpp"
#include "contact/geometry/closest_segments.hpp"
#include "contact/pairs/piercing.hpp"
#include "tests/contact/audit/adversarial_crossings.hpp"
#include "tests/contact/audit/exact_crossing.hpp"

namespace brio::test {
namespace {

constexpr int pairs_of_family = 5000;
constexpr Continuation everywhere{.edge = {true, true, true}, .corner = {true, true, true}};

FaceVertices face_of(const SegmentAndTriangle& pair) {
  return {pair.triangle[0], pair.triangle[1], pair.triangle[2], pair.triangle[2]};
}

int times_found(const SegmentAndTriangle& pair) {
  const auto& [a, b] = pair.segment;
  return (passes_through(a, b, face_of(pair), true) ? 1 : 0) +
         (passes_through(b, a, face_of(pair), true) ? 1 : 0);
}

// Of what does not cross: between an end and the triangle, or the segment and a side.
double distance(const SegmentAndTriangle& pair) {
  double least = HUGE_VAL;
  for (const Vector3d& end : pair.segment)
    least = std::min(least, closest_point_on_triangle(end, pair.triangle).squared_distance);
  for (std::size_t k = 0; k < 3; ++k)
    least = std::min(least,
                     closest_points_of_segments(pair.segment, {pair.triangle[k], pair.triangle[(k + 1) % 3]})
                         .squared_distance);
  return std::sqrt(least);
}

double size_of(const SegmentAndTriangle& pair) {
  double size = 0;
  for (const Vector3d& end : pair.segment)
    for (const Vector3d& corner : pair.triangle) size = std::max(size, norm(end - corner));
  return size;
}

TEST(Piercing, FindsAllThatCrossesAndNothingThatIsApart) {
  for (int family = 0; family < crossing_family_count; ++family) {
    Random random(static_cast<std::uint64_t>(family) + 101);
    int missed = 0, invented = 0, crossing = 0;
    for (int i = 0; i < pairs_of_family; ++i) {
      const SegmentAndTriangle pair = adversarial_crossing(static_cast<CrossingFamily>(family), random);
      const bool crosses = judge_crossing(pair.segment, pair.triangle).crosses(everywhere);
      const int found = times_found(pair);  // of both ways
      crossing += crosses ? 1 : 0;
      missed += crosses && found < 2 ? 1 : 0;
      invented += !crosses && found > 0 && distance(pair) > 1e-9 * size_of(pair) ? 1 : 0;
    }
    EXPECT_EQ(missed, 0) << name_of(static_cast<CrossingFamily>(family));
    EXPECT_EQ(invented, 0) << name_of(static_cast<CrossingFamily>(family));
    EXPECT_GT(crossing, 0) << name_of(static_cast<CrossingFamily>(family));
  }
}

}  // namespace
}  // namespace brio::test
