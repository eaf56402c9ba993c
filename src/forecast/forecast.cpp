#include "src/forecast/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace brio {

namespace {

// Exponent of the number of elements with which falls grow, see the header.
constexpr double usual_exponent = 0.4, largest_exponent = 1;
// Mean square of a fall, over all of the time, that says as much of the share as experience does.
constexpr double telling_fall = 0.1;
// Shares of the time over which what a pilot misses fades, and where elements are deleted.
constexpr double lasting = 0.5, lasting_among_deletions = 0.05;

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

// A pilot that shows little of the fall at the end of the march is believed less: 0 to 1.
double doubt_in(const March& own, const March& pilot, double share) {
  constexpr double small_fall = 0.1;
  const std::span<const MarchedStep> steps = telling(own);
  const double shown = share * fall(pilot, own.time);
  const double missed = std::log(steps.front().size / steps.back().size) - shown;
  return missed * missed / (missed * missed + shown * shown + small_fall * small_fall);
}

// Takes steps that are still to come between those of two forecasts, in logarithms; each costs what it did.
void lean_towards(const StepForecast& other, double weight, const March& own, StepForecast& forecast) {
  const auto marched = static_cast<double>(own.steps.size());
  const double steps = std::pow(forecast.steps, 1 - weight) * std::pow(other.steps, weight);
  const double change = (steps - marched) / (forecast.steps - marched);
  forecast.seconds = own.seconds() + change * (forecast.seconds - own.seconds());
  forecast.steps = steps;
}

// Time per step of a march as a straight line in that of a pilot at the same times, c + b (p - mean p): with
// the slope that fits, between none and that of proportion, which is taken where the pilot's hardly changes.
struct CostLine {
  double mean = 0, slope = 0;  ///< slope times the mean of the pilot over that of the march: 0 to 1
  double pilot_mean = 1;
  double at(double pilot) const { return mean * (1 + slope * (pilot / pilot_mean - 1)); }
};

// Mean over about a fiftieth of the steps, around each.
std::vector<double> smooth_cost(const March& march) {
  constexpr std::size_t stretches = 50;
  const std::size_t steps = march.steps.size(), length = steps / stretches + 1;
  std::vector<double> cost(steps);
  for (std::size_t begin = 0; begin < steps; begin += length) {
    const std::size_t count = std::min(length, steps - begin);
    double sum = 0;
    for (std::size_t i = begin; i < begin + count; ++i) sum += march.steps[i].seconds;
    std::fill_n(cost.begin() + static_cast<std::ptrdiff_t>(begin), count, sum / static_cast<double>(count));
  }
  return cost;
}

CostLine cost_line(const March& own, const March& pilot, const std::vector<double>& pilot_cost) {
  constexpr double weight_of_proportion = 0.05;  // as a variance of relative cost
  const std::vector<double> own_cost = smooth_cost(own);
  std::vector<double> at_same_time(own.steps.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < own.steps.size(); ++i) {
    while (next + 1 < pilot.steps.size() && pilot.steps[next + 1].time <= own.steps[i].time) ++next;
    at_same_time[i] = pilot_cost[next];
  }
  const auto count = static_cast<double>(own.steps.size());
  CostLine line;
  line.mean = std::accumulate(own_cost.begin(), own_cost.end(), 0.0) / count;
  line.pilot_mean = std::accumulate(at_same_time.begin(), at_same_time.end(), 0.0) / count;
  if (!(line.pilot_mean > 0)) return {line.mean, 0, 1};  // shorter than the clock can tell
  double both = weight_of_proportion * count, square = both;
  for (std::size_t i = 0; i < own.steps.size(); ++i) {
    const double x = at_same_time[i] / line.pilot_mean - 1;
    both += x * (own_cost[i] / line.mean - 1);
    square += x * x;
  }
  line.slope = std::clamp(both / square, 0.0, 1.0);
  return line;
}

}  // namespace

StepForecast forecast_steps(const March& own, double end) {
  StepForecast forecast;
  const double left = own.reached_end ? 0 : std::ceil((end - own.time) / own.steps.back().size * (1 - 1e-12));
  forecast.steps = forecast.least = static_cast<double>(own.steps.size()) + left;
  forecast.exact = own.reached_end;
  if (own.reached_end) forecast.most = forecast.steps;
  forecast.seconds = own.seconds() + left * seconds_per_step(own, 0.5 * own.time);
  return forecast;
}

double share_of_fall(const March& own, const March& pilot, double usual, double end) {
  double both = telling_fall * end * usual, square = telling_fall * end;
  for (const MarchedStep& step : telling(own)) {
    const double of_pilot = fall(pilot, step.time);
    both += step.size * of_pilot * std::log(own.steps.front().size / step.size);
    square += step.size * of_pilot * of_pilot;
  }
  return std::max(both / square, 0.3);
}

StepForecast forecast_steps(const March& own, const March& pilot, Reading reading, double end) {
  StepForecast forecast = forecast_steps(own, end);
  if (own.reached_end) return forecast;
  const double first = telling(own).front().size;
  const double missed = std::log(first / telling(own).back().size) - reading.share * fall(pilot, own.time);
  const std::vector<double> pilot_cost = smooth_cost(pilot);
  const CostLine cost = cost_line(own, pilot, pilot_cost);
  forecast.share_of_fall = reading.share;
  forecast.steps = static_cast<double>(own.steps.size());
  forecast.seconds = own.seconds();
  for (std::size_t i = 0; i < pilot.steps.size(); ++i) {
    const MarchedStep& step = pilot.steps[i];
    const double time = std::max(step.time, own.time);
    const double covered = std::min(step.time + step.size, end) - time;
    if (covered <= 0) continue;
    const double left = missed * std::exp((own.time - time) / reading.lasting);
    const double size = first * std::exp(-reading.share * fall(pilot, time) - left);
    forecast.steps += covered / size;
    forecast.seconds += covered / size * cost.at(pilot_cost[i]);
  }
  forecast.least = forecast.most = forecast.steps;
  return forecast;
}

StepForecast forecast_steps(const March& own, const Pilot& pilot, double end) {
  const StepForecast stays = forecast_steps(own, end);
  if (own.reached_end) return stays;
  const bool eroded = pilot.march.steps.back().deleted > 0;
  const double usual = std::pow(pilot.factor, usual_exponent);
  const double share = eroded ? usual : share_of_fall(own, pilot.march, usual, end);
  const double fades = (eroded ? lasting_among_deletions : lasting) * end;
  StepForecast forecast = forecast_steps(own, pilot.march, {share, fades}, end);
  if (!eroded) lean_towards(stays, doubt_in(own, pilot.march, share), own, forecast);
  double least = std::min(forecast.steps, stays.steps), most = std::max(forecast.steps, stays.steps);
  for (const Reading& reading : {Reading{1, fades}, Reading{share, HUGE_VAL},
                                 Reading{std::pow(pilot.factor, largest_exponent), fades}}) {
    const double steps = forecast_steps(own, pilot.march, reading, end).steps;
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
