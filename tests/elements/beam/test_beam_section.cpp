#include <gtest/gtest.h>

#include <cmath>

#include "elements/beam/beam_section.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

struct Sums {
  double share = 0, y = 0, z = 0, yz = 0, plastic_y = 0, plastic_z = 0, torsion = 0, skew = 0;
};
Sums sums_of(const FibreSection& s) {
  Sums sum;
  for (int f = 0; f < s.count; ++f) {
    const BeamFibre& fibre = s.fibre[index(f)];
    const double area = s.area * fibre.share;
    sum.share += fibre.share;
    sum.y += area * fibre.y;
    sum.z += area * fibre.z;
    sum.yz += area * fibre.y * fibre.z;
    sum.plastic_y += area * std::abs(fibre.z);
    sum.plastic_z += area * std::abs(fibre.y);
    sum.torsion += area * (fibre.twist_y * fibre.twist_y + fibre.twist_z * fibre.twist_z);
    sum.skew += area * (std::abs(fibre.shear_y * fibre.twist_y) + std::abs(fibre.shear_z * fibre.twist_z));
  }
  return sum;
}

void expect_near(double value, double exact, double tolerance = 1e-13) {
  EXPECT_NEAR(value / exact, 1, tolerance);
}

/// What holds for every section.
void expect_sound(const FibreSection& s) {
  const Sums sum = sums_of(s);
  expect_near(sum.share, 1);
  const double size = std::sqrt(s.area);
  EXPECT_LT(std::abs(sum.y) + std::abs(sum.z), 1e-14 * s.area * size);
  EXPECT_LT(std::abs(sum.yz), 1e-14 * s.area * s.area);
  expect_near(sum.torsion, s.torsion_constant);
  double torque_of_shear_y = 0, torque_of_shear_z = 0;
  for (int f = 0; f < s.count; ++f) {
    const BeamFibre& fibre = s.fibre[index(f)];
    torque_of_shear_y += s.area * fibre.share * fibre.shear_y * fibre.twist_y;
    torque_of_shear_z += s.area * fibre.share * fibre.shear_z * fibre.twist_z;
  }
  EXPECT_LT(std::abs(torque_of_shear_y), 1e-13 * sum.skew);
  EXPECT_LT(std::abs(torque_of_shear_z), 1e-13 * sum.skew);
}

TEST(BeamSection, CircleAndTubeHaveExactAreaAndMoments) {
  const FibreSection circle = fibres_of(CircleSection{.radius = 0.3});
  expect_sound(circle);
  expect_near(circle.area, M_PI * 0.09);
  expect_near(circle.second_moment_y, M_PI * std::pow(0.3, 4) / 4);
  expect_near(circle.second_moment_z, M_PI * std::pow(0.3, 4) / 4);
  expect_near(circle.torsion_constant, M_PI * std::pow(0.3, 4) / 2);
  expect_near(circle.shear_factor_y, 6.0 / 7);
  const FibreSection tube =
      fibres_of(TubeSection{.outer_radius = 0.3, .inner_radius = 0.25, .fibres = {3, 8}});
  expect_sound(tube);
  expect_near(tube.second_moment_y, M_PI * (std::pow(0.3, 4) - std::pow(0.25, 4)) / 4);
  expect_near(tube.torsion_constant, M_PI * (std::pow(0.3, 4) - std::pow(0.25, 4)) / 2);
  // Cowper's thin tube: a half.
  EXPECT_NEAR(fibres_of(TubeSection{.outer_radius = 1, .inner_radius = 0.999}).shear_factor_y, 0.5, 1e-3);
}

TEST(BeamSection, RectangleHasExactMomentsAndPlasticModuli) {
  for (const double width : {0.2, 0.5, 3.0}) {
    const double height = 0.5;
    const FibreSection s = fibres_of(RectangleSection{.width = width, .height = height});
    expect_sound(s);
    expect_near(s.second_moment_y, width * std::pow(height, 3) / 12);
    expect_near(s.second_moment_z, height * std::pow(width, 3) / 12);
    expect_near(sums_of(s).plastic_y, width * height * height / 4);
    expect_near(sums_of(s).plastic_z, height * width * width / 4);
    expect_near(s.shear_factor_y, 5.0 / 6);
  }
}

TEST(BeamSection, RectangleTwistsAsSaintVenantSays) {
  // Timoshenko & Goodier, table in art. 109: J / (width^3 height).
  EXPECT_NEAR(torsion_constant(1, 1), 0.1406, 5e-5);
  EXPECT_NEAR(torsion_constant(1, 2), 0.229 * 2, 5e-4 * 2);
  EXPECT_NEAR(torsion_constant(10, 1), 0.312 * 10, 5e-4 * 10);
  expect_near(torsion_constant(0.3, 0.7), torsion_constant(0.7, 0.3));
  // Without its scale the twist of the fibres gives the torsion constant to the error of their quadrature;
  // the largest shear is in the middle of the long sides: 0.675 times the side in a square.
  const FibreSection s = fibres_of(RectangleSection{.width = 1, .height = 1, .fibres = {8, 8}});
  double largest = 0;
  for (int f = 0; f < s.count; ++f)
    largest = std::max(largest, std::hypot(s.fibre[index(f)].twist_y, s.fibre[index(f)].twist_z));
  EXPECT_GT(largest, 0.6);
  EXPECT_LT(largest, 0.6753);
}

TEST(BeamSection, ISectionHasExactMomentsAndPlasticModulus) {
  const ISection profile{.width = 0.1, .height = 0.2, .web_thickness = 0.0056, .flange_thickness = 0.0085};
  const FibreSection s = fibres_of(profile);
  expect_sound(s);
  const double web = 0.2 - 2 * 0.0085;
  expect_near(s.area, 2 * 0.1 * 0.0085 + web * 0.0056);
  expect_near(s.second_moment_y, (0.1 * std::pow(0.2, 3) - (0.1 - 0.0056) * std::pow(web, 3)) / 12);
  expect_near(s.second_moment_z, (2 * 0.0085 * std::pow(0.1, 3) + web * std::pow(0.0056, 3)) / 12);
  expect_near(sums_of(s).plastic_y, 0.1 * 0.0085 * (0.2 - 0.0085) + 0.0056 * web * web / 4);
  expect_near(s.shear_factor_z, web * 0.0056 / s.area);
}

TEST(BeamSection, FactorOfTheDeckReplacesBoth) {
  const FibreSection s = fibres_of(RectangleSection{.width = 1, .height = 2}, 0.4);
  expect_near(s.shear_factor_y, 0.4);
  double sum = 0;
  for (int f = 0; f < s.count; ++f) sum += s.fibre[index(f)].share * std::pow(s.fibre[index(f)].shear_z, 2);
  expect_near(sum, 0.4);
}

}  // namespace
}  // namespace brio
