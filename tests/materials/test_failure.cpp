// Damage of a failing law: when it sets in, what it grows by, what is carried.

#include <gtest/gtest.h>

#include "materials/failing.hpp"
#include "materials/material.hpp"
#include "tests/materials/failing_point.hpp"

namespace brio {
namespace {

constexpr double young = 200e9;
constexpr double poisson = 0.3;
constexpr double yield = 350e6;
constexpr double modulus = 2e9;
constexpr double shear = young / (2 * (1 + poisson));

Failure opening_failure(double strain, double opening) {
  Failure failure;
  failure.strain = strain;
  failure.opening_strain = opening;
  return failure;
}
ElasticPlastic linear_law(const Failure& failure, double mix = 0) {
  ElasticPlastic law{7800, young, poisson, yield, modulus, mix};
  law.failure = failure;
  return law;
}
PowerLawHardening power_law(const Failure& failure) {
  PowerLawHardening law{7800, young, poisson, yield, 600e6, 0.294, 0.005};
  law.failure = failure;
  return law;
}

using FailingLinear = Failing<IsotropicElasticPlastic>;
FailingLinear failing(const ElasticPlastic& law) { return FailingLinear{{law}}; }
Failing<PowerLawHardening> failing(const PowerLawHardening& law) { return {law}; }

// In uniaxial strain the von Mises stress of the elastic trial is 2 G eps, so that with linear hardening
// p = (2 G eps - yield) / (3 G + H).
double strain_at_plastic_strain(double p) { return ((3 * shear + modulus) * p + yield) / (2 * shear); }

TEST(Failure, DamageInTensionIsTheOpeningSinceTheFailureStrain) {
  constexpr double failure_strain = 0.05, opening = 0.2;
  Point point(failing(linear_law(opening_failure(failure_strain, opening))));
  Point undamaged(IsotropicElasticPlastic{linear_law({})});
  const double start = strain_at_plastic_strain(failure_strain);
  double strain = 0;
  // Steps that do not divide the strain at which failure sets in.
  for (int step = 0; step < 200; ++step) {
    strain += 1.3e-3;
    point.strain({1.3e-3, 0, 0, 0, 0, 0});
    undamaged.strain({1.3e-3, 0, 0, 0, 0, 0});
    const double damage = std::max(strain - start, 0.0) / opening;
    const double carried = damage >= 0.9 ? 0 : 1 - damage;
    if (!point.failed()) {
      ASSERT_NEAR(point.history.damage, damage, 1e-12);
    }
    ASSERT_EQ(point.failed(), damage >= 0.9);
    ASSERT_NEAR(point.stress.xx, carried * undamaged.stress.xx, 1e-12 * undamaged.stress.xx);
    ASSERT_NEAR(point.stress.zz, carried * undamaged.stress.zz, 1e-12 * undamaged.stress.xx);
  }
  EXPECT_TRUE(point.failed());
}

TEST(Failure, NoneInCompression) {
  Point point(failing(linear_law(opening_failure(0.05, 0.2))));
  for (int step = 0; step < 500; ++step) point.strain({-1e-3, 0, 0, 0, 0, 0});
  EXPECT_GT(point.history.equivalent_plastic_strain, 0.3);
  EXPECT_EQ(point.history.damage, 0.0);
  // Compression along z that squeezes material out along x and y: strained there, but not pulled.
  Point upset(failing(linear_law(opening_failure(0.05, 0.2))));
  for (int step = 0; step < 500; ++step) upset.strain({4.7e-4, 4.7e-4, -1e-3, 0, 0, 0});
  EXPECT_GT(upset.history.equivalent_plastic_strain, 0.3);
  EXPECT_EQ(upset.history.damage, 0.0);
}

TEST(Failure, PressureThatExceedsTensionKeepsShearedMaterialWhole) {
  Point sheared(failing(linear_law(opening_failure(0.05, 0.2))));
  Point pressed(failing(linear_law(opening_failure(0.05, 0.2))));
  pressed.strain({-0.01, -0.01, -0.01, 0, 0, 0});
  for (int step = 0; step < 200; ++step) {
    sheared.strain({0, 0, 0, 1e-3, 0, 0});
    pressed.strain({0, 0, 0, 1e-3, 0, 0});
  }
  EXPECT_GT(sheared.history.damage, 0.1);
  EXPECT_EQ(pressed.history.damage, 0.0);
  EXPECT_NEAR(pressed.history.equivalent_plastic_strain, sheared.history.equivalent_plastic_strain, 1e-9);
}

TEST(Failure, DamageNeverHealsAndAFailedPointCarriesNothingForEver) {
  expect_monotone(failing(linear_law(opening_failure(0.1, 0.2))), 1);
  expect_monotone(Failing<ElasticPlastic>{linear_law(opening_failure(0.1, 0.2), 0.4)}, 100);
  expect_monotone(failing(power_law(opening_failure(0.1, 0.2))), 200);
  Failure in_tension;
  in_tension.strain = 0.3;
  in_tension.damage_growth = DamageGrowth::plastic_strain_in_tension;
  expect_monotone(failing(power_law(in_tension)), 300);
  Failure tearing;
  tearing.tearing_parameter = 0.2;
  tearing.opening_strain = 0.2;
  expect_monotone(failing(power_law(tearing)), 400);
}

TEST(ExtremesFailure, DamageThatWouldJumpPastOneStopsThere) {
  Point point(failing(linear_law(opening_failure(0.01, 1e-3))));
  point.strain({0.5, 0, 0, 0, 0, 0});
  EXPECT_EQ(point.history.damage, 1.0);
  EXPECT_TRUE(point.failed());
  EXPECT_EQ(point.stress.xx, 0.0);
}

TEST(Failure, DamageExactlyAtTheBoundHasFailed) {
  Failure failure = opening_failure(0x1p-6, 0x1p-4);
  failure.deletion_damage = 0.5;
  Point point(failing(linear_law(failure)));
  point.history.equivalent_plastic_strain = 0x1p-4;
  point.strain({0x1p-6, 0, 0, 0, 0, 0});
  EXPECT_EQ(point.history.damage, 0.25);
  EXPECT_FALSE(point.failed());
  EXPECT_GT(point.stress.xx, 0.0);
  point.strain({0x1p-6, 0, 0, 0, 0, 0});
  EXPECT_EQ(point.history.damage, 0.5);
  EXPECT_TRUE(point.failed());
  EXPECT_EQ(point.stress.xx, 0.0);
}

TEST(Failure, DeletionAtDamageOneIsReachedWithoutDividingByZero) {
  Failure failure = opening_failure(0x1p-6, 0x1p-4);
  failure.deletion_damage = 1;
  Point point(failing(linear_law(failure)));
  point.history.equivalent_plastic_strain = 0x1p-4;
  for (int step = 0; step < 10; ++step) {
    point.strain({0x1p-7, 0, 0, 0, 0, 0});
    ASSERT_TRUE(std::isfinite(point.stress.xx));
    ASSERT_EQ(point.history.damage, std::min(0x1p-3 * (step + 1), 1.0));
  }
  EXPECT_EQ(point.stress.xx, 0.0);
}

TEST(Failure, TearingParameterIsThePlasticStrainInUniaxialTension) {
  Failure failure;
  failure.tearing_parameter = 10;
  failure.opening_strain = 1;
  Point point(failing(power_law(failure)));
  for (int step = 0; step < 300; ++step) pull(point, 2e-3);
  EXPECT_GT(point.history.equivalent_plastic_strain, 0.5);
  EXPECT_NEAR(point.history.measure, point.history.equivalent_plastic_strain, 1e-11);
  Point pushed(failing(power_law(failure)));
  for (int step = 0; step < 100; ++step) pull(pushed, -2e-3);
  EXPECT_GT(pushed.history.equivalent_plastic_strain, 0.1);
  EXPECT_EQ(pushed.history.measure, 0.0);
}

// Equal stress along x and y: sigma_1 = s, sigma_m = 2/3 s, so that the ratio is 2 and its power 16.
TEST(Failure, TearingParameterGrowsSixteenTimesAsFastInEqualBiaxialTension) {
  Failure failure;
  failure.tearing_parameter = 100;
  failure.opening_strain = 1;
  Point point(failing(linear_law(failure)));
  double plastic = 0, tearing = 0;
  const auto stretch = [&](double increment) {
    double low = -3 * increment, high = 0;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      auto trial = point;
      trial.strain({increment, increment, middle, 0, 0, 0});
      (trial.stress.zz > 0 ? high : low) = middle;
    }
    plastic = point.history.equivalent_plastic_strain;
    tearing = point.history.measure;
    point.strain({increment, increment, low, 0, 0, 0});
  };
  for (int step = 0; step < 20; ++step) stretch(1e-3);
  ASSERT_GT(point.history.equivalent_plastic_strain, plastic);
  EXPECT_NEAR((point.history.measure - tearing) / (point.history.equivalent_plastic_strain - plastic), 16,
              1e-8);
}

TEST(Failure, TearingParameterSetsFailureInWhereTheStrainWouldInUniaxialTension) {
  Failure by_tearing;
  by_tearing.tearing_parameter = 0.2;
  by_tearing.opening_strain = 0.1;
  Point torn(failing(power_law(by_tearing)));
  Point strained(failing(power_law(opening_failure(0.2, 0.1))));
  for (int step = 0; step < 200; ++step) {
    pull(torn, 1.7e-3);
    pull(strained, 1.7e-3);
    ASSERT_NEAR(torn.history.damage, strained.history.damage, 1e-9);
  }
  EXPECT_TRUE(torn.failed());
}

TEST(Failure, PlasticStrainInTensionOverTheFailureStrainIsTheOtherReading) {
  Failure failure;
  failure.strain = 0.4;
  failure.damage_growth = DamageGrowth::plastic_strain_in_tension;
  Point point(failing(power_law(failure)));
  const auto plastic = [&] { return point.history.equivalent_plastic_strain; };
  for (int step = 0; step < 100; ++step) pull(point, 1e-3);
  const double pulled = plastic();
  EXPECT_NEAR(point.history.damage, pulled / 0.4, 1e-12);
  // Pressed back until it flows the other way: the damage stays.
  while (point.stress.xx > 0) pull(point, -1e-4);
  for (int step = 0; step < 50; ++step) pull(point, -1e-3);
  EXPECT_GT(plastic(), pulled + 0.04);
  EXPECT_NEAR(point.history.damage, pulled / 0.4, 1e-12);
  while (!point.failed()) pull(point, 1e-3);
  EXPECT_NEAR(point.history.damage, 0.9, 0.003);
}

TEST(Failure, OpeningDisplacementIsAnOpeningStrainTimesTheSize) {
  Failure failure;
  failure.strain = 0.05;
  failure.opening_displacement = 0.02;
  const double size = 0.25;
  const FailingLinear law = failing(linear_law(failure));
  Point<FailingLinear> by_displacement(law, size);
  Point by_strain(failing(linear_law(opening_failure(0.05, 0.02 / 0.25))));
  for (int step = 0; step < 100; ++step) {
    by_displacement.strain({1e-3, 0, 0, 0, 0, 0});
    by_strain.strain({1e-3, 0, 0, 0, 0, 0});
    ASSERT_EQ(by_displacement.history.damage, by_strain.history.damage);
    ASSERT_EQ(by_displacement.stress.xx, by_strain.stress.xx);
  }
  EXPECT_GT(by_strain.history.damage, 0.1);
}

TEST(Failure, UntilItSetsInTheLawIsTheUndamagedOne) {
  RandomPath path(3);
  Point point(failing(power_law(opening_failure(1e9, 1))));
  Point base(power_law({}));
  for (int step = 0; step < 2000; ++step) {
    const SymmetricTensor<double> strain = path.next();
    point.strain(strain);
    base.strain(strain);
    ASSERT_EQ(point.stress.xx, base.stress.xx);
    ASSERT_EQ(point.stress.yz, base.stress.yz);
    ASSERT_EQ(point.history.equivalent_plastic_strain, base.history.equivalent_plastic_strain);
  }
}

TEST(Failure, TurnedStrainsGiveTheSameDamageAndTurnedStress) {
  RandomPath random(5);
  for (int k = 0; k < 20; ++k) {
    const Tensor<double> r = random_rotation(random);
    Point point(failing(power_law(opening_failure(0.05, 0.5))));
    Point turned(failing(power_law(opening_failure(0.05, 0.5))));
    for (int step = 0; step < 300; ++step) {
      const SymmetricTensor<double> strain = random.next();
      point.strain(strain);
      turned.strain(rotated(r, strain));
      ASSERT_NEAR(turned.history.damage, point.history.damage, 1e-9);
      ASSERT_NEAR(rotated(r, point.stress).xy, turned.stress.xy, 1e-6 * yield);
      if (point.failed()) break;
    }
  }
}

TEST(Failure, PlaneStressFollowsThreeDimensionsWithAFreeThirdDirection) {
  const auto law = failing(power_law(opening_failure(0.1, 0.3)));
  Point space(law);
  ShellTensor<double> stress{};
  Failing<PowerLawHardening>::History<double> history{};
  law.start(history, 1.0);
  for (int step = 0; step < 300; ++step) {
    const ShellTensor<double> strain{2e-3, 0.5e-3, 0.7e-3, 0, 0};
    double through = 0;
    law.update_plane_stress(strain, 1.0, stress, history, through);
    double low = -0.01, high = 0.01;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      auto trial = space;
      trial.strain({strain.xx, strain.yy, middle, strain.xy, 0, 0});
      (trial.stress.zz > 0 ? high : low) = middle;
    }
    space.strain({strain.xx, strain.yy, low, strain.xy, 0, 0});
    if (law.has_failed(history)) break;
    ASSERT_NEAR(history.damage, space.history.damage, 3e-3);
  }
  EXPECT_TRUE(law.has_failed(history));
  EXPECT_EQ(stress.xx, 0.0);
  EXPECT_EQ(stress.xy, 0.0);
}

TEST(Failure, LanesAgreeWithPlainNumbers) {
  expect_lanes_agree<double>(failing(power_law(opening_failure(0.05, 1))), 1e-9);
  expect_lanes_agree<double>(Failing<ElasticPlastic>{linear_law(opening_failure(0.05, 1), 0.5)}, 1e-9);
  Failure in_tension;
  in_tension.strain = 0.5;
  in_tension.damage_growth = DamageGrowth::plastic_strain_in_tension;
  expect_lanes_agree<double>(failing(power_law(in_tension)), 1e-9);
  expect_lanes_agree<float>(failing(linear_law(opening_failure(0.05, 1))), 2e-3);
}

TEST(Failure, RulesOfTheDeckSayWhatIsMissing) {
  EXPECT_NE(Failure{}.fault(), "");
  EXPECT_EQ(opening_failure(1.27, 0.3).fault(), "");
  Failure both = opening_failure(1.27, 0.3);
  both.tearing_parameter = 1;
  EXPECT_NE(both.fault(), "");
  Failure two_openings = opening_failure(1.27, 0.3);
  two_openings.opening_displacement = 1;
  EXPECT_NE(two_openings.fault(), "");
  Failure other = opening_failure(1.27, 0.3);
  other.damage_growth = DamageGrowth::plastic_strain_in_tension;
  EXPECT_NE(other.fault(), "");
  other.opening_strain.reset();
  EXPECT_EQ(other.fault(), "");
}

}  // namespace
}  // namespace brio
