// Damage by the failure strain of Johnson and Cook against its formula, on points of given triaxiality.

#include <gtest/gtest.h>

#include <cmath>

#include "materials/material.hpp"
#include "tests/materials/failing_point.hpp"

namespace brio {
namespace {

constexpr double young = 200e9;
constexpr double poisson = 0.3;
constexpr double yield = 800e6;

// 4340 steel of Johnson & Cook 1985.
constexpr double d1 = 0.05, d2 = 3.44, d3 = -2.12, d4 = 0.002, d5 = 0.61;
double failure_strain(double triaxiality) { return d1 + d2 * std::exp(d3 * triaxiality); }

JohnsonCookFracture steel() {
  JohnsonCookFracture fracture;
  fracture.d1 = d1;
  fracture.d2 = d2;
  fracture.d3 = d3;
  return fracture;
}
Failure sudden(const JohnsonCookFracture& fracture) {
  Failure failure;
  failure.johnson_cook = fracture;
  failure.damage_growth = DamageGrowth::sudden;
  return failure;
}
ElasticPlastic linear_law(const Failure& failure, double modulus = 1e9) {
  ElasticPlastic law{7800, young, poisson, yield, modulus, 0};
  law.failure = failure;
  return law;
}
using FailingLinear = Failing<IsotropicElasticPlastic>;
FailingLinear failing(const ElasticPlastic& law) { return FailingLinear{{law}}; }

/// The law itself at a rate of 1000 per second and strain steps of 1e-3.
JohnsonCook law_with_heat(const Failure& failure, double heat_fraction = 0.9, double start = 300) {
  JohnsonCook law{7830, young, poisson, yield, 500e6, 0.26, 0.014, 1.0};
  law.thermal = ThermalSoftening{.specific_heat = 477,
                                 .melting_temperature = 1793,
                                 .reference_temperature = 293,
                                 .initial_temperature = start,
                                 .exponent = 1.03,
                                 .heat_fraction = heat_fraction};
  law.failure = failure;
  law.time_step = 1e-6;
  return law;
}

template <class P>
double triaxiality(const P& point) {
  return trace(point.stress) / 3 / von_mises(deviator(point.stress));
}

TEST(JohnsonCookFracture, DamageIsThePlasticStrainOverTheFailureStrainOfTheTriaxiality) {
  const auto law = failing(linear_law(sudden(steel())));
  Point tension(law), compression(law), shear(law), biaxial(law);
  for (int step = 0; step < 200; ++step) {
    pull(tension, 2e-3);
    pull(compression, -2e-3);
    shear.strain({0, 0, 0, 2e-3, 0, 0});
    // Compression along z with as much pull along x: stresses s, 0, -s are shear as well.
    biaxial.strain({2e-3, 0, -2e-3, 0, 0, 0});
  }
  const auto expect = [](const auto& point, double at) {
    const double strain = point.history.equivalent_plastic_strain;
    EXPECT_GT(strain, 0.3);
    EXPECT_NEAR(triaxiality(point), at, 1e-9);
    EXPECT_NEAR(point.history.damage, strain / failure_strain(at), 1e-9);
  };
  expect(tension, 1.0 / 3);
  expect(compression, -1.0 / 3);
  expect(shear, 0);
  expect(biaxial, 0);
}

TEST(JohnsonCookFracture, PressureDelaysAndTensionHastensByTheExponential) {
  for (const double at : {-2.0, -0.5, 0.5, 1.5, 3.0}) {
    Point point(failing(linear_law(sudden(steel()), 0)));
    const double volume_strain = at * yield / (young / (3 * (1 - 2 * poisson)));
    point.strain({volume_strain / 3, volume_strain / 3, volume_strain / 3, 0, 0, 0});
    while (point.history.equivalent_plastic_strain < 0.05 * failure_strain(at))
      point.strain({0, 0, 0, 1e-4, 0, 0});
    EXPECT_NEAR(triaxiality(point), at, 1e-9);
    const double expected = point.history.equivalent_plastic_strain / failure_strain(at);
    EXPECT_NEAR(point.history.damage, expected, 1e-9 * expected);
  }
}

// Johnson and Cook give no bound in compression; a deck may (Bao & Wierzbicki 2005: -1/3).
TEST(JohnsonCookFracture, BelowTheLeastTriaxialityNothingIsDamaged) {
  JohnsonCookFracture bounded = steel();
  bounded.least_triaxiality = -0.33;
  const auto law = failing(linear_law(sudden(bounded)));
  Point compression(law), shear(law);
  for (int step = 0; step < 200; ++step) {
    pull(compression, -2e-3);
    shear.strain({0, 0, 0, 2e-3, 0, 0});
  }
  EXPECT_GT(compression.history.equivalent_plastic_strain, 0.3);
  EXPECT_EQ(compression.history.damage, 0.0);
  EXPECT_NEAR(shear.history.damage, shear.history.equivalent_plastic_strain / failure_strain(0), 1e-9);
}

TEST(JohnsonCookFracture, LeastStrainHoldsWhereTheFormulaFallsBelowIt) {
  JohnsonCookFracture iron;  // Armco iron of the paper: negative beyond a triaxiality of 1.92
  iron.d1 = -2.20;
  iron.d2 = 5.43;
  iron.d3 = -0.47;
  iron.least_strain = 0.1;
  for (const double at : {0.0, 3.0}) {
    Point point(failing(linear_law(sudden(iron), 0)));
    const double volume_strain = at * yield / (young / (3 * (1 - 2 * poisson)));
    point.strain({volume_strain / 3, volume_strain / 3, volume_strain / 3, 0, 0, 0});
    for (int step = 0; step < 100; ++step) point.strain({0, 0, 0, 2e-4, 0, 0});
    const double strain = at > 1 ? 0.1 : -2.20 + 5.43;
    EXPECT_NEAR(point.history.damage, point.history.equivalent_plastic_strain / strain, 1e-9);
  }
}

// At 793 degrees, a third of the way to melting, and 1 to 1e6 times the reference rate; without heating.
TEST(JohnsonCookFracture, RateAndTemperatureMultiplyTheFailureStrain) {
  JohnsonCookFracture fracture = steel();
  fracture.d4 = d4;
  fracture.d5 = d5;
  for (const double step_time : {1e-9, 1e-6, 1.0}) {
    JohnsonCook law = law_with_heat(sudden(fracture), 0, 793);
    law.time_step = step_time;
    Point point(Failing<JohnsonCook>{law});
    double expected = 0, largest_rate = 0;
    for (int step = 0; step < 300; ++step) {
      const double before = point.history.equivalent_plastic_strain;
      point.strain({0, 0, 0, 1e-3, 0, 0});
      const double flow = point.history.equivalent_plastic_strain - before;
      const double rate = std::max(flow / step_time, 1.0);
      largest_rate = std::max(rate, largest_rate);
      expected += flow / (failure_strain(0) * (1 + d4 * std::log(rate)) * (1 + d5 / 3));
    }
    EXPECT_GT(expected, 0.05);
    EXPECT_NEAR(point.history.damage, expected, 1e-9);
    EXPECT_EQ(largest_rate > 1, step_time < 1);
  }
}

TEST(JohnsonCookFracture, HeatOfTheFlowCountsFromTheEndOfEachStep) {
  JohnsonCookFracture fracture = steel();
  fracture.d5 = d5;
  Point point(Failing<JohnsonCook>{law_with_heat(sudden(fracture))});
  double expected = 0;
  for (int step = 0; step < 500; ++step) {
    const double before = point.history.equivalent_plastic_strain;
    point.strain({0, 0, 0, 1e-3, 0, 0});
    const double hot = (7 + point.history.temperature_rise) / 1500;
    expected += (point.history.equivalent_plastic_strain - before) / (failure_strain(0) * (1 + d5 * hot));
  }
  EXPECT_GT(point.history.temperature_rise, 50);
  EXPECT_NEAR(point.history.damage, expected, 1e-9);
}

TEST(JohnsonCookFracture, StressStaysWholeUntilItIsDropped) {
  const ElasticPlastic law = linear_law(sudden(steel()));
  Point point(failing(law));
  Point whole(IsotropicElasticPlastic{law});
  const double p = failure_strain(1.0 / 3);
  int whole_steps = 0;
  while (!point.failed()) {
    ASSERT_LT(whole_steps, 2000);
    ASSERT_EQ(point.stress.xx, whole.stress.xx);
    ASSERT_EQ(point.stress.yy, whole.stress.yy);
    ASSERT_LT(point.history.equivalent_plastic_strain, p);
    ++whole_steps;
    pull(point, 2e-3);
    pull(whole, 2e-3);
  }
  EXPECT_GT(whole_steps, 500);
  EXPECT_EQ(point.history.damage, 1.0);
  EXPECT_NEAR(point.history.equivalent_plastic_strain, p, 2e-3);
  EXPECT_EQ(contract(point.stress, point.stress), 0.0);
  point.strain({1e-3, 0, 0, 0, 0, 0});
  EXPECT_EQ(contract(point.stress, point.stress), 0.0);
}

TEST(JohnsonCookFracture, DamageThatWouldJumpPastOneStopsThere) {
  JohnsonCookFracture brittle;
  brittle.d1 = 1e-3;
  Point point(failing(linear_law(sudden(brittle))));
  point.strain({0, 0, 0, 0.5, 0, 0});
  EXPECT_EQ(point.history.damage, 1.0);
  EXPECT_TRUE(point.failed());
  EXPECT_EQ(point.stress.xy, 0.0);
}

TEST(JohnsonCookFracture, DamageNeverHealsAndAFailedPointCarriesNothingForEver) {
  JohnsonCookFracture fracture = steel();
  fracture.d2 = 0.3;
  expect_monotone(failing(linear_law(sudden(fracture))), 1);
  fracture.d4 = d4;
  fracture.d5 = d5;
  expect_monotone(Failing<JohnsonCook>{law_with_heat(sudden(fracture))}, 100);
}

// As an onset with opening, in uniaxial tension, it is the failure strain of that triaxiality.
TEST(JohnsonCookFracture, OpeningSetsInAtDamageOne) {
  Failure by_formula;
  by_formula.johnson_cook = steel();
  by_formula.johnson_cook->d2 = 0.3;
  Failure by_strain;
  by_strain.strain = d1 + 0.3 * std::exp(d3 / 3);
  by_formula.opening_strain = by_strain.opening_strain = 0.1;
  Point formula(failing(linear_law(by_formula)));
  Point strain(failing(linear_law(by_strain)));
  for (int step = 0; step < 250; ++step) {
    pull(formula, 1.7e-3);
    pull(strain, 1.7e-3);
    ASSERT_NEAR(formula.history.damage, strain.history.damage, 1e-8);
  }
  EXPECT_TRUE(formula.failed());
}

TEST(JohnsonCookFracture, PlaneStressFollowsThreeDimensionsWithAFreeThirdDirection) {
  const auto law = failing(linear_law(sudden(steel())));
  Point space(law);
  ShellTensor<double> stress{};
  FailingLinear::History<double> history{};
  law.start(history, 1.0);
  for (int step = 0; step < 200; ++step) {
    const ShellTensor<double> strain{1e-3, 0.25e-3, 0.3e-3, 0, 0};
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
  }
  EXPECT_GT(space.history.damage, 0.1);
  EXPECT_NEAR(history.damage, space.history.damage, 1e-3 * space.history.damage);
}

TEST(JohnsonCookFracture, MoltenPointIsDamagedFinitely) {
  JohnsonCookFracture fracture = steel();
  fracture.d5 = d5;
  for (const double pressure_strain : {-1e-2, 0.0, 1e-2}) {
    Point point(Failing<JohnsonCook>{law_with_heat(sudden(fracture))});
    point.history.temperature_rise = 1493;
    point.strain({pressure_strain, pressure_strain, pressure_strain, 0, 0, 0});
    for (int step = 0; step < 10; ++step) point.strain({0, 0, 0, 1e-4, 0, 0});
    EXPECT_EQ(von_mises(deviator(point.stress)), 0.0);
    EXPECT_GE(point.history.damage, 0.0);
    EXPECT_LE(point.history.damage, 1.0);
    if (pressure_strain < 0) {
      EXPECT_LT(point.history.damage, 1e-30);
    }
  }
}

TEST(JohnsonCookFracture, LanesAgreeWithPlainNumbers) {
  expect_lanes_agree<double>(failing(linear_law(sudden(steel()))), 1e-9);
  expect_lanes_agree<float>(failing(linear_law(sudden(steel()))), 2e-3);
  JohnsonCookFracture fracture = steel();
  fracture.d4 = d4;
  fracture.d5 = d5;
  expect_lanes_agree<double>(Failing<JohnsonCook>{law_with_heat(sudden(fracture))}, 1e-9);
}

TEST(JohnsonCookFracture, RulesOfTheDeckSayWhatIsMissing) {
  EXPECT_EQ(sudden(steel()).fault(), "");
  EXPECT_EQ(steel().fault(), "");
  JohnsonCookFracture none;
  EXPECT_NE(none.fault(), "");
  JohnsonCookFracture falling = steel();
  falling.d1 = -0.1;
  EXPECT_NE(falling.fault(), "");
  falling.least_strain = 0.01;
  EXPECT_EQ(falling.fault(), "");
  Failure no_growth = sudden(steel());
  no_growth.damage_growth = DamageGrowth::opening;
  EXPECT_NE(no_growth.fault(), "");
  no_growth.opening_strain = 0.1;
  EXPECT_EQ(no_growth.fault(), "");
  Failure both = sudden(steel());
  both.strain = 1;
  EXPECT_NE(both.fault(), "");
  Failure by_strain;
  by_strain.strain = 1;
  by_strain.damage_growth = DamageGrowth::sudden;
  EXPECT_NE(by_strain.fault(), "");
}

TEST(JohnsonCookFracture, LawsWithoutRateOrTemperatureRefuseConstantsThatWantThem) {
  JohnsonCookFracture rate = steel(), heat = steel();
  rate.d4 = d4;
  heat.d5 = d5;
  EXPECT_EQ(linear_law(sudden(steel())).fault(), "");
  EXPECT_NE(linear_law(sudden(rate)).fault(), "");
  EXPECT_NE(linear_law(sudden(heat)).fault(), "");
  PowerLawHardening power{7800, young, poisson, yield, 600e6, 0.294, 0.005};
  power.failure = sudden(rate);
  EXPECT_NE(power.fault(), "");
  JohnsonCook law = law_with_heat(sudden(heat));
  EXPECT_EQ(law.fault(), "");
  law.thermal.reset();
  EXPECT_NE(law.fault(), "");
  law.failure = sudden(rate);
  EXPECT_EQ(law.fault(), "");
}

}  // namespace
}  // namespace brio
