#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "materials/elastic_plastic.hpp"
#include "tests/materials/failing_point.hpp"

namespace brio {
namespace {

constexpr HosfordCoulombFracture steel{.a = 1.3, .b = 1.27, .c = 0.05};

/// As published: by triaxiality and Lode angle parameter.
double failure_strain(const HosfordCoulombFracture& fracture, double triaxiality, double lode) {
  constexpr double sixth = std::numbers::pi / 6;
  const double f1 = 2.0 / 3 * std::cos(sixth * (1 - lode));
  const double f2 = 2.0 / 3 * std::cos(sixth * (3 + lode));
  const double f3 = -2.0 / 3 * std::cos(sixth * (1 + lode));
  const double a = fracture.a;
  const double hosford =
      std::pow(0.5 * (std::pow(f1 - f2, a) + std::pow(f2 - f3, a) + std::pow(f1 - f3, a)), 1 / a);
  const double g = hosford + fracture.c * (2 * triaxiality + f1 + f3);
  if (g <= 0) return HUGE_VAL;
  return fracture.b * std::pow((1 + fracture.c) / g, 1 / fracture.transformation_exponent);
}

double damage_of(const HosfordCoulombFracture& fracture, const SymmetricTensor<double>& stress) {
  return hosford_coulomb_damage(fracture, stress, 1e-3, 1.0);
}

TEST(HosfordCoulombFracture, IsThePublishedStrainAtAnyTriaxialityAndLodeAngle) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> unity(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const HosfordCoulombFracture fracture{.a = 1.5 + 0.5 * unity(generator),
                                          .b = 1.1 + unity(generator),
                                          .c = 0.2 + 0.2 * unity(generator),
                                          .transformation_exponent = 0.3 + 0.25 * unity(generator)};
    const auto draw = [&] { return 1e8 * unity(generator); };
    const SymmetricTensor<double> stress{draw(), draw(), draw(), draw(), draw(), draw()};
    const SymmetricTensor<double> s = deviator(stress);
    const double q = std::sqrt(1.5 * contract(s, s));
    const double det = s.xx * (s.yy * s.zz - s.yz * s.yz) - s.xy * (s.xy * s.zz - s.yz * s.xz) +
                       s.xz * (s.xy * s.yz - s.yy * s.xz);
    const double angle = std::acos(std::clamp(13.5 * det / (q * q * q), -1.0, 1.0));
    const double strain = failure_strain(fracture, trace(stress) / 3 / q, 1 - 2 / std::numbers::pi * angle);
    ASSERT_LT(strain, HUGE_VAL);
    ASSERT_NEAR(damage_of(fracture, stress) * strain / 1e-3, 1, 1e-9) << k;
  }
}

TEST(HosfordCoulombFracture, KnowsTensionShearAndPressure) {
  const double size = 3e8;
  EXPECT_NEAR(damage_of(steel, {size, 0, 0, 0, 0, 0}), 1e-3 / steel.b, 1e-15);
  EXPECT_NEAR(damage_of(steel, {size, size, 0, 0, 0, 0}), 1e-3 / steel.b, 1e-15);
  // Pure shear: principal stresses 1, 0, -1 over the root of 3.
  const double g = std::pow(0.5 * (2 + std::pow(2, steel.a)), 1 / steel.a) / std::sqrt(3.0);
  EXPECT_NEAR(damage_of(steel, {0, 0, 0, size, 0, 0}), 1e-3 / steel.b * std::pow(g / (1 + steel.c), 10),
              1e-15);
  EXPECT_GT(damage_of(steel, {0, 0, 0, size, 0, 0}), damage_of(steel, {size, 0, 0, 0, 0, 0}));
  EXPECT_EQ(damage_of(steel, {-40 * size, -41 * size, -40 * size, 0, 0, 0}), 0);
  EXPECT_EQ(hosford_coulomb_damage(steel, {0, 0, 0, size, 0, 0}, 0.0, 1.0), 0);
}

TEST(HosfordCoulombFracture, SinglePrecisionFollowsDouble) {
  using T = Lanes<float>;
  for (const double pressure : {-2e8, 0.0, 2e8}) {
    const SymmetricTensor<double> stress{3e8 - pressure, -pressure, -1e8 - pressure, 1e8, 2e8, -5e7};
    const SymmetricTensor<T> in_lanes{T(stress.xx), T(stress.yy), T(stress.zz),
                                      T(stress.xy), T(stress.yz), T(stress.xz)};
    const T damage = hosford_coulomb_damage(steel, in_lanes, T(1e-3), 1.0);
    EXPECT_NEAR(static_cast<double>(damage[0]) / damage_of(steel, stress), 1, 1e-4);
  }
}

TEST(HosfordCoulombFracture, SharesOfTheStrainAreSummedUpUntilThePointCarriesNothing) {
  ElasticPlastic law{7800, 200e9, 0.3, 350e6, 1e9, 0};
  law.failure.emplace().hosford_coulomb = steel;
  law.failure->damage_growth = DamageGrowth::sudden;
  Point<Failing<IsotropicElasticPlastic>> point(Failing<IsotropicElasticPlastic>{{law}});
  while (!point.failed()) {
    point.strain({0, 0, 0, 1e-3, 0, 0});
    if (point.failed()) break;
    ASSERT_NEAR(point.history.damage, point.history.equivalent_plastic_strain / failure_strain(steel, 0, 0),
                1e-9);
    ASSERT_LT(point.history.equivalent_plastic_strain, failure_strain(steel, 0, 0));
  }
  EXPECT_NEAR(point.history.equivalent_plastic_strain, failure_strain(steel, 0, 0), 2e-3);
  EXPECT_EQ(point.stress.xy, 0);
}

}  // namespace
}  // namespace brio
