#include "src/forecast.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

// A pilot whose step has fallen by less than this says nothing of its share.
constexpr double least_fall = 0.03;
// Of pilots with elements two or three times as long, where no share can be fitted: measured on crushed cans,
// cut pipes, pierced plates and struck rods, between 1 and 2.
constexpr double typical_share = 1.5;

// The last two steps of a run share what is left and say nothing of the bound.
std::span<const MarchedStep> telling(const March& march) {
  std::span<const MarchedStep> steps = march.steps;
  return march.reached_end && steps.size() > 4 ? steps.first(steps.size() - 2) : steps;
}

// log of the first step over that of a time.
double fall(const March& march, double time) {
  const std::span<const MarchedStep> steps = telling(march);
  auto after = std::upper_bound(steps.begin(), steps.end(), time,
                                [](double t, const MarchedStep& step) { return t < step.time; });
  if (after != steps.begin()) --after;
  return std::log(steps.front().size / after->size);
}

// Wall time per step of a pilot as long as the other was marched.
double early_seconds(const March& pilot, double until) {
  constexpr std::size_t fewest = 20;
  double sum = 0;
  std::size_t count = 0;
  for (const MarchedStep& step : pilot.steps) {
    if (step.time > until && count >= fewest) break;
    sum += step.seconds;
    ++count;
  }
  return sum / static_cast<double>(count);
}

StepForecast as_it_is(const March& own, double end) {
  StepForecast forecast;
  const double left = own.reached_end ? 0 : std::ceil((end - own.time) / own.steps.back().size * (1 - 1e-12));
  forecast.steps = forecast.least = static_cast<double>(own.steps.size()) + left;
  forecast.exact = own.reached_end;
  if (own.reached_end) forecast.most = forecast.steps;
  forecast.seconds = own.seconds() + left * seconds_per_step(own, 0.5 * own.time);
  return forecast;
}

}  // namespace

std::optional<double> share_of_fall(const March& own, const March& pilot) {
  double both = 0, square = 0, largest = 0;
  for (const MarchedStep& step : telling(own)) {
    const double of_pilot = fall(pilot, step.time);
    both += step.size * of_pilot * std::log(own.steps.front().size / step.size);
    square += step.size * of_pilot * of_pilot;
    largest = std::max(largest, of_pilot);
  }
  if (largest < least_fall) return {};
  return std::clamp(both / square, 0.5, 3.0);
}

StepForecast forecast_steps(const March& own, const March& pilot, Reading reading, double end) {
  StepForecast forecast = as_it_is(own, end);
  if (own.reached_end) return forecast;
  const double first = telling(own).front().size;
  const double missed = std::log(first / telling(own).back().size) - reading.share * fall(pilot, own.time);
  const double cost = seconds_per_step(own) / early_seconds(pilot, own.time);
  forecast.share_of_fall = reading.share;
  forecast.steps = static_cast<double>(own.steps.size());
  forecast.seconds = own.seconds();
  for (const MarchedStep& step : pilot.steps) {
    const double time = std::max(step.time, own.time);
    const double covered = std::min(step.time + step.size, end) - time;
    if (covered <= 0) continue;
    const double size = first * std::exp(-reading.share * fall(pilot, time) - reading.shift * missed);
    forecast.steps += covered / size;
    forecast.seconds += covered / size * cost * step.seconds;
  }
  forecast.least = forecast.most = forecast.steps;
  return forecast;
}

StepForecast forecast_steps(const March& own, std::span<const March> pilots, double end) {
  if (pilots.empty() || own.reached_end) return as_it_is(own, end);
  constexpr std::size_t asked = 2;  // coarser ones say too little
  StepForecast forecast;
  double least = HUGE_VAL, most = 0;
  for (const March& pilot : pilots.last(std::min(asked, pilots.size()))) {
    const bool eroded = pilot.steps.back().deleted > 0;
    const std::optional<double> share = share_of_fall(own, pilot);
    std::vector<Reading> readings{{1, 1}};
    if (eroded || !share) readings.insert(readings.end(), {{1, 0}, {2, 1}});
    readings.push_back({eroded ? typical_share : share.value_or(typical_share), eroded ? 0.5 : 1});
    for (const Reading& reading : readings) {
      forecast = forecast_steps(own, pilot, reading, end);
      least = std::min(least, forecast.steps);
      most = std::max(most, forecast.steps);
    }
  }
  forecast.least = least;
  forecast.most = most;
  return forecast;
}

}  // namespace brio
