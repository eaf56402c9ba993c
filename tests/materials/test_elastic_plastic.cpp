#include <gtest/gtest.h>

#include "materials/elastic_plastic.hpp"
#include "tests/materials/paths.hpp"

namespace brio {
namespace {

constexpr double young = 200e9;
constexpr double poisson = 0.3;
constexpr double yield = 400e6;

ElasticPlastic steel(double modulus, double mix) { return {7800, young, poisson, yield, modulus, mix}; }

TEST(ElasticPlastic, StressNeverLeavesTheYieldSurface) {
  for (double mix : {0.0, 0.3, 1.0})
    for (double modulus : {0.0, 1e9, 2e12}) {
      const ElasticPlastic law = steel(modulus, mix);
      RandomPath path(1);
      SymmetricTensor<double> stress{};
      ElasticPlastic::History<double> history{};
      int plastic_steps = 0;
      for (int step = 0; step < 2000; ++step) {
        const SymmetricTensor<double> strain = path.next();
        const double before = history.equivalent_plastic_strain;
        const SymmetricTensor<double> old_stress = stress;
        law.update(strain, stress, history);
        const double effective = von_mises(relative_deviator(stress, history));
        const double allowed = law.hardening().at(history.equivalent_plastic_strain).stress;
        const double round_off = 1e-15 * std::abs(trace(stress));
        ASSERT_LE(effective, allowed * (1 + 1e-12) + round_off);
        if (history.equivalent_plastic_strain > before) {
          ++plastic_steps;
          ASSERT_NEAR(effective, allowed, 1e-12 * allowed + round_off);
          // What the strain does not put into the elastic stress is plastic work, and it is never negative.
          const SymmetricTensor<double> plastic = law.elastic().stress(strain) - (stress - old_stress);
          ASSERT_GT(contract(relative_deviator(stress, history), plastic), 0);
        } else {
          ASSERT_EQ(history.equivalent_plastic_strain, before);
        }
      }
      EXPECT_GT(plastic_steps, 100);
    }
}

TEST(ElasticPlastic, UniaxialCurveIsBilinear) {
  const double modulus = 10e9;
  for (double mix : {0.0, 0.5, 1.0}) {
    const ElasticPlastic law = steel(modulus, mix);
    ShellTensor<double> stress{};
    ElasticPlastic::History<double> history{};
    double thickness = 0;
    const double step = 1e-4;
    for (int i = 1; i <= 200; ++i) {
      // The strain across that keeps sigma_yy zero: bisection, for sigma_yy grows with it.
      double low = -2 * step, high = 2 * step;
      for (int k = 0; k < 70; ++k) {
        const double middle = 0.5 * (low + high);
        ShellTensor<double> s = stress;
        ElasticPlastic::History<double> h = history;
        law.update_plane_stress({step, middle, 0, 0, 0}, 1.0, s, h, thickness);
        (s.yy < 0 ? low : high) = middle;
      }
      law.update_plane_stress({step, low, 0, 0, 0}, 1.0, stress, history, thickness);
      const double strain = i * step;
      const double plastic = std::max(0.0, (young * strain - yield) / (young + modulus));
      ASSERT_NEAR(stress.xx, young * (strain - plastic), 1e-11 * yield);
      ASSERT_NEAR(history.equivalent_plastic_strain, plastic, 1e-13);
      ASSERT_NEAR(thickness, low, 1e-13);
    }
  }
}

TEST(ElasticPlastic, KinematicHardeningKeepsTheElasticRangeAndIsotropicDoublesIt) {
  const double modulus = 20e9, shear = young / (2 * (1 + poisson));
  for (double mix : {0.0, 0.25, 1.0}) {
    const ElasticPlastic law = steel(modulus, mix);
    SymmetricTensor<double> stress{};
    ElasticPlastic::History<double> history{};
    for (int i = 0; i < 100; ++i) law.update({0, 0, 0, 1e-4, 0, 0}, stress, history);
    const double forward = std::sqrt(3.0) * stress.xy;
    const double hardened = modulus * history.equivalent_plastic_strain;
    ASSERT_NEAR(forward, yield + hardened, 1e-12 * forward);
    ASSERT_NEAR(forward, std::sqrt(3.0) * 2 * shear * 1e-2 - 3 * shear * history.equivalent_plastic_strain,
                1e-12 * forward);
    const double plastic = history.equivalent_plastic_strain;
    while (history.equivalent_plastic_strain == plastic) law.update({0, 0, 0, -1e-7, 0, 0}, stress, history);
    // Flow starts again after the diameter of the surface: twice the initial yield stress and the isotropic
    // growth.
    const double diameter = 2 * (yield + (1 - mix) * hardened);
    EXPECT_NEAR(forward - std::sqrt(3.0) * stress.xy, diameter, std::sqrt(3.0) * 2 * shear * 1.1e-7);
  }
}

TEST(ElasticPlastic, PlaneStressIsTheThreeDimensionalLawWithoutStressAcross) {
  for (double mix : {0.0, 0.4, 1.0})
    for (double ratio : {-0.9, 0.0, 0.3, 0.4999}) {
      ElasticPlastic law = steel(5e9, mix);
      law.poissons_ratio = ratio;
      RandomPath path(7, 2e-2);
      ShellTensor<double> stress{};
      ElasticPlastic::History<double> history{}, space_history{};
      SymmetricTensor<double> space_stress{};
      for (int step = 0; step < 300; ++step) {
        const SymmetricTensor<double> strain = path.next();
        double thickness = 0;
        law.update_plane_stress(in_plane(strain), 1.0, stress, history, thickness);
        // The strain across with sigma_zz = 0: bisection, for sigma_zz grows with it.
        double low = -1, high = 1;
        for (int k = 0; k < 100; ++k) {
          const double middle = 0.5 * (low + high);
          SymmetricTensor<double> s = space_stress;
          ElasticPlastic::History<double> h = space_history;
          law.update({strain.xx, strain.yy, middle, strain.xy, strain.yz, strain.xz}, s, h);
          (s.zz < 0 ? low : high) = middle;
        }
        const double across = 0.5 * (low + high);
        law.update({strain.xx, strain.yy, across, strain.xy, strain.yz, strain.xz}, space_stress,
                   space_history);
        ASSERT_NEAR(thickness, across, 1e-11);
        const double scale = 1e-9 * yield;
        ASSERT_NEAR(stress.xx, space_stress.xx, scale);
        ASSERT_NEAR(stress.yy, space_stress.yy, scale);
        ASSERT_NEAR(stress.xy, space_stress.xy, scale);
        ASSERT_NEAR(stress.yz, space_stress.yz, scale);
        ASSERT_NEAR(stress.xz, space_stress.xz, scale);
        ASSERT_NEAR(history.equivalent_plastic_strain, space_history.equivalent_plastic_strain, 1e-10);
        ASSERT_NEAR(history.back_stress.xx, space_history.back_stress.xx, scale);
        ASSERT_NEAR(history.back_stress.zz, space_history.back_stress.zz, scale);
      }
      EXPECT_GT(history.equivalent_plastic_strain, 0.05);
    }
}

}  // namespace
}  // namespace brio
