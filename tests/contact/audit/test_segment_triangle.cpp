/// The predicate of the audit judged by exact rational arithmetic (GMP) on pairs chosen to be difficult.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "contact/audit/orientation.hpp"
#include "contact/audit/segment_triangle.hpp"
#include "tests/contact/audit/adversarial_crossings.hpp"
#include "tests/contact/audit/exact_crossing.hpp"

namespace brio::test {
namespace {

constexpr int segments_of_family = 100000;  // of eleven: more than a million in all

SurfaceTriangle triangle_of(const SegmentAndTriangle& pair, const Continuation& continues) {
  return {pair.triangle[0], pair.triangle[1], pair.triangle[2], continues};
}

constexpr Continuation continued_everywhere{.edge = {true, true, true}, .corner = {true, true, true}};

Continuation any_continuation(Random& random) {
  Continuation continues;
  for (bool& edge : continues.edge) edge = random.coin();
  for (bool& corner : continues.corner) corner = random.coin();
  return continues;
}

TEST(AuditPredicate, AgreesWithExactArithmetic) {
  for (int family = 0; family < crossing_family_count; ++family) {
    Random random(static_cast<std::uint64_t>(family) + 1);
    int crossing = 0, touching = 0, wrong = 0;
    for (int i = 0; i < segments_of_family; ++i) {
      const SegmentAndTriangle pair = adversarial_crossing(static_cast<CrossingFamily>(family), random);
      const ExactCrossing exact = judge_crossing(pair.segment, pair.triangle);
      const Continuation continues = any_continuation(random);
      const bool expected = exact.crosses(continues);
      crossing += expected ? 1 : 0;
      touching += exact.crosses(continued_everywhere) && !exact.crosses({}) ? 1 : 0;
      const SurfaceTriangle triangle = triangle_of(pair, continues);
      wrong += crosses(pair.segment[0], pair.segment[1], triangle) != expected ? 1 : 0;
      wrong += crosses(pair.segment[1], pair.segment[0], triangle) != expected ? 1 : 0;
    }
    std::printf("%s: %d of %d cross, %d of them through an edge or a corner\n",
                std::string(name_of(static_cast<CrossingFamily>(family))).c_str(), crossing,
                segments_of_family, touching);
    EXPECT_EQ(wrong, 0) << name_of(static_cast<CrossingFamily>(family));
    EXPECT_GT(crossing, 0) << name_of(static_cast<CrossingFamily>(family));
    if (family == static_cast<int>(CrossingFamily::lattice)) {
      EXPECT_GT(touching, 100);
    }
  }
}

// What a search leaves out by the volumes alone must lie on one side for certain.
TEST(AuditPredicate, BoundsTheErrorOfVolumes) {
  Random random(77);
  int certain = 0;
  for (int i = 0; i < segments_of_family; ++i) {
    const auto family = static_cast<CrossingFamily>(random.integer(0, crossing_family_count - 1));
    const SegmentAndTriangle pair = adversarial_crossing(family, random);
    const SurfaceTriangle::Volume volume = triangle_of(pair, {}).volume(pair.segment[0]);
    if (std::abs(volume.value) <= volume.error) continue;
    ++certain;
    ASSERT_EQ(volume.value > 0 ? 1 : -1, judge_crossing(pair.segment, pair.triangle).start);
  }
  EXPECT_GT(certain, segments_of_family / 2);
}

TEST(AuditPredicate, OrientsTheSameWithAndWithoutFloatingPoint) {
  Random random(78);
  for (int i = 0; i < segments_of_family; ++i) {
    const auto family = static_cast<CrossingFamily>(random.integer(0, crossing_family_count - 1));
    const auto& [segment, triangle] = adversarial_crossing(family, random);
    const int known = exact_orientation(triangle[0], triangle[1], triangle[2], segment[0]);
    ASSERT_EQ(orientation(triangle[0], triangle[1], triangle[2], segment[0]), known);
    ASSERT_EQ(orientation(triangle[1], triangle[0], triangle[2], segment[0]), -known);
  }
}

// Moved by the depth along some direction nothing is crossed any more; by less along none of many.
TEST(AuditPredicate, DepthIsTheShortestTranslationThatEndsACrossing) {
  Random random(79);
  int crossing = 0;
  for (int i = 0; i < 2000; ++i) {
    const SegmentAndTriangle pair = adversarial_crossing(CrossingFamily::through_inside, random);
    const SurfaceTriangle triangle = triangle_of(pair, {});
    const auto& [from, to] = pair.segment;
    if (!crosses(from, to, triangle)) continue;
    ++crossing;
    const double depth = crossing_depth(from, to, triangle);
    std::vector<Vector3d> ways{normalized(triangle.area)};
    for (std::size_t k = 0; k < 3; ++k)
      ways.push_back(normalized(cross(to - from, triangle.corner[(k + 1) % 3] - triangle.corner[k])));
    bool ends = false;
    for (const Vector3d& way : ways)
      for (double sign : {-1.0, 1.0}) {
        const Vector3d by = sign * (1 + 1e-9) * depth * way;
        ends |= !crosses(from + by, to + by, triangle);
        const Vector3d less = sign * (1 - 1e-6) * depth * way;
        ASSERT_TRUE(crosses(from + less, to + less, triangle));
      }
    ASSERT_TRUE(ends);
    const Vector3d any = (1 - 1e-6) * depth * normalized(random.vector(1));
    ASSERT_TRUE(crosses(from + any, to + any, triangle));
  }
  EXPECT_GT(crossing, 1000);
}

}  // namespace
}  // namespace brio::test
