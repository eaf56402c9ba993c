/// Closest points of segments, against exact arithmetic and the scalar function, and under exchange.

#include "contact/geometry/closest_on_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "tests/contact/detection/exact_distance.hpp"
#include "tests/contact/detection/packs.hpp"
#include "tests/contact/detection/still_queries.hpp"
#include "tests/core/floating_point_traps.hpp"

namespace brio {
namespace {

ClosestOnSegments<double> closest(const Segment& a, const Segment& b) {
  return closest_on_segments(a[0], a[1], b[0], b[1]);
}
double largest_difference(const SegmentQuery& query) {
  double largest = 0;
  for (std::size_t k = 0; k < 4; ++k)
    largest = std::max(largest, maximum_norm(query.a[k / 2] - query.b[k % 2]));
  return largest;
}
Vector3d offset_by_parameters(const SegmentQuery& query, double on_a, double on_b) {
  Vector3d offset;
  for (int i = 0; i < 3; ++i) {
    const long double a0 = query.a[0][i], a1 = query.a[1][i], b0 = query.b[0][i], b1 = query.b[1][i];
    offset[i] = static_cast<double>((a0 - b0) + (on_a * (a1 - a0) - on_b * (b1 - b0)));
  }
  return offset;
}

constexpr double roundings = 10;

void judge(std::uint64_t seed, int queries) {
  Random random(seed);
  for (int i = 0; i < queries; ++i) {
    const test::FloatingPointTraps traps;
    const SegmentQuery query = any_segment_query(random);
    const auto result = closest(query.a, query.b);
    const double rounding = roundings * unit_roundoff * largest_difference(query);
    const double distance = std::sqrt(result.squared_distance);
    const double lengths = norm(query.a[1] - query.a[0]) + norm(query.b[1] - query.b[0]);
    const double same = result.parallel ? parallel_resolution * unit_roundoff * (distance + lengths) : 0;
    EXPECT_TRUE(std::min(result.on_a, result.on_b) >= 0 && std::max(result.on_a, result.on_b) <= 1);
    EXPECT_LE(maximum_norm(offset_by_parameters(query, result.on_a, result.on_b) - result.offset), rounding);
    EXPECT_LE(std::abs(norm(result.offset) - distance), 4 * unit_roundoff * distance);
    const exact::SquaredDistance truth = exact::between_segments(query.a, query.b);
    EXPECT_TRUE(truth.at_most(distance + rounding));
    EXPECT_TRUE(truth.at_least(distance - rounding - same));
    if (testing::Test::HasFailure()) FAIL() << i;
  }
}

TEST(ClosestOnSegments, RightToRoundingByExactArithmetic) { judge(62, 40000); }
TEST(ClosestOnSegmentsSlow, RightToRoundingByExactArithmetic) { judge(62, 300000); }

TEST(ClosestOnSegments, LanesExchangeAndMirrorGiveTheSameBits) {
  Random random(64);
  const test::FloatingPointTraps traps;
  const Vector3d mirror{1, -1, 1};
  const auto mirrored = [&](const Segment& s) {
    return Segment{componentwise_product(s[0], mirror), componentwise_product(s[1], mirror)};
  };
  for (int i = 0; i < 20000; ++i) {
    std::array<SegmentQuery, 8> queries;
    std::array<Vector3<Pack>, 4> ends;
    for (int lane = 0; lane < 8; ++lane) {
      SegmentQuery& query = queries[index(lane)];
      query = any_segment_query(random);
      for (std::size_t k = 0; k < 2; ++k) {
        put(ends[k], lane, query.a[k]);
        put(ends[k + 2], lane, query.b[k]);
      }
    }
    const auto packed = closest_on_segments(ends[0], ends[1], ends[2], ends[3]);
    for (int lane = 0; lane < 8; ++lane) {
      const SegmentQuery& query = queries[index(lane)];
      const auto result = closest(query.a, query.b);
      ASSERT_TRUE(same_bits(packed.offset, lane, result.offset)) << i;
      ASSERT_TRUE(same_bits(packed.on_a[lane], result.on_a)) << i;
      ASSERT_TRUE(same_bits(packed.on_b[lane], result.on_b)) << i;
      ASSERT_TRUE(same_bits(packed.squared_distance[lane], result.squared_distance)) << i;
      ASSERT_EQ(in_lane(packed.parallel, lane), result.parallel) << i;
      const auto exchanged = closest(query.b, query.a);
      ASSERT_EQ(exchanged.on_a, result.on_b) << i;
      ASSERT_EQ(exchanged.on_b, result.on_a) << i;
      ASSERT_EQ(exchanged.offset, -result.offset) << i;
      ASSERT_EQ(exchanged.squared_distance, result.squared_distance) << i;
      const auto seen = closest(mirrored(query.a), mirrored(query.b));
      ASSERT_EQ(seen.on_a, result.on_a) << i;
      ASSERT_EQ(seen.offset, componentwise_product(result.offset, mirror)) << i;
    }
  }
}

TEST(ClosestOnSegments, ParallelOnesMeetInTheMiddleOfWhatTheyShare) {
  Random random(65);
  int parallel = 0;
  for (int i = 0; i < 50000; ++i) {
    const Vector3d along = random.vector(1);
    const double first = random.uniform(-1.5, 1.5);
    const double second = random.uniform(-1.5, 1.5);
    const Vector3d aside = random.coin() ? cross(random.vector(1), along) : Vector3d{0, 0, 0};
    const Segment a = {random.vector(1), {}};
    const Segment whole = {a[0], a[0] + along};
    const Segment b = {a[0] + first * along + aside, a[0] + second * along + aside};
    const double low = std::max(0.0, std::min(first, second));
    const double high = std::min(1.0, std::max(first, second));
    if (high - low < 0.01 || norm(along) < 0.1) continue;
    const auto result = closest(whole, b);
    if (!result.parallel) continue;  // coordinates are rounded
    ++parallel;
    ASSERT_NEAR(result.on_a, 0.5 * (low + high), 1e-13) << i;
    ASSERT_NEAR(result.on_b, (0.5 * (low + high) - first) / (second - first), 1e-11) << i;
  }
  EXPECT_GT(parallel, 1000);
}

TEST(ClosestOnSegments, WithoutLengthTheyArePoints) {
  const Segment along_x = {Vector3d{0, 0, 0}, Vector3d{4, 0, 0}};
  const Segment above = {Vector3d{1, 0, 2}, Vector3d{1, 0, 2}};
  const Segment below = {Vector3d{1, 0, -1}, Vector3d{1, 0, -1}};
  EXPECT_EQ(closest(along_x, above).on_a, 0.25);
  EXPECT_EQ(closest(along_x, above).offset, (Vector3d{0, 0, -2}));
  EXPECT_EQ(closest(above, below).offset, (Vector3d{0, 0, 3}));
  EXPECT_TRUE(closest(above, below).parallel);
}

}  // namespace
}  // namespace brio
