#include "materials/neo_hookean.hpp"

#include <gtest/gtest.h>

#include "materials/elastic.hpp"
#include "tests/materials/paths.hpp"

namespace brio {
namespace {

const NeoHookean rubber{1100, 5e6, 0.4};

template <class T>
T determinant(const Tensor<T>& a) {
  return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) -
         a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}

/// Stored energy per reference volume.
long double energy(const NeoHookean& law, const Tensor<long double>& f) {
  const long double mu = law.elastic().shear(), lambda = law.elastic().first_lame();
  long double squares = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) squares += f(i, j) * f(i, j);
  const long double log_volume = std::log(determinant(f));
  return mu / 2 * (squares - 3) - mu * log_volume + lambda / 2 * log_volume * log_volume;
}

/// dW/dF by central differences of fourth order.
Tensor<long double> energy_gradient(const NeoHookean& law, const Tensor<long double>& f) {
  Tensor<long double> gradient;
  const long double h = 1e-4L;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const auto at = [&](long double step) {
        Tensor<long double> g = f;
        g(i, j) += step;
        return energy(law, g);
      };
      gradient(i, j) = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    }
  return gradient;
}

SymmetricTensor<double> random_stretch(RandomPath& random) {
  const Tensor<double> axes = random_rotation(random);
  const SymmetricTensor<double> principal{
      random.uniform(0.3, 3), random.uniform(0.3, 3), random.uniform(0.3, 3), 0, 0, 0};
  return rotated(axes, principal);
}
Tensor<long double> widened(const Tensor<double>& a) {
  Tensor<long double> b;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) b(i, j) = a(i, j);
  return b;
}

TEST(NeoHookean, StressIsTheGradientOfTheEnergy) {
  RandomPath random(3);
  for (int k = 0; k < 200; ++k) {
    const SymmetricTensor<double> stretch = random_stretch(random);
    const Tensor<double> rotation = random_rotation(random);
    SymmetricTensor<double> stress{};
    NeoHookean::History<double> history{};
    rubber.update_from_stretch(stretch, stress, history);
    const Tensor<double> cauchy = full(rotated(rotation, stress));
    const Tensor<long double> f = widened(rotation * full(stretch));
    const Tensor<long double> expected =
        energy_gradient(rubber, f) * transposed(f);  // J times the Cauchy stress
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        ASSERT_NEAR(cauchy(i, j) * static_cast<double>(determinant(f)), static_cast<double>(expected(i, j)),
                    1e-9 * 5e6 * 30);
  }
}

TEST(NeoHookean, SmallStrainIsLinearElasticity) {
  const Elastic elastic{rubber.density, rubber.youngs_modulus, rubber.poissons_ratio};
  RandomPath random(4);
  for (int k = 0; k < 100; ++k) {
    const SymmetricTensor<double> strain = 1e-7 * random.next();
    SymmetricTensor<double> stress{}, linear{};
    NeoHookean::History<double> history{};
    Elastic::History<double> none;
    rubber.update_from_stretch(isotropic(1.0) + strain, stress, history);
    elastic.update(strain, linear, none);
    const double scale = 5e6 * 1e-15 * 10;  // round-off of the stretch itself
    ASSERT_NEAR(stress.xx, linear.xx, scale + 1e-8 * std::abs(linear.xx));
    ASSERT_NEAR(stress.yy, linear.yy, scale + 1e-8 * std::abs(linear.yy));
    ASSERT_NEAR(stress.zz, linear.zz, scale + 1e-8 * std::abs(linear.zz));
    ASSERT_NEAR(stress.xy, linear.xy, scale + 1e-8 * std::abs(linear.xy));
    ASSERT_NEAR(stress.xz, linear.xz, scale + 1e-8 * std::abs(linear.xz));
    ASSERT_NEAR(rubber.moduli(history).shear, elastic.elastic().shear(), 1e-4 * elastic.elastic().shear());
  }
}

TEST(NeoHookean, UniaxialStrainAndSimpleShearInClosedForm) {
  const double mu = rubber.elastic().shear(), lambda = rubber.elastic().first_lame();
  SymmetricTensor<double> stress{};
  NeoHookean::History<double> history{};
  for (double a : {0.2, 0.7, 1.0, 1.8, 4.0}) {
    rubber.update_from_stretch({a, 1, 1, 0, 0, 0}, stress, history);
    ASSERT_NEAR(stress.xx, mu * (a - 1 / a) + lambda * std::log(a) / a, 1e-13 * 5e6 * 10);
    ASSERT_NEAR(stress.yy, lambda * std::log(a) / a, 1e-13 * 5e6 * 10);
    // Waves along the stretch: J rho c^2 is the slope of the nominal stress times the stretch squared.
    const double slope = mu * (1 + 1 / (a * a)) + lambda * (1 - std::log(a)) / (a * a);
    const ElasticModuli<double> bound = rubber.moduli(history);
    const double fastest = bound.first_lame + 2 * bound.shear;
    ASSERT_GE(fastest, slope * a * (1 - 1e-12));
    if (a >= 1) {
      ASSERT_NEAR(fastest, std::max(slope * a, mu * a), 1e-12 * fastest);  // along or across
    }
  }
  for (double gamma : {0.01, 0.5, 3.0}) {
    // F = I + gamma e_x e_y: U = (C + I sqrt(det C)) / sqrt(tr C + 2 sqrt(det C)) in the plane.
    const double size = std::sqrt(4 + gamma * gamma);
    const SymmetricTensor<double> stretch{2 / size, (2 + gamma * gamma) / size, 1, gamma / size, 0, 0};
    rubber.update_from_stretch(stretch, stress, history);
    Tensor<double> inverse;  // R = F U^-1
    inverse = {{{stretch.yy, -stretch.xy, 0}, {-stretch.xy, stretch.xx, 0}, {0, 0, 1}}};
    const Tensor<double> f{{{1, gamma, 0}, {0, 1, 0}, {0, 0, 1}}};
    const SymmetricTensor<double> cauchy = rotated(f * inverse, stress);
    const double round_off = 1e-14 * 5e6 * (1 + gamma * gamma);
    ASSERT_NEAR(cauchy.xy, mu * gamma, round_off);
    ASSERT_NEAR(cauchy.xx, mu * gamma * gamma, round_off);
    ASSERT_NEAR(cauchy.yy, 0, round_off);
    ASSERT_NEAR(cauchy.zz, 0, round_off);
  }
}

TEST(NeoHookean, NoWaveIsFasterThanTheModuliSay) {
  RandomPath random(5);
  double tightest[2] = {};
  for (int k = 0; k < 100; ++k) {
    const SymmetricTensor<double> stretch = random_stretch(random);
    SymmetricTensor<double> stress{};
    NeoHookean::History<double> history{};
    rubber.update_from_stretch(stretch, stress, history);
    const ElasticModuli<double> bound = rubber.moduli(history);
    const Tensor<long double> f = widened(full(stretch));
    const auto volume = static_cast<double>(determinant(f));
    for (int direction = 0; direction < 20; ++direction) {
      // A wave with direction n and polarization a strains F by a (F^T n): the second difference of the
      // energy.
      const SymmetricTensor<double> v = random.next();
      const double n_size = std::sqrt(v.xx * v.xx + v.yy * v.yy + v.zz * v.zz);
      const double n[3] = {v.xx / n_size, v.yy / n_size, v.zz / n_size};
      double a[3];
      if (direction % 2 == 0) {
        for (int i = 0; i < 3; ++i) a[i] = n[i];  // along
      } else {
        for (int i = 0; i < 3; ++i) a[i] = n[(i + 1) % 3] * v.xy - n[(i + 2) % 3] * v.yz;
        const double along = a[0] * n[0] + a[1] * n[1] + a[2] * n[2];
        for (int i = 0; i < 3; ++i) a[i] -= along * n[i];  // across
        const double size = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        for (double& c : a) c /= size;
      }
      const auto at = [&](long double step) {
        Tensor<long double> g = f;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            for (int m = 0; m < 3; ++m) g(i, j) += step * a[i] * n[m] * f(m, j);
        return energy(rubber, g);
      };
      const long double h = 1e-4L;
      const auto modulus = static_cast<double>((at(h) - 2 * at(0) + at(-h)) / (h * h)) / volume;
      const double largest = direction % 2 == 0 ? bound.first_lame + 2 * bound.shear : bound.shear;
      ASSERT_LE(modulus, largest * (1 + 1e-6));
      tightest[direction % 2] = std::max(tightest[direction % 2], modulus / largest);
    }
  }
  EXPECT_GT(tightest[0], 0.9);
  EXPECT_GT(tightest[1], 0.9);
}

}  // namespace
}  // namespace brio
