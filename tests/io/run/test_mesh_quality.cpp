// Element quality against exact values, and as `brio check` reports it.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "io/run/check_deck.hpp"
#include "src/deck/element_quality.hpp"

namespace brio {
namespace {

constexpr double degree = std::numbers::pi / 180;

std::array<Corner, 8> unit_cube() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
}
std::array<Corner, 4> unit_square() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}; }

TEST(ElementQuality, OfACubeAndASquareIsPerfect) {
  const auto cube = unit_cube();
  const auto square = unit_square();
  for (const std::span<const Corner> corners :
       {std::span<const Corner>(cube), std::span<const Corner>(square)}) {
    EXPECT_EQ(aspect_of(corners), 1);
    EXPECT_EQ(warp_of(corners), 0);
    EXPECT_EQ(scaled_jacobian_of(corners), 1);
  }
  EXPECT_EQ(volume_of_hexahedron(unit_cube()), 1);
}

// The edges of a sheared cube enclose an angle whose sine is the scaled Jacobian.
TEST(ElementQuality, OfAShearedCubeIsTheSineOfItsAngle) {
  auto cube = unit_cube();
  for (Corner& corner : cube) corner[0] += 0.5 * corner[2];
  EXPECT_NEAR(scaled_jacobian_of(cube), std::sin(std::atan(2.0)), 1e-15);
  EXPECT_NEAR(aspect_of(cube), std::sqrt(1.25), 1e-15);
  EXPECT_NEAR(volume_of_hexahedron(cube), 1, 1e-15);
}

// A corner lifted by h makes two triangles, about the diagonal beside it, with normals (0, 0, 1) and (-h, -h,
// 1).
TEST(ElementQuality, WarpIsTheAngleOfTwoTriangles) {
  auto square = unit_square();
  square[2][2] = 0.1;
  const double beside = std::acos(1 / std::sqrt(1 + 2 * 0.01)) / degree;
  const double through = std::acos(1 / (1 + 0.01)) / degree;  // (-h, 0, 1) and (0, -h, 1)
  EXPECT_NEAR(warp_of(square), std::max(beside, through), 1e-12);
}

TEST(ElementQuality, OfAWedgeIsThatOfItsTriangles) {
  const double h = std::sqrt(0.75);
  const std::array<Corner, 8> wedge{
      {{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0.5, h, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, h, 1}, {0.5, h, 1}}};
  EXPECT_NEAR(scaled_jacobian_of(wedge), std::sin(60 * degree), 1e-15);
  EXPECT_NEAR(volume_of_hexahedron(wedge), h / 2, 1e-15);
  EXPECT_NEAR(aspect_of(wedge), 1, 1e-15);
  const std::array<Corner, 4> triangle{{{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0.5, h, 0}}};
  EXPECT_NEAR(scaled_jacobian_of(triangle), std::sin(60 * degree), 1e-15);
  EXPECT_EQ(warp_of(triangle), 0);
}

TEST(ElementQuality, IsNegativeWhereACornerIsInsideOut) {
  auto square = unit_square();
  square[2] = {0.2, 0.2, 0};
  EXPECT_LT(scaled_jacobian_of(square), 0);
  auto cube = unit_cube();
  std::swap(cube[0], cube[4]);
  EXPECT_LT(scaled_jacobian_of(cube), 0);
}

// Two Gauss points a direction integrate the Jacobian of a trilinear map exactly.
TEST(ElementQuality, VolumeOfAnyHexahedronIsThatOfItsTrilinearMap) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  for (int trial = 0; trial < 20; ++trial) {
    auto cube = unit_cube();
    const auto natural = cube;
    for (Corner& corner : cube)
      for (double& x : corner) x += noise(random);
    double volume = 0;
    for (int point = 0; point < 8; ++point) {
      double gradient[3][3]{};
      Vector3d at{};
      for (std::size_t i = 0; i < 3; ++i) at[i] = 0.5 + ((point >> i & 1) != 0 ? 0.5 : -0.5) / std::sqrt(3.0);
      for (std::size_t corner = 0; corner < 8; ++corner)
        for (std::size_t j = 0; j < 3; ++j) {
          double slope = 1;
          for (std::size_t k = 0; k < 3; ++k) {
            const bool upper = natural[corner][k] > 0.5;
            slope *= k == j ? (upper ? 1 : -1) : (upper ? at[k] : 1 - at[k]);
          }
          for (std::size_t i = 0; i < 3; ++i) gradient[i][j] += cube[corner][i] * slope;
        }
      const auto& g = gradient;
      volume += 0.125 * (g[0][0] * (g[1][1] * g[2][2] - g[1][2] * g[2][1]) -
                         g[0][1] * (g[1][0] * g[2][2] - g[1][2] * g[2][0]) +
                         g[0][2] * (g[1][0] * g[2][1] - g[1][1] * g[2][0]));
    }
    EXPECT_NEAR(volume_of_hexahedron(cube), volume, 1e-14);
  }
}

TEST(ElementQuality, IsReportedByPart) {
  ForecastOptions options;
  options.deck = std::string(BRIO_SOURCE_DIR) + "/inputs/pipe_cutting.yaml";
  options.overrides = {"parts.pipe.mesh.tube.elements=[24,18,2]", "parts.blade.mesh.wedge.elements=[1,4,24]"};
  options.timed_run_s = 0.01;
  CheckReport report;
  check_deck(options, [&](const CheckReport& found) {
    report.parts = found.parts, report.stable_step = found.stable_step;
  });
  double least = HUGE_VAL;
  std::size_t degenerate = 0;
  for (const PartReport& part : report.parts) {
    EXPECT_GE(part.quality.aspect, 1);
    EXPECT_GT(part.quality.jacobian, 0);
    EXPECT_LE(part.quality.jacobian, 1);
    least = std::min(least, part.quality.step);
    degenerate += part.quality.degenerate;
  }
  EXPECT_GE(report.stable_step, least);
  EXPECT_GT(degenerate, 0u);  // the edge of the blade
}

}  // namespace
}  // namespace brio
