// Johnson-Cook plasticity against exact solutions: consistency at the rate of the step, heating.

#include "materials/johnson_cook.hpp"

#include <gtest/gtest.h>

#include "tests/materials/paths.hpp"

namespace brio {
namespace {

// 42CrMo4; the temperatures are those usual for steels.
JohnsonCook steel() {
  JohnsonCook law{7830, 206.9e9, 0.3, 806e6, 614e6, 0.168, 0.0089, 1.0};
  law.thermal.emplace();
  law.thermal->specific_heat = 460;
  law.thermal->melting_temperature = 1793;
  law.thermal->reference_temperature = 293;
  law.thermal->exponent = 1.1;
  return law;
}

long double yield_stress(const JohnsonCook& law, long double p, long double dp, long double temperature) {
  const long double rate = std::max(dp / law.time_step / law.reference_rate, 1.0L);
  long double soft = 1;
  if (law.thermal) {
    const long double share = (temperature - law.thermal->reference_temperature) /
                              (law.thermal->melting_temperature - law.thermal->reference_temperature);
    soft = 1 - std::pow(std::min(share, 1.0L), static_cast<long double>(law.thermal->exponent));
  }
  return (law.yield_stress +
          law.hardening_constant * std::pow(p, static_cast<long double>(law.hardening_exponent))) *
         (1 + law.rate_constant * std::log(rate)) * soft;
}

TEST(JohnsonCook, StressIsTheYieldStressAtTheStrainRateAndTemperatureOfTheStep) {
  for (const double exponent : {0.05, 0.168, 1.0})
    for (const double rate_constant : {0.0, 0.0089, 0.2})
      for (const double step : {1e-9, 1e-6, 1.0}) {
        JohnsonCook law = steel();
        law.hardening_exponent = exponent;
        law.rate_constant = rate_constant;
        law.time_step = step;
        RandomPath path(12);
        SymmetricTensor<double> stress{};
        JohnsonCook::History<double> history{};
        int flowing = 0;
        for (int k = 0; k < 500; ++k) {
          const double before = history.equivalent_plastic_strain;
          const double temperature = 293 + history.temperature_rise;
          law.update(path.next(), stress, history);
          const double flow = history.equivalent_plastic_strain - before;
          ASSERT_GE(flow, 0.0);
          const auto bound =
              static_cast<double>(yield_stress(law, history.equivalent_plastic_strain, flow, temperature));
          const double effective = von_mises(deviator(stress));
          // The flow of the step is a small difference of strains: its last digits are felt by the rate.
          if (flow > 1e-9 && flow > 1e-4 * before) {
            ++flowing;
            ASSERT_NEAR(effective, bound, 1e-9 * bound);
          } else {
            ASSERT_LE(effective, bound * (1 + 1e-3));
          }
        }
        EXPECT_GT(flowing, 10);
      }
}

// With n = 1 and B = 0, C = 0 and m = 1 the yield stress falls as exp(-k p), k = share A / (rho c (Tm - Tr)).
TEST(JohnsonCook, HeatSoftensExponentiallyWhereNothingHardens) {
  JohnsonCook law = steel();
  law.hardening_constant = 0;
  law.rate_constant = 0;
  law.thermal->exponent = 1;
  law.time_step = 1;
  SymmetricTensor<double> stress{};
  JohnsonCook::History<double> history{};
  for (int k = 0; k < 100000; ++k) law.update({0, 0, 0, 2e-5, 0, 0}, stress, history);
  const double rate = 0.9 * 806e6 / (7830 * 460 * 1500.0);
  const double expected = 806e6 * std::exp(-rate * history.equivalent_plastic_strain);
  EXPECT_GT(history.equivalent_plastic_strain, 2.0);
  EXPECT_NEAR(von_mises(deviator(stress)), expected, 1e-4 * expected);
  EXPECT_NEAR(history.temperature_rise, 1500 * (1 - expected / 806e6), 0.1);
}

TEST(JohnsonCook, YieldStressGrowsByTheLogarithmOfTheRate) {
  const auto stress_at = [](double rate) {
    JohnsonCook law = steel();
    law.thermal.reset();
    law.hardening_constant = 0;
    law.time_step = 1e-3 / rate;
    SymmetricTensor<double> stress{};
    JohnsonCook::History<double> history{};
    for (int k = 0; k < 100; ++k) law.update({1e-3, -5e-4, -5e-4, 0, 0, 0}, stress, history);
    return von_mises(deviator(stress));
  };
  EXPECT_NEAR(stress_at(0.1), 806e6, 1);
  EXPECT_NEAR(stress_at(1.0), 806e6, 1);
  EXPECT_NEAR(stress_at(1e4), 806e6 * (1 + 0.0089 * std::log(1e4)), 10);
}

TEST(JohnsonCook, PlaneStressIsThatOfThreeDimensionsWithAFreeThirdDirection) {
  JohnsonCook law = steel();
  law.time_step = 1e-7;
  SymmetricTensor<double> space{};
  ShellTensor<double> plane{};
  JohnsonCook::History<double> in_space{}, in_plane{};
  for (int k = 0; k < 300; ++k) {
    const ShellTensor<double> strain{4e-4, -1e-4, 2e-4, 0, 0};
    double through = 0;
    law.update_plane_stress(strain, 1.0, plane, in_plane, through);
    double low = -0.01, high = 0.01;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      SymmetricTensor<double> stress = space;
      JohnsonCook::History<double> history = in_space;
      law.update({strain.xx, strain.yy, middle, strain.xy, 0, 0}, stress, history);
      (stress.zz > 0 ? high : low) = middle;
    }
    law.update({strain.xx, strain.yy, low, strain.xy, 0, 0}, space, in_space);
  }
  EXPECT_GT(in_plane.equivalent_plastic_strain, 0.1);
  EXPECT_NEAR(in_plane.equivalent_plastic_strain, in_space.equivalent_plastic_strain, 1e-4);
  EXPECT_NEAR(plane.xx, space.xx, 1e-3 * 806e6);
  EXPECT_NEAR(plane.xy, space.xy, 1e-3 * 806e6);
  EXPECT_NEAR(in_plane.temperature_rise, in_space.temperature_rise, 0.05);
}

// Far beyond any metal: the search must come to its end, which it says by a number, on the yield stress.
template <Floating Real>
void expect_found(unsigned seed, double tolerance) {
  using T = Lanes<Real>;
  RandomPath random(seed);
  const auto decades = [&](double low, double high) { return std::pow(10.0, random.uniform(low, high)); };
  for (int k = 0; k < 100000; ++k) {
    const double yield = decades(0, 10);
    const T start(random.uniform(0, 1) < 0.2 ? 0 : decades(-20, 1.5));
    const double rate_constant = random.uniform(0, 1) < 0.3 ? 0 : decades(-5, 0);
    const JohnsonCookHardening<T> law{
        yield, yield * decades(-6, 3), random.uniform(0.05, 1), rate_constant, decades(-12, 3),
        start, T(decades(-10, 0))};
    const HardeningPoint<T> near = law.at(start);
    const T stress = near.stress * T(1 + decades(-17, 3));
    const HardeningPoint<T> end = law.meet(near, stress, T(yield * decades(0, 6)));
    ASSERT_GE(end.plastic_strain[0], start[0]) << k;
    const T yields_at = law.at(end.plastic_strain).stress;
    ASSERT_NEAR(end.stress[0], yields_at[0], tolerance * static_cast<double>(yields_at[0])) << k;
  }
}
TEST(JohnsonCookHardening, SearchComesToItsEnd) {
  expect_found<double>(21, 1e-14);
  expect_found<float>(22, 1e-6);
}

TEST(JohnsonCookHardening, WhatIsNotANumberIsNotSolved) {
  const JohnsonCookHardening<double> law{800e6, 600e6, 0.2, 0.01, 1e-6, 0.1, 0.8};
  EXPECT_TRUE(std::isnan(law.meet(law.at(0.1), std::nan(""), 200e9).stress));
}

template <Floating Real>
void expect_lanes_agree(double tolerance) {
  using T = Lanes<Real>;
  JohnsonCook law = steel();
  law.time_step = 1e-6;
  RandomPath path(9);
  SymmetricTensor<T> stress{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
  JohnsonCook::History<T> history{T(0.0), T(0.0)};
  SymmetricTensor<double> alone{};
  JohnsonCook::History<double> alone_history{};
  for (int k = 0; k < 200; ++k) {
    const SymmetricTensor<double> e = path.next();
    law.update({T(e.xx), T(e.yy), T(e.zz), T(e.xy), T(e.yz), T(e.xz)}, stress, history);
    law.update(e, alone, alone_history);
    ASSERT_NEAR(static_cast<double>(stress.xy[2]), alone.xy, tolerance * 806e6);
    ASSERT_NEAR(static_cast<double>(history.temperature_rise[2]), alone_history.temperature_rise,
                tolerance * 1e3);
  }
}
TEST(JohnsonCook, LanesAgreeWithPlainNumbers) {
  expect_lanes_agree<double>(1e-9);
  expect_lanes_agree<float>(1e-2);
}

}  // namespace
}  // namespace brio
