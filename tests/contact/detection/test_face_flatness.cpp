// Faces whose diagonals are no features of their own.

#include "contact/features/face_flatness.hpp"

#include <gtest/gtest.h>

#include <random>

namespace brio {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 4>;

Corners warped(double by) {
  return {Vector3d(0, 0, by), Vector3d(1, 0, 0), Vector3d(1, 1, by), Vector3d(0, 1, 0)};
}

TEST(Flatness, ThicknessIsThatBetweenTheDiagonals) {
  for (const double by : {0.0, 1e-3, -2e-2}) {
    EXPECT_GE(flat_slack(warped(by), std::abs(by) + 1e-9).least(), 0);
    EXPECT_NEAR(flat_slack(warped(by), std::abs(by) + 0.01).least(), 0.005, 1e-12);
    EXPECT_LT(flat_slack(warped(by), std::abs(by) - 1e-9).least(), 0);
  }
}

TEST(Flatness, IsNotOfFacesThatAreNotConvexOrHaveNoArea) {
  Corners dart = warped(0);
  for (std::size_t k = 0; k < 4; ++k) {
    Corners at = warped(0);
    at[k] = Vector3d(0.5, 0.5, 0) + 0.2 * (Vector3d(0.5, 0.5, 0) - at[k]);
    EXPECT_LT(flat_slack(at, 0.1).convex, 0) << k;
  }
  std::swap(dart[1], dart[2]);  // sides cross
  EXPECT_LT(flat_slack(dart, 0.1).convex, 0);
  const Corners line{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(2, 0, 0), Vector3d(3, 0, 0)};
  EXPECT_LT(flat_slack(line, 0.1).least(), 0);
}

// Corners that move by no more than the slack leave the face flat.
TEST(Flatness, LastsForTheSlack) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> value(-1, 1);
  const auto any = [&] { return Vector3d(value(random), value(random), value(random)); };
  const double thickness = 0.05;
  int tried = 0;
  for (int k = 0; k < 20000; ++k) {
    Corners at = warped(0.04 * value(random));
    for (Vector3d& x : at) x += 0.3 * Vector3d(value(random), value(random), 0.05 * value(random));
    const double slack = flat_slack(at, thickness).least();
    if (slack <= 0) continue;
    ++tried;
    for (Vector3d& x : at) x += slack * any().normalized();
    EXPECT_GE(flat_slack(at, thickness).least(), -1e-2 * slack);
  }
  EXPECT_GT(tried, 1000);
}

}  // namespace
}  // namespace brio
