// The filter of SAE J211 against its transfer function.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "io/plot/cfc_filter.hpp"

namespace brio {
namespace {

using std::numbers::pi;

constexpr double interval = 1e-4, channel_class = 180;

/// Amplitude of a filtered sine in the middle of a long signal.
double gain(double frequency) {
  std::vector<double> signal(20000);
  for (std::size_t i = 0; i < signal.size(); ++i)
    signal[i] = std::sin(2 * pi * frequency * interval * static_cast<double>(i));
  const std::vector<double> filtered = filter_cfc(signal, interval, channel_class);
  double sine = 0, cosine = 0, ss = 0, sc = 0, cc = 0;
  for (std::size_t i = 5000; i < 15000; ++i) {
    const double phase = 2 * pi * frequency * interval * static_cast<double>(i);
    const double s = std::sin(phase), c = std::cos(phase);
    sine += filtered[i] * s;
    cosine += filtered[i] * c;
    ss += s * s;
    sc += s * c;
    cc += c * c;
  }
  const double determinant = ss * cc - sc * sc;
  EXPECT_NEAR((ss * cosine - sc * sine) / determinant, 0, 1e-6) << "shifts the phase";
  return (cc * sine - sc * cosine) / determinant;
}

// Two passes of a Butterworth filter of two poles, by the bilinear transform: 1 / (1 + r^4).
TEST(CfcFilter, HasTheGainOfTwoPassesOfAButterworthFilter) {
  const double corner = 2.0775 * channel_class;
  for (const double frequency : {20.0, 100.0, 300.0, corner, 700.0, 1500.0}) {
    const double ratio = std::tan(pi * frequency * interval) / std::tan(pi * corner * interval);
    EXPECT_NEAR(gain(frequency), 1 / (1 + std::pow(ratio, 4)), 1e-6) << frequency;
  }
  EXPECT_NEAR(gain(corner), 0.5, 1e-6);
  EXPECT_NEAR(gain(channel_class * 5 / 3), std::sqrt(0.5), 0.02);  // 3 dB, as the class is named by
}

TEST(CfcFilter, KeepsLinesToTheEnds) {
  std::vector<double> line(400);
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = 3 + 0.5 * static_cast<double>(i);
  const std::vector<double> filtered = filter_cfc(line, interval, channel_class);
  ASSERT_EQ(filtered.size(), line.size());
  for (std::size_t i = 0; i < line.size(); ++i) EXPECT_NEAR(filtered[i], line[i], 1e-3) << i;
}

TEST(CfcFilter, NeedsTwoSamplesAPeriod) {
  EXPECT_THROW(filter_cfc(std::vector<double>(100), 1e-2, channel_class), std::invalid_argument);
}

TEST(Resampled, IsLinearBetweenTheTimes) {
  const std::vector<double> times{0, 1, 4}, values{2, 4, 1};
  const std::vector<double> result = resampled(times, values, 5);
  const std::vector<double> expected{2, 4, 3, 2, 1};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(result[i], expected[i]);
}

}  // namespace
}  // namespace brio
