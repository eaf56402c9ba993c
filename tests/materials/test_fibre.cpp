// Fibres of beams: the return of plastic_flow.hpp for a state that is free to contract.

#include <gtest/gtest.h>

#include "materials/failing.hpp"
#include "materials/material.hpp"
#include "src/base/index.hpp"
#include "tests/materials/paths.hpp"

namespace brio {
namespace {

ElasticPlastic mixed_hardening(double mix) {
  return {.density = 1,
          .youngs_modulus = 200e9,
          .poissons_ratio = 0.3,
          .yield_stress = 300e6,
          .hardening_modulus = 2e9,
          .hardening_mix = mix};
}
IsotropicElasticPlastic isotropic_hardening() { return {mixed_hardening(0)}; }
PowerLawHardening power_law(double luders_strain) {
  return {.density = 1,
          .youngs_modulus = 200e9,
          .poissons_ratio = 0.3,
          .yield_stress = 300e6,
          .hardening_constant = 500e6,
          .hardening_exponent = 0.3,
          .luders_strain = luders_strain};
}
JohnsonCook johnson_cook() {
  JohnsonCook law{.density = 7850,
                  .youngs_modulus = 200e9,
                  .poissons_ratio = 0.3,
                  .yield_stress = 300e6,
                  .hardening_constant = 500e6,
                  .hardening_exponent = 0.3,
                  .rate_constant = 0.02};
  law.thermal = ThermalSoftening{.specific_heat = 450, .melting_temperature = 1500, .exponent = 1};
  law.time_step = 1e-6;
  return law;
}

/// The three-dimensional law with the strain across the fibre at which no stress is left across: the root of
/// the mean of both, by bisection.
template <class Law>
FibreTensor<double> fibre_in_space(const Law& law, const FibreTensor<double>& strain,
                                   SymmetricTensor<double>& stress,
                                   typename Law::template History<double>& history) {
  const auto try_across = [&](double across, SymmetricTensor<double>& end, auto& state) {
    end = stress;
    state = history;
    law.update({strain.xx, across, across, strain.xy, 0, strain.xz}, end, state);
    return 0.5 * (end.yy + end.zz);
  };
  SymmetricTensor<double> end;
  auto state = history;
  double low = -2 * std::abs(strain.xx) - 1e-3, high = -low;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (try_across(middle, end, state) < 0 ? low : high) = middle;
  }
  stress = end;
  history = state;
  return {end.xx, end.xy, end.xz};
}

template <class Law>
void expect_law_in_space(const Law& law, double tolerance) {
  RandomPath path(5, 5e-3);
  FibreTensor<double> stress{};
  SymmetricTensor<double> in_space{};
  typename Law::template History<double> history{}, space_history{};
  double largest = 0;
  for (int step = 0; step < 60; ++step) {
    const SymmetricTensor<double> random = path.next();
    const FibreTensor<double> strain{random.xx, random.xy, random.xz};
    law.update_fibre(strain, stress, history);
    const FibreTensor<double> expected = fibre_in_space(law, strain, in_space, space_history);
    largest = std::max(largest, std::abs(stress.xx) + std::abs(stress.xy));
    const double size = tolerance * 300e6;
    ASSERT_NEAR(stress.xx, expected.xx, size) << step;
    ASSERT_NEAR(stress.xy, expected.xy, size) << step;
    ASSERT_NEAR(stress.xz, expected.xz, size) << step;
    if constexpr (requires { history.equivalent_plastic_strain; }) {
      ASSERT_NEAR(history.equivalent_plastic_strain, space_history.equivalent_plastic_strain, tolerance)
          << step;
    }
  }
  EXPECT_GT(largest, 200e6);
}

TEST(Fibre, IsTheThreeDimensionalLawWithNoStressAcross) {
  expect_law_in_space(Elastic{.density = 1, .youngs_modulus = 200e9, .poissons_ratio = 0.3}, 1e-6);
  expect_law_in_space(isotropic_hardening(), 1e-6);
  expect_law_in_space(mixed_hardening(0.4), 1e-6);
  expect_law_in_space(mixed_hardening(1), 1e-6);
  expect_law_in_space(power_law(0), 1e-6);
  expect_law_in_space(power_law(0.01), 1e-6);
  expect_law_in_space(johnson_cook(), 1e-6);
}

TEST(Fibre, TensionFollowsTheHardeningCurve) {
  const PowerLawHardening law = power_law(0);
  FibreTensor<double> stress{};
  PowerLawHardening::History<double> history{};
  for (int step = 1; step <= 1000; ++step) {
    law.update_fibre({1e-4, 0.0, 0.0}, stress, history);
    const double plastic = 1e-4 * step - stress.xx / 200e9;
    if (history.equivalent_plastic_strain == 0) continue;
    ASSERT_NEAR(history.equivalent_plastic_strain / plastic, 1, 1e-9);
    ASSERT_NEAR(stress.xx / (300e6 + 500e6 * std::pow(plastic, 0.3)), 1, 1e-9);
  }
  EXPECT_GT(stress.xx, 500e6);
}

TEST(Fibre, LanesDoWhatPlainNumbersDo) {
  const ElasticPlastic law = mixed_hardening(0.5);
  using T = Lanes<double>;
  FibreTensor<T> stress{T(0.0), T(0.0), T(0.0)};
  ElasticPlastic::History<T> history{T(0.0), isotropic(T(0.0))};
  std::vector<FibreTensor<double>> plain(8);
  std::vector<ElasticPlastic::History<double>> plain_history(8);
  std::vector<RandomPath> paths;
  for (unsigned lane = 0; lane < 8; ++lane) paths.emplace_back(lane, 3e-3);
  for (int step = 0; step < 50; ++step) {
    FibreTensor<T> strain{T(0.0), T(0.0), T(0.0)};
    for (int lane = 0; lane < 8; ++lane) {
      const auto k = index(lane);
      const SymmetricTensor<double> random = paths[k].next();
      strain.xx.set(lane, random.xx);
      strain.xy.set(lane, random.xy);
      strain.xz.set(lane, random.xz);
      law.update_fibre({random.xx, random.xy, random.xz}, plain[k], plain_history[k]);
    }
    law.update_fibre(strain, stress, history);
    for (int lane = 0; lane < 8; ++lane) ASSERT_NEAR(stress.xx[lane], plain[index(lane)].xx, 1e-3);
  }
}

TEST(Fibre, DamageByOpeningLetsGoAsTensionDoes) {
  ElasticPlastic deck = mixed_hardening(0);
  deck.failure.emplace();
  deck.failure->strain = 0.05;
  deck.failure->opening_strain = 0.1;
  const Failing<IsotropicElasticPlastic> law{deck};
  FibreTensor<double> stress{};
  Failing<IsotropicElasticPlastic>::History<double> history{};
  law.start(history, 1.0);
  int steps = 0;
  double damage_at = 0;
  while (!law.has_failed(history) && steps < 10000) {
    law.update_fibre({1e-4, 0.0, 0.0}, stress, history);
    ++steps;
    if (damage_at == 0 && history.damage > 0) damage_at = 1e-4 * steps;
  }
  // Sets in at the failure strain, and takes 0.9 of the opening strain to the end.
  EXPECT_NEAR(damage_at, 0.05 + 400e6 / 200e9, 3e-4);
  EXPECT_NEAR(1e-4 * steps - damage_at, 0.09, 3e-4);
  EXPECT_EQ(stress.xx, 0);
  law.update_fibre({1e-4, 0.0, 0.0}, stress, history);
  EXPECT_EQ(stress.xx, 0);
}

}  // namespace
}  // namespace brio
