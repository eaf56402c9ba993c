#include "src/base/lane_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "src/base/gather.hpp"

namespace brio {
namespace {

/// Distance in units in the last place of the value in long double (64-bit mantissa: a reference that is good
/// enough).
template <class Real>
double units(Real value, long double exact) {
  const auto rounded = static_cast<Real>(exact);
  if (value == rounded) return 0;
  if (!std::isfinite(value) || !std::isfinite(rounded)) return HUGE_VAL;
  const Real above = std::nextafter(std::abs(rounded), std::numeric_limits<Real>::infinity());
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact) /
                             (static_cast<long double>(above) - static_cast<long double>(std::abs(rounded))));
}

template <class Real>
Lanes<Real> lanes_from(std::mt19937_64& engine, double low, double high, bool logarithmic) {
  Lanes<Real> x;
  for (int lane = 0; lane < lane_count<Real>; ++lane) {
    const double u = std::uniform_real_distribution<double>(low, high)(engine);
    x.set(lane, static_cast<Real>(logarithmic ? std::exp2(u) : u));
  }
  return x;
}

template <class Real>
class LaneMath : public testing::Test {};
using Precisions = testing::Types<double, float>;
TYPED_TEST_SUITE(LaneMath, Precisions);

TYPED_TEST(LaneMath, LogarithmIsRightToTheLastPlace) {
  using Real = TypeParam;
  std::mt19937_64 engine(1);
  const double lowest = std::log2(static_cast<double>(std::numeric_limits<Real>::denorm_min()));
  const double highest = std::numeric_limits<Real>::max_exponent - 1e-3;
  double worst = 0;
  for (int round = 0; round < 20000; ++round) {
    const bool near_one = round % 2 == 0;
    const auto x =
        near_one ? lanes_from<Real>(engine, 0.5, 2, false) : lanes_from<Real>(engine, lowest, highest, true);
    const auto y = log(x);
    for (int lane = 0; lane < lane_count<Real>; ++lane)
      worst = std::max(worst, units<Real>(y[lane], std::log(static_cast<long double>(x[lane]))));
  }
  this->RecordProperty("worst_units", std::to_string(worst));
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(worst, 0.5);
}

TYPED_TEST(LaneMath, ExponentialIsRightToTheLastPlace) {
  using Real = TypeParam;
  std::mt19937_64 engine(2);
  const double lowest = 0.7 * (std::numeric_limits<Real>::min_exponent + 4);
  const double highest = 0.693 * std::numeric_limits<Real>::max_exponent;
  double worst = 0;
  for (int round = 0; round < 20000; ++round) {
    const bool near_zero = round % 2 == 0;
    const auto x =
        near_zero ? lanes_from<Real>(engine, -1, 1, false) : lanes_from<Real>(engine, lowest, highest, false);
    const auto y = exp(x);
    for (int lane = 0; lane < lane_count<Real>; ++lane)
      worst = std::max(worst, units<Real>(y[lane], std::exp(static_cast<long double>(x[lane]))));
  }
  this->RecordProperty("worst_units", std::to_string(worst));
  EXPECT_LE(worst, 1.1);
  EXPECT_GT(worst, 0.5);
}

TYPED_TEST(LaneMath, PowerIsRightToAFewLastPlaces) {
  using Real = TypeParam;
  std::mt19937_64 engine(3);
  const double lowest = std::log2(static_cast<double>(std::numeric_limits<Real>::denorm_min()));
  const double highest = std::numeric_limits<Real>::max_exponent - 1e-3;
  for (double largest_exponent : {1.0, 5.0, 20.0}) {
    double worst = 0;
    for (int round = 0; round < 10000; ++round) {
      const bool near_one = round % 2 == 0;
      const auto x = near_one ? lanes_from<Real>(engine, 0.5, 2, false)
                              : lanes_from<Real>(engine, lowest, highest, true);
      const auto y = lanes_from<Real>(engine, -largest_exponent, largest_exponent, false);
      const auto z = pow(x, y);
      for (int lane = 0; lane < lane_count<Real>; ++lane) {
        const long double exact =
            std::pow(static_cast<long double>(x[lane]), static_cast<long double>(y[lane]));
        if (exact > static_cast<long double>(std::numeric_limits<Real>::max()) ||
            exact < static_cast<long double>(std::numeric_limits<Real>::min()))
          continue;
        worst = std::max(worst, units<Real>(z[lane], exact) - std::abs(static_cast<double>(y[lane])));
      }
    }
    this->RecordProperty("worst_units_beyond_exponent_" + std::to_string(largest_exponent),
                         std::to_string(worst));
    EXPECT_LE(worst, 1.25);
    EXPECT_GT(worst, 0.0);
  }
}

TYPED_TEST(LaneMath, EndsOfTheDomain) {
  using Real = TypeParam;
  using T = Lanes<Real>;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto least = static_cast<double>(std::numeric_limits<Real>::denorm_min());
  const auto largest = static_cast<double>(std::numeric_limits<Real>::max());
  EXPECT_EQ(log(T(0.0))[0], -infinity);
  EXPECT_EQ(log(T(infinity))[0], infinity);
  EXPECT_EQ(log(T(1.0))[0], 0);
  EXPECT_TRUE(std::isnan(log(T(-1.0))[0]));
  EXPECT_TRUE(std::isnan(log(T(nan))[0]));
  EXPECT_EQ(exp(T(0.0))[0], 1);
  EXPECT_EQ(exp(T(-infinity))[0], 0);
  EXPECT_EQ(exp(T(-largest))[0], 0);
  EXPECT_EQ(exp(T(infinity))[0], infinity);
  EXPECT_TRUE(std::isnan(exp(T(nan))[0]));
  EXPECT_NEAR(static_cast<double>(exp(log(T(least)))[0]) / least, 1, 0);  // subnormal results come out
  EXPECT_EQ(pow(T(0.0), 0.05)[0], 0);
  EXPECT_EQ(pow(T(0.0), 0.0)[0], 1);
  EXPECT_EQ(pow(T(0.0), -0.5)[0], infinity);
  EXPECT_EQ(pow(T(infinity), 0.5)[0], infinity);
  EXPECT_EQ(pow(T(infinity), -0.5)[0], 0);
  EXPECT_EQ(pow(T(17.0), 0.0)[0], 1);
  EXPECT_EQ(pow(T(1.0), 1000.0)[0], 1);
  EXPECT_EQ(pow(T(2.0), -1000.0)[0], static_cast<Real>(std::exp2(-1000.0)));
  EXPECT_EQ(pow(T(least), 1.0)[0], static_cast<Real>(least));
  EXPECT_EQ(pow(T(largest), 2.0)[0], infinity);
  EXPECT_TRUE(std::isnan(pow(T(-1.0), 2.0)[0]));
  EXPECT_TRUE(std::isnan(pow(T(nan), 0.5)[0]));
}

TEST(LanesOfDoubles, InverseSquareRootIsRightToTheLastPlaces) {
  std::mt19937_64 engine(4);
  double worst = 0;
  for (int round = 0; round < 20000; ++round) {
    const auto a = lanes_from<double>(engine, -960, 960, true);
    const auto root = inverse_square_root(a);
    for (int lane = 0; lane < lane_count<double>; ++lane)
      worst = std::max(worst, units(root[lane], 1 / std::sqrt(static_cast<long double>(a[lane]))));
  }
  EXPECT_LE(worst, 2.5);
}

TEST(LanesOfDoubles, SumsOverLanesAreThoseOfEachNumber) {
  Row8 number[8];
  double expected[8] = {};
  for (int k = 0; k < 8; ++k)
    for (int lane = 0; lane < 8; ++lane) {
      const double value = (1 << lane) + 1000 * k;
      set_lane(number[k], lane, value);
      expected[k] += value;
    }
  const Row8 sums = sums_over_lanes(number);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(sums[k], expected[k]) << k;
}

}  // namespace
}  // namespace brio
