// Flat faces and sides, whose edges are no features of their own.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

// An edge at a corner of a flat face, up to twice as long as the longer diagonal, is two skins from the plane
// of the corner where it leaves the face. Before, it passes over the other diagonal, not under it.
TEST(Flatness, EdgesAtACornerPassOverTheDiagonal) {
  constexpr double skin = 0.01;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(-1, 1);
  int flat = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    Quad at = warped(0);
    for (Point& x : at) x = x + Point{0.5 * value(random), 0.5 * value(random), 0.4 * skin * value(random)};
    if (flat_hull(at).slack(0.5 * skin) < 0) continue;
    ++flat;
    const Point first = at[2] - at[0], second = at[3] - at[1], across = cross(first, second);
    const double longest = std::max(norm(first), norm(second));
    for (std::size_t k = 0; k < 4; ++k) {
      const Point& begin = at[(k + 1) % 4];
      const Point way = begin + 0.5 * (1 + value(random)) * (at[(k + 3) % 4] - begin) - at[k];
      const double rise = dot(way, across) / norm(across),
                   length = std::sqrt(squared_norm(way) - rise * rise);
      EXPECT_GT(2 * skin * length / (2 * longest), std::abs(rise));
    }
  }
  EXPECT_GT(flat, 10000);
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
