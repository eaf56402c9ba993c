#include "io/plot/cfc_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "src/base/index.hpp"

namespace brio {

namespace {

/// Coefficients of the recursion of SAE J211-1, appendix C.
struct TwoPoles {
  double a0, a1, a2, b1, b2;
};

TwoPoles two_poles(double interval, double channel_class) {
  const double corner = 2 * std::numbers::pi * 2.0775 * channel_class;
  if (!(corner * interval < std::numbers::pi))
    throw std::invalid_argument("the history has too few rows for this filter class");
  const double w = std::tan(0.5 * corner * interval);
  const double denominator = 1 + std::numbers::sqrt2 * w + w * w;
  const double a0 = w * w / denominator;
  return {a0, 2 * a0, a0, -2 * (w * w - 1) / denominator,
          (-1 + std::numbers::sqrt2 * w - w * w) / denominator};
}

// Starts from the steady state of the first sample.
void filter_forwards(const TwoPoles& c, std::vector<double>& signal) {
  double x1 = signal.front(), x2 = x1, y1 = x1, y2 = x1;
  for (double& sample : signal) {
    const double x = sample;
    sample = c.a0 * x + c.a1 * x1 + c.a2 * x2 + c.b1 * y1 + c.b2 * y2;
    x2 = std::exchange(x1, x);
    y2 = std::exchange(y1, sample);
  }
}

}  // namespace

std::vector<double> filter_cfc(std::span<const double> samples, double interval, double channel_class) {
  const TwoPoles coefficients = two_poles(interval, channel_class);
  const std::size_t count = samples.size();
  const auto periods = std::ceil(2 / (channel_class * interval));  // after which the start is forgotten
  const std::size_t beyond = std::min(count - 1, static_cast<std::size_t>(periods));
  std::vector<double> signal;
  signal.reserve(count + 2 * beyond);
  for (std::size_t i = beyond; i > 0; --i) signal.push_back(2 * samples.front() - samples[i]);
  signal.insert(signal.end(), samples.begin(), samples.end());
  for (std::size_t i = 1; i <= beyond; ++i) signal.push_back(2 * samples.back() - samples[count - 1 - i]);
  for (int way = 0; way < 2; ++way) {
    filter_forwards(coefficients, signal);
    std::ranges::reverse(signal);
  }
  return {signal.begin() + static_cast<std::ptrdiff_t>(beyond),
          signal.begin() + static_cast<std::ptrdiff_t>(beyond + count)};
}

std::vector<double> resampled(std::span<const double> times, std::span<const double> values,
                              std::size_t count) {
  std::vector<double> result(count);
  std::size_t row = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = times.front() + (times.back() - times.front()) * static_cast<double>(i) /
                                            static_cast<double>(count - 1);
    while (row + 2 < times.size() && times[row + 1] < time) ++row;
    const double share = (time - times[row]) / (times[row + 1] - times[row]);
    result[i] = std::lerp(values[row], values[row + 1], std::clamp(share, 0.0, 1.0));
  }
  return result;
}

}  // namespace brio
