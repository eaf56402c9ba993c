#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "materials/plane_stress_flow.hpp"
#include "materials/power_hardening.hpp"

namespace brio {
namespace {

constexpr double unit = 154e9;
constexpr double yield = 300e6;

struct Case {
  double part[3], rate[3];
  double plastic_strain;
};

long double yield_stress(const LinearHardening& law, long double strain) {
  return law.yield_stress + law.modulus * strain;
}
long double yield_stress(const PowerHardening& law, long double strain) {
  const long double beyond = std::max(strain - law.luders_strain, 0.0L);
  return law.yield_stress + law.constant * std::pow(beyond, static_cast<long double>(law.exponent));
}

long double slope_of(const LinearHardening& law, long double) { return law.modulus; }
long double slope_of(const PowerHardening& law, long double strain) {
  const long double beyond = std::max(strain - law.luders_strain, 1e-30L);
  return law.exponent * law.constant * std::pow(beyond, static_cast<long double>(law.exponent - 1));
}

struct Root {
  long double multiplier, strain_increment, stress;
};
long double stress_at(const Case& c, long double r) {
  long double sum = 0;
  for (int i = 0; i < 3; ++i) sum += c.part[i] / ((1 + c.rate[i] * r) * (1 + c.rate[i] * r));
  return std::sqrt(sum);
}
template <class Hardening>
Root root_of(const Case& c, const Hardening& law) {
  long double low = 0, high = 1e9L;
  const auto over = [&](long double r) {
    const long double stress = stress_at(c, r);
    return stress - yield_stress(law, c.plastic_strain + 2.0L / 3 * r * stress / unit);
  };
  for (int k = 0; k < 200; ++k) {
    // By halves of the exponent first: the multiplier can be of any size.
    const long double middle =
        high > 4 * low + 1e-24L ? std::sqrt(std::max(low, 1e-24L) * high) : 0.5L * (low + high);
    (over(middle) > 0 ? low : high) = middle;
  }
  const long double r = 0.5L * (low + high);
  const long double stress = stress_at(c, r);
  return {r, 2.0L / 3 * r * stress / unit, stress};
}

/// Random trial states: overshoots from 1e-9 to 1000, parts and rates of any proportion.
class Cases {
 public:
  explicit Cases(unsigned seed) : generator_(seed) {}

  template <class Hardening>
  Case next(const Hardening& law, double largest_overshoot) {
    std::uniform_real_distribution<double> unity(0, 1);
    Case c;
    c.plastic_strain = unity(generator_) < 0.2 ? 0.0 : std::pow(10.0, -7 + 6.5 * unity(generator_));
    const double nu = -0.5 + 0.999 * unity(generator_);
    c.rate[0] = (1 + nu) / (3 * (1 - nu));
    c.rate[1] = 1;
    c.rate[2] = 0.8 + 0.2 * unity(generator_);
    double share[3], sum = 0;
    for (double& s : share) sum += s = std::pow(10.0, -6 * unity(generator_));
    const double stress =
        static_cast<double>(yield_stress(law, c.plastic_strain)) *
        (1 + std::pow(10.0, std::log10(largest_overshoot) * unity(generator_) - 9 * unity(generator_)));
    for (int i = 0; i < 3; ++i) c.part[i] = share[i] / sum * stress * stress;
    return c;
  }

 private:
  std::mt19937_64 generator_;
};

template <class T>
void expect_root(const auto& law, unsigned seed, double largest_overshoot, double tolerance) {
  using Real = RealOf<T>;
  Cases cases(seed);
  for (int trial = 0; trial < 150; ++trial) {
    PlaneStressFlow<T> flow;
    flow.unit = unit;
    Case of_lane[NumberTraits<T>::lanes];
    const auto set = [&](T& number, int lane, double value) {
      if constexpr (std::is_same_v<T, double>) {
        number = value;
      } else {
        number.set(lane, static_cast<Real>(value));
      }
    };
    T strain;
    for (int lane = 0; lane < NumberTraits<T>::lanes; ++lane) {
      const Case c = of_lane[lane] = cases.next(law, largest_overshoot);
      set(flow.sum_squared, lane, c.part[0]);
      set(flow.shear_squared, lane, c.part[1]);
      set(flow.transverse_squared, lane, c.part[2]);
      set(flow.sum_rate, lane, c.rate[0]);
      set(flow.shear_rate, lane, c.rate[1]);
      set(flow.transverse_rate, lane, c.rate[2]);
      set(strain, lane, c.plastic_strain);
    }
    const auto start = law.at(strain);
    const auto yields = flow.sum_squared >= T(0.0);
    const PlaneStressEnd<T> end = flow_in_plane_stress(flow, law, start, yields);
    const auto get = [](const T& number, int lane) {
      if constexpr (std::is_same_v<T, double>) {
        return static_cast<double>(lane == 0 ? number : 0);
      } else {
        return static_cast<double>(number[lane]);
      }
    };
    for (int lane = 0; lane < NumberTraits<T>::lanes; ++lane) {
      const Case& c = of_lane[lane];
      SCOPED_TRACE(testing::Message()
                   << "trial " << trial << " lane " << lane << " p " << c.plastic_strain << " overshoot "
                   << stress_at(c, 0) / yield_stress(law, c.plastic_strain) - 1);
      const Root root = root_of(c, law);
      const double scale = get(end.scale, lane);
      // Round-off of the trial stress, carried to what is left of it.
      const double trial_share = static_cast<double>(stress_at(c, 0) / root.stress);
      const double left[3] = {get(end.factors.sum, lane), get(end.factors.shear, lane),
                              get(end.factors.transverse, lane)};
      // The strain that is stored is rounded; where hardening is steep that is felt.
      const double stored = static_cast<double>(c.plastic_strain + root.strain_increment);
      const double felt =
          std::numeric_limits<Real>::epsilon() * stored *
          static_cast<double>(slope_of(law, c.plastic_strain + root.strain_increment) / root.stress);
      const double elastic_strain = static_cast<double>(stress_at(c, 0)) / unit;
      ASSERT_NEAR(get(end.plastic_strain, lane),
                  static_cast<double>(c.plastic_strain + root.strain_increment),
                  tolerance * (c.plastic_strain + elastic_strain));
      for (int i = 0; i < 3; ++i) {
        const double expected = static_cast<double>(1 / (1 + c.rate[i] * root.multiplier));
        ASSERT_NEAR(scale * left[i] / expected, 1, 4 * (tolerance * trial_share + felt / c.rate[0])) << i;
        ASSERT_NEAR(get(end.multiplier, lane) * left[i], static_cast<double>(root.multiplier) * expected,
                    4 * (tolerance * trial_share + felt / c.rate[0]) * expected)
            << i;
      }
      double squared = 0;
      for (int i = 0; i < 3; ++i) squared += c.part[i] * left[i] * left[i];
      const long double stored_strain =
          static_cast<long double>(get(end.plastic_strain, lane)) + get(end.rest, lane);
      const double allowed = static_cast<double>(yield_stress(law, stored_strain));
      ASSERT_NEAR(scale * std::sqrt(squared) / allowed, 1, tolerance + felt);
    }
  }
}

TEST(PlaneStressFlow, FindsTheRootOfLinearHardening) {
  for (const double modulus : {0.0, 1e9, 50e9, 2e12}) {
    const LinearHardening law{yield, modulus};
    expect_root<Lanes<double>>(law, 1, 1e3, 1e-14);
    expect_root<double>(law, 2, 1e3, 1e-14);
    expect_root<Lanes<double>>(law, 3, 2, 5e-15);
  }
}

TEST(PlaneStressFlow, FindsTheRootOfPowerHardening) {
  for (const double exponent : {0.1, 0.3, 0.8})
    for (const double luders : {0.0, 1e-3}) {
      const PowerHardening law{yield, 500e6, exponent, luders};
      SCOPED_TRACE(testing::Message() << "exponent " << exponent << " luders " << luders);
      expect_root<Lanes<double>>(law, 4, 1e3, luders > 0 ? 1e-13 : 1e-14);
      expect_root<double>(law, 5, 1e3, luders > 0 ? 1e-13 : 1e-14);
      expect_root<Lanes<double>>(law, 6, 1.01, luders > 0 ? 1e-13 : 4e-15);
    }
}

TEST(PlaneStressFlow, FindsTheRootInSinglePrecision) {
  expect_root<Lanes<float>>(PowerHardening{yield, 500e6, 0.3, 0}, 8, 1e2, 4e-6);
  expect_root<Lanes<float>>(LinearHardening{yield, 1e9}, 7, 1e2, 2e-6);
}

// Of any sizes of stress and hardening: a root on the yield surface, or what is not a number; but it ends.
TEST(PlaneStressFlow, EndsWhateverTheSizesOfStresses) {
  using T = Lanes<double>;
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> power(-150, 150), unity(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double exponent = trial % 2 == 0 ? 1 : unity(generator);
    const PowerHardening law{std::pow(10.0, power(generator)), std::pow(10.0, power(generator)), exponent,
                             trial % 3 == 0 ? 0 : 0.005};
    PlaneStressFlow<T> flow;
    flow.unit = std::pow(10.0, power(generator));
    T strain;
    for (int lane = 0; lane < NumberTraits<T>::lanes; ++lane) {
      flow.sum_squared.set(lane, std::pow(10.0, 2 * power(generator)));
      flow.shear_squared.set(lane, std::pow(10.0, 2 * power(generator)));
      flow.transverse_squared.set(lane, std::pow(10.0, 2 * power(generator)));
      flow.sum_rate.set(lane, 0.2 + 0.8 * unity(generator));
      flow.shear_rate.set(lane, 1);
      flow.transverse_rate.set(lane, 0.9);
      strain.set(lane, 0.01 * unity(generator));
    }
    const auto start = law.at(strain);
    const PlaneStressEnd<T> end = flow_in_plane_stress(flow, law, start, flow.sum_squared >= T(0.0));
    for (int lane = 0; lane < NumberTraits<T>::lanes; ++lane) {
      if (std::isnan(end.multiplier[lane])) continue;
      EXPECT_GE(end.multiplier[lane], 0) << "trial " << trial;
    }
  }
}

}  // namespace
}  // namespace brio
