#include "src/forecast.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

// A pilot whose step has fallen by less than this says nothing of its share.
constexpr double least_fall = 0.03;
// Exponents of the trend of the falls of pilots, see the header.
constexpr double usual_exponent = 0.75, largest_exponent = 1.25;

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
  return std::clamp(both / square, 0.5, 2.5);
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

double share_by_trend(std::span<const Pilot> pilots) {
  const auto mean_fall = [](const March& pilot) {
    double sum = 0;
    for (const MarchedStep& step : telling(pilot)) sum += step.size * fall(pilot, step.time);
    return sum / pilot.time;
  };
  const Pilot& finest = pilots.back();
  double exponent = usual_exponent;
  if (pilots.size() > 1) {
    const Pilot& other = pilots[pilots.size() - 2];
    const double coarse = mean_fall(other.march), fine = mean_fall(finest.march);
    if (coarse > least_fall && fine > least_fall)
      exponent =
          std::clamp(std::log(fine / coarse) / std::log(other.factor / finest.factor), 0.0, largest_exponent);
  }
  return std::pow(finest.factor, exponent);
}

StepForecast forecast_steps(const March& own, std::span<const Pilot> pilots, double end) {
  const StepForecast stays = as_it_is(own, end);
  if (pilots.empty() || own.reached_end) return stays;
  const March& pilot = pilots.back().march;
  const bool eroded = pilot.steps.back().deleted > 0;
  const double by_trend = share_by_trend(pilots);
  const double fitted = share_of_fall(own, pilot).value_or(by_trend);
  const Reading best = eroded ? Reading{by_trend, 0} : Reading{fitted, 1};
  StepForecast forecast = forecast_steps(own, pilot, best, end);
  double least = std::min(forecast.steps, stays.steps), most = std::max(forecast.steps, stays.steps);
  // A single pilot shows no trend.
  const double steepest = pilots.size() > 1 ? by_trend : std::pow(pilots.back().factor, largest_exponent);
  for (const Reading& reading :
       {Reading{1, eroded ? 0.0 : 1.0}, Reading{fitted, 1}, Reading{by_trend, 1}, Reading{steepest, 1}}) {
    const double steps = forecast_steps(own, pilot, reading, end).steps;
    least = std::min(least, steps);
    most = std::max(most, steps);
  }
  // Readings may agree and be wrong: steps that are still to come are known to a tenth at best.
  const auto marched = static_cast<double>(own.steps.size());
  forecast.least = marched + 0.9 * (least - marched);
  forecast.most = marched + 1.1 * (most - marched);
  return forecast;
}

}  // namespace brio
