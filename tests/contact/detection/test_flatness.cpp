// Flat faces and sides, whose edges are no features of their own.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "contact/detection/crossing_check.hpp"
#include "contact/features/flat_hull.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using Point = Vector3d;
using Quad = std::array<Point, 4>;

constexpr double thickness = 0.05;

Quad warped(double by) { return {Point{0, 0, by}, Point{1, 0, 0}, Point{1, 1, by}, Point{0, 1, 0}}; }

TEST(Flatness, ThicknessIsThatBetweenTheDiagonals) {
  for (const double by : {0.0, 1e-3, -2e-2}) {
    EXPECT_NEAR(flat_hull(warped(by)).thickness, std::abs(by), 1e-12);
    EXPECT_NEAR(flat_hull(warped(by)).slack(std::abs(by) + 0.01), 0.004, 1e-12);
    EXPECT_LT(flat_hull(warped(by)).slack(std::abs(by) - 1e-9), 0);
  }
}

TEST(Flatness, IsNotOfFacesThatAreNotConvexOrHaveNoArea) {
  Quad dart = warped(0);
  for (std::size_t k = 0; k < 4; ++k) {
    Quad at = warped(0);
    const Point middle{0.5, 0.5, 0};
    at[k] = middle + 0.2 * (middle - at[k]);
    EXPECT_LT(flat_hull(at).unfolded, 0) << k;
  }
  std::swap(dart[1], dart[2]);  // sides cross
  EXPECT_LT(flat_hull(dart).unfolded, 0);
  const Quad line{Point{0, 0, 0}, Point{1, 0, 0}, Point{2, 0, 0}, Point{3, 0, 0}};
  EXPECT_LT(flat_hull(line).slack(0.1), 0);
}

// Of a rectangle of 1 by 4 the corners are nearer to the diagonals than in a square, over the diagonal.
TEST(Flatness, OfANarrowFaceIsThinner) {
  const auto rectangle = [](double by) {
    return Quad{Point{0, 0, by}, Point{4, 0, 0}, Point{4, 1, by}, Point{0, 1, 0}};
  };
  const double share = 2 * 4 / 17.0;
  EXPECT_NEAR(flat_hull(rectangle(0)).slack(0.1), 0.4 * 0.1 * share, 1e-12);
  EXPECT_GT(flat_hull(rectangle(0.1 * share * 0.999)).slack(0.1), 0);
  EXPECT_LT(flat_hull(rectangle(0.1 * share * 1.001)).slack(0.1), 0);
}

/// The hull of a face over its mean plane, and where edges over it begin and end.
class OverFace {
 public:
  OverFace(const Quad& at, const Point& up) : at_(at), up_(up) {}

  const Point& corner(std::mt19937& random) const { return at_[random() % 4]; }
  /// That high above a point of the hull: any one, most often on the rim.
  Point above(std::mt19937& random, double height) const {
    std::uniform_real_distribution<double> value(-0.5, 1.5);
    const Point x = point({std::clamp(value(random), 0.0, 1.0), std::clamp(value(random), 0.0, 1.0)});
    return x + (top(x) + height) * up_;
  }

 private:
  Point point(const std::array<double, 2>& uv) const {
    const auto [u, v] = uv;
    return (1 - v) * ((1 - u) * at_[0] + u * at_[1]) + v * ((1 - u) * at_[3] + u * at_[2]);
  }
  // Of the hull above a point near it: the higher one of both pairs of triangles.
  double top(const Point& x) const {
    double highest = -HUGE_VAL;
    for (const std::size_t first : {0, 1}) {
      const Point &a = at_[first], &c = at_[first + 2];
      const bool beyond = dot(cross(c - a, x - a), up_) < 0;
      const Point normal = cross(c - a, at_[beyond ? (first + 1) % 4 : (first + 3) % 4] - a);
      highest = std::max(highest, dot(a - x, normal) / dot(up_, normal));
    }
    return highest;
  }

  const Quad& at_;
  Point up_;
};

// How far a segment is above another where they cross as seen along a direction; none: they do not.
std::optional<double> height_above(const std::array<Point, 2>& upper, const std::array<Point, 2>& lower,
                                   const Point& up) {
  const Point a = upper[1] - upper[0], b = lower[1] - lower[0], between = lower[0] - upper[0];
  const double area = dot(cross(a, b), up);
  const double s = dot(cross(between, b), up) / area, t = dot(cross(between, a), up) / area;
  constexpr double end = 1e-9;
  if (!(s > end && s < 1 - end && t > end && t < 1 - end)) return {};
  return dot(upper[0] + s * a - lower[0] - t * b, up);
}

SurfaceFeatures features_with(double skin) {
  SurfaceFeatures features;
  features.skin = skin;
  return features;
}

// Edges that end at a corner of a flat face, or keep the least distance from its hull and its sides, pass
// over its diagonals too.
TEST(Flatness, EdgesThatKeepTheLeastDistancePassOverDiagonals) {
  const SurfaceFeatures features = features_with(0.01);
  const double least = least_distance(features, 0.0), flat = flat_thickness(features, 0, Flatness::all);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(-1, 1);
  int crossed = 0;
  double lowest = HUGE_VAL;
  for (int trial = 0; trial < 400000; ++trial) {
    Quad at = warped(0);
    for (Point& x : at) x = x + Point{0.5 * value(random), 0.5 * value(random), flat * value(random)};
    if (flat_hull(at).slack(flat) < 0) continue;
    const Point normal = cross(at[2] - at[0], at[3] - at[1]),
                up = (trial % 2 == 0 ? 1 : -1) / norm(normal) * normal;
    const OverFace over(at, up);
    const std::array edge{trial % 3 == 0 ? over.corner(random) : over.above(random, least),
                          over.above(random, least)};
    for (const std::size_t k : {0, 1})
      if (const auto height = height_above(edge, {at[k], at[k + 2]}, up)) {
        ++crossed;
        lowest = std::min(lowest, *height);
      }
  }
  EXPECT_GT(lowest, 0);
  EXPECT_LT(lowest, 0.05 * least) << "the rule is no stricter than it has to be";
  EXPECT_GT(crossed, 50000);
}

// Edges up to 1.1 times as long as the narrower face is wide, which is what lengths measured now and then
// allow, that end over both faces of a flat side, or at corners of them, pass over the side.
TEST(Flatness, EdgesThatKeepTheLeastDistancePassOverFlatSides) {
  const SurfaceFeatures features = features_with(0.01);
  const double least = least_distance(features, 0.0), flat = flat_thickness(features, 0, Flatness::all);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  int crossed = 0;
  double lowest = HUGE_VAL;
  for (int trial = 0; trial < 600000; ++trial) {
    // Corners of the first face from the side on, and of the second.
    std::array<Point, 6> at{Point{0, 0, 0},  Point{0, 1, 0}, Point{-1, 0, 0},
                            Point{-1, 1, 0}, Point{1, 0, 0}, Point{1, 1, 0}};
    for (Point& x : at) x = x + Point{0.3 * value(random), 0.3 * value(random), flat * value(random)};
    const Quad first{at[0], at[1], at[3], at[2]}, second{at[1], at[0], at[4], at[5]};
    if (flat_hull(at).slack(flat) < 0 || flat_hull(first).slack(flat) < 0 ||
        flat_hull(second).slack(flat) < 0)
      continue;
    const Point along = at[1] - at[0], normal = cross(0.5 * ((at[4] + at[5]) - (at[2] + at[3])), along),
                up = (trial % 2 == 0 ? 1 : -1) / norm(normal) * normal;
    const auto area = [](const Quad& q) { return 0.5 * norm(cross(q[2] - q[0], q[3] - q[1])); };
    const double width = std::min(area(first), area(second)) / norm(along);
    const OverFace over_first(first, up), over_second(second, up);
    const std::array edge{trial % 3 == 0 ? at[2 + trial / 3 % 2] : over_first.above(random, least),
                          over_second.above(random, least)};
    if (norm(edge[1] - edge[0]) > 1.1 * width) continue;
    if (const auto height = height_above(edge, {at[0], at[1]}, up)) {
      ++crossed;
      lowest = std::min(lowest, *height);
    }
  }
  EXPECT_GT(lowest, 0);
  EXPECT_GT(crossed, 5000);
}

// Two faces of widths 1 and 2 at a side of length 1, bent by an angle.
std::array<Point, 6> bent(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {Point{0, 0, 0},  Point{0, 1, 0},         Point{-1, 0, 0},
          Point{-1, 1, 0}, Point{2 * c, 0, 2 * s}, Point{2 * c, 1, 2 * s}};
}

// Of a bent side the height of the triangle of both widths.
TEST(Flatness, ThicknessOfASideIsThatOfItsBend) {
  for (const double angle : {0.0, 1e-3, 0.2, -0.5, 1.5}) {
    const double base = std::sqrt(5 + 4 * std::cos(angle));
    EXPECT_NEAR(flat_hull(bent(angle)).thickness, 2 * std::abs(std::sin(angle)) / base, 1e-12) << angle;
  }
  EXPECT_NEAR(flat_hull(bent(0)).slack(0.1), 0.04, 1e-12);
  EXPECT_NEAR(flat_hull(bent(0)).slack(0.24), 0.01, 1e-12) << "the narrow face may fold over";
}

TEST(Flatness, IsNotOfASideWithBothFacesOnOneSide) {
  EXPECT_LT(flat_hull(bent(3.14159)).slack(0.1), 0);
  std::array<Point, 6> no_area = bent(0);
  no_area[1] = no_area[0];
  EXPECT_LT(flat_hull(no_area).slack(0.1), 0);
}

// Corners that move by no more than the slack leave a shape flat.
template <class Shape, class Check>
void expect_slack_lasts(const Shape& flat, const Check& check) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> value(-1, 1);
  int tried = 0;
  for (int k = 0; k < 40000; ++k) {
    Shape at = flat;
    for (Point& x : at) x = x + Point{0.3 * value(random), 0.3 * value(random), 0.03 * value(random)};
    const double slack = flat_hull(at).slack(thickness);
    if (slack <= 0) continue;
    ++tried;
    Shape moved = at;
    for (Point& x : moved) {
      const Point way{value(random), value(random), value(random)};
      x = x + slack / std::sqrt(dot(way, way)) * way;
    }
    ASSERT_NO_FATAL_FAILURE(check(at, moved, slack));
  }
  EXPECT_GT(tried, 1000);
}

TEST(Flatness, LastsForTheSlack) {
  expect_slack_lasts(warped(0), [](const Quad&, const Quad& moved, double slack) {
    ASSERT_GE(flat_hull(moved).slack(thickness), -1e-2 * slack);
  });
}

// Between planes at right angles to the normal before, with both faces on their sides.
TEST(Flatness, OfASideLastsForTheSlack) {
  using Side = std::array<Point, 6>;
  expect_slack_lasts(bent(0), [](const Side& at, const Side& moved, double) {
    const Point along = at[1] - at[0], normal = cross(0.5 * ((at[4] + at[5]) - (at[2] + at[3])), along);
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (const Point& x : moved) {
      const double height = dot(x, normal) / std::sqrt(dot(normal, normal));
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    ASSERT_LE(highest - lowest, thickness * (1 + 1e-9));
    const Point outward = cross(moved[1] - moved[0], normal);
    for (std::size_t k = 2; k < 6; ++k) ASSERT_GT((k < 4 ? -1 : 1) * dot(moved[k] - moved[0], outward), 0);
  });
}

}  // namespace
}  // namespace brio
