/// Closest points of two segments: region by region, against an exhaustive search and exact arithmetic, and
/// under exchange, reflection, rotation and another unit.

#include "contact/geometry/closest_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/contact/geometry/adversarial_edges.hpp"
#include "tests/contact/geometry/exact_edges.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {
using enum SegmentFeature;

const Segment along_x = {Vector3d{0, 0, 0}, Vector3d{4, 0, 0}};

struct Expected {
  Segment b;
  std::array<double, 2> parameters;
  std::array<SegmentFeature, 2> features;
  Vector3d offset;
};

void expect_points(const Expected& expected) {
  const ClosestSegments closest = closest_points_of_segments(along_x, expected.b);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(closest.parameters[k], expected.parameters[k], 1e-15);
    EXPECT_EQ(closest.features[k], expected.features[k]);
  }
  EXPECT_NEAR(norm(closest.offset - expected.offset), 0, 1e-15);
  EXPECT_NEAR(closest.squared_distance, squared_norm(expected.offset), 1e-14);
}

TEST(ClosestSegments, Regions) {
  expect_points({{Vector3d{1, -1, 2}, Vector3d{1, 3, 2}}, {0.25, 0.25}, {inside, inside}, {0, 0, -2}});
  expect_points({{Vector3d{1, 1, 2}, Vector3d{1, 3, 5}}, {0.25, 0}, {inside, first_end}, {0, -1, -2}});
  expect_points({{Vector3d{3, -3, 0}, Vector3d{3, -1, 0}}, {0.75, 1}, {inside, second_end}, {0, 1, 0}});
  expect_points({{Vector3d{-1, -1, 1}, Vector3d{-1, 3, 1}}, {0, 0.25}, {first_end, inside}, {1, 0, -1}});
  expect_points({{Vector3d{5, -1, 0}, Vector3d{5, 1, 0}}, {1, 0.5}, {second_end, inside}, {-1, 0, 0}});
  expect_points({{Vector3d{-2, 1, 0}, Vector3d{-1, 1, 0}}, {0, 1}, {first_end, second_end}, {1, -1, 0}});
  expect_points({{Vector3d{6, 1, 1}, Vector3d{7, 2, 3}}, {1, 0}, {second_end, first_end}, {-2, -1, -1}});
  expect_points({{Vector3d{1, -1, 0}, Vector3d{1, 1, 0}}, {0.25, 0.5}, {inside, inside}, {0, 0, 0}});
}

TEST(ClosestSegments, ParallelOnesMeetInTheMiddleOfWhatTheyShare) {
  expect_points({{Vector3d{2, 0, 3}, Vector3d{6, 0, 3}}, {0.75, 0.25}, {inside, inside}, {0, 0, -3}});
  expect_points({{Vector3d{6, 0, 3}, Vector3d{2, 0, 3}}, {0.75, 0.75}, {inside, inside}, {0, 0, -3}});
  expect_points({{Vector3d{1, 1, 0}, Vector3d{2, 1, 0}}, {0.375, 0.5}, {inside, inside}, {0, -1, 0}});
  expect_points({{Vector3d{3, 0, 0}, Vector3d{9, 0, 0}}, {0.875, 1.0 / 12}, {inside, inside}, {0, 0, 0}});
  expect_points({{Vector3d{4, 0, 0}, Vector3d{9, 0, 0}}, {1, 0}, {second_end, first_end}, {0, 0, 0}});
  expect_points({{Vector3d{5, 0, 1}, Vector3d{9, 0, 1}}, {1, 0}, {second_end, first_end}, {-1, 0, -1}});
}

TEST(ClosestSegments, WithoutLengthTheyArePoints) {
  const Vector3d above{1, 0, 2};
  const ClosestSegments to_point = closest_points_of_segments(along_x, {above, above});
  EXPECT_EQ(to_point.parameters[0], 0.25);
  EXPECT_EQ(to_point.offset, (Vector3d{0, 0, -2}));
  const ClosestSegments points =
      closest_points_of_segments({above, above}, {Vector3d{1, 0, 0}, Vector3d{1, 0, 0}});
  EXPECT_EQ(points.offset, (Vector3d{0, 0, 2}));
  EXPECT_EQ(points.normal, (Vector3d{0, 0, 0}));
}

EdgeQuery any_edges(Random& random) {
  return adversarial_edges(static_cast<EdgeFamily>(random.integer(0, edge_family_count - 1)), random);
}

// Least distance by a grid over both parameters that closes in on its best point.
double searched_distance(const Segment& a, const Segment& b) {
  double s0 = 0.5;
  double t0 = 0.5;
  double best = 1e300;
  for (double reach = 0.5; reach > 1e-9; reach *= 0.5) {
    double s_best = s0;
    double t_best = t0;
    for (int i = -8; i <= 8; ++i) {
      for (int j = -8; j <= 8; ++j) {
        const double s = std::clamp(s0 + reach * i / 8, 0.0, 1.0);
        const double t = std::clamp(t0 + reach * j / 8, 0.0, 1.0);
        const double distance = norm(((1 - s) * a[0] + s * a[1]) - ((1 - t) * b[0] + t * b[1]));
        if (distance >= best) continue;
        best = distance;
        s_best = s;
        t_best = t;
      }
    }
    s0 = s_best;
    t0 = t_best;
  }
  return best;
}

TEST(ClosestSegments, NoPointsAreCloser) {
  Random random(31);
  for (int i = 0; i < 300; ++i) {
    Segment a = {random.vector(1), random.vector(1)};
    Segment b = {random.vector(1), random.vector(1)};
    if (random.integer(0, 2) == 0) b[1] = b[0] + random.uniform(-1, 1) * (a[1] - a[0]);
    if (random.integer(0, 2) == 0) a[1] = a[0] + random.power_of_ten(-12, 0) * (a[1] - a[0]);
    const double distance = std::sqrt(closest_points_of_segments(a, b).squared_distance);
    const double searched = searched_distance(a, b);
    EXPECT_LE(distance, searched + 1e-15) << i;
    EXPECT_GE(distance, searched - 1e-6) << i;
  }
}

// Ten roundings of the largest distance between two ends.
TEST(ClosestSegments, RightToRoundingByExactArithmetic) {
  Random random(32);
  for (int i = 0; i < 30000; ++i) {
    const EdgeQuery query = any_edges(random);
    MovingEdge a{query.a.start, {Vector3d{}, Vector3d{}}};
    MovingEdge b{query.b.start, {Vector3d{}, Vector3d{}}};
    double scale = 0;
    for (std::size_t k = 0; k < 4; ++k)
      scale = std::max(scale, maximum_norm(a.start[k / 2] - b.start[k % 2]));
    const double rounding = 10 * 0x1p-53 * scale;
    const ClosestSegments closest = closest_points_of_segments(a.start, b.start);
    const double distance = std::sqrt(closest.squared_distance);
    EXPECT_TRUE(exact::within(a, b, 0, distance + rounding)) << i;
    EXPECT_TRUE(exact::points_within(a, b, closest.parameters, 0, distance + rounding)) << i;
    if (distance > 2 * rounding) {
      EXPECT_FALSE(exact::within(a, b, 0, distance - rounding)) << i;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const double parameter = closest.parameters[k];
      const SegmentFeature feature = parameter == 0 ? first_end : parameter == 1 ? second_end : inside;
      EXPECT_TRUE(parameter >= 0 && parameter <= 1 && closest.features[k] == feature) << i;
    }
  }
}

void expect_same(const ClosestSegments& a, const ClosestSegments& b) {
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.features, b.features);
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.squared_distance, b.squared_distance);
}

TEST(ClosestSegments, ExchangeMirrorAndUnitGiveTheSameBits) {
  Random random(33);
  for (int i = 0; i < 20000; ++i) {
    const EdgeQuery query = any_edges(random);
    const Segment& a = query.a.start;
    const Segment& b = query.b.start;
    const ClosestSegments closest = closest_points_of_segments(a, b);

    ClosestSegments exchanged = closest_points_of_segments(b, a);
    std::swap(exchanged.parameters[0], exchanged.parameters[1]);
    std::swap(exchanged.features[0], exchanged.features[1]);
    exchanged.offset = -exchanged.offset;
    exchanged.normal = -exchanged.normal;
    expect_same(closest, exchanged);

    const Vector3d mirror{1, -1, 1};
    const auto seen = [&](const Segment& s) {
      return Segment{componentwise_product(s[0], mirror), componentwise_product(s[1], mirror)};
    };
    ClosestSegments mirrored = closest_points_of_segments(seen(a), seen(b));
    mirrored.offset = componentwise_product(mirrored.offset, mirror);
    mirrored.normal = -componentwise_product(mirrored.normal, mirror);
    expect_same(closest, mirrored);

    const double unit = 0x1p-30;
    ClosestSegments other =
        closest_points_of_segments({unit * a[0], unit * a[1]}, {unit * b[0], unit * b[1]});
    other.offset /= unit;
    other.normal /= unit * unit;
    other.squared_distance /= unit * unit;
    expect_same(closest, other);
    if (testing::Test::HasFailure()) FAIL() << i;
  }
}

TEST(ClosestSegments, TurnsAndMovesWithTheSegments) {
  Random random(34);
  for (int i = 0; i < 2000; ++i) {
    const Segment a = {random.vector(1), random.vector(1)};
    const Segment b = {random.vector(1), random.vector(1)};
    const Tensor<double> turn = rotation_matrix(normalized(
        Quaternion<double>{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 1.1}));
    const ClosestSegments closest = closest_points_of_segments(a, b);
    const ClosestSegments turned =
        closest_points_of_segments({turn * a[0], turn * a[1]}, {turn * b[0], turn * b[1]});
    const double sine = norm(closest.normal) / (norm(a[1] - a[0]) * norm(b[1] - b[0]));
    EXPECT_NEAR(norm(turned.offset - turn * closest.offset), 0, 1e-15 / sine) << i;
    EXPECT_NEAR(std::sqrt(turned.squared_distance), std::sqrt(closest.squared_distance), 4e-15) << i;
    // Far away, by a shift that keeps all digits.
    Segment near_a, near_b, far_a, far_b;
    for (std::size_t k = 0; k < 2; ++k) {
      near_a[k] = rounded_to(a[k], 1.0 / 1024);
      near_b[k] = rounded_to(b[k], 1.0 / 1024);
      far_a[k] = near_a[k] + Vector3d{1048576, -2097152, 4194304};
      far_b[k] = near_b[k] + Vector3d{1048576, -2097152, 4194304};
    }
    expect_same(closest_points_of_segments(near_a, near_b), closest_points_of_segments(far_a, far_b));
  }
}

}  // namespace
}  // namespace brio
