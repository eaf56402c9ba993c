#include "src/forecast/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace brio {

namespace {

// Exponent of the number of elements with which log r grows, see the header.
constexpr double usual_exponent = 0.4, largest_exponent = 1;
// Weight of the usual ratio in the fit: a mean square of log r over the whole time.
constexpr double weight_of_usual = 0.1;
// Decay time over the end time, without and with deletions.
constexpr double decay = 0.5, decay_with_deletions = 0.05;

// Without the last two steps of a finished run: they divide the remaining time and are below the bound.
std::span<const TimedStep> steps_at_the_bound(const TimedRun& run) {
  std::span<const TimedStep> steps = run.steps;
  return run.reached_end && steps.size() > 4 ? steps.first(steps.size() - 2) : steps;
}

// log of the first time step over that at a time.
double log_decrease(const TimedRun& run, double time) {
  const std::span<const TimedStep> steps = steps_at_the_bound(run);
  auto after = std::upper_bound(steps.begin(), steps.end(), time,
                                [](double t, const TimedStep& step) { return t < step.time; });
  if (after != steps.begin()) --after;
  return std::log(steps.front().size / after->size);
}

// Weight of a constant time step, 0 to 1: large where the coarse run missed the decrease of the timed run.
double weight_of_constant_step(const TimedRun& own, const TimedRun& coarse, double ratio) {
  constexpr double small_decrease = 0.1;
  const std::span<const TimedStep> steps = steps_at_the_bound(own);
  const double shown = ratio * log_decrease(coarse, own.time);
  const double missed = std::log(steps.front().size / steps.back().size) - shown;
  return missed * missed / (missed * missed + shown * shown + small_decrease * small_decrease);
}

// Geometric mean, with weights, of the numbers of steps of two forecasts; remaining steps cost what they did.
void average_with(const StepForecast& other, double weight, const TimedRun& own, StepForecast& forecast) {
  const auto timed = static_cast<double>(own.steps.size());
  const double steps = std::pow(forecast.steps, 1 - weight) * std::pow(other.steps, weight);
  const double change = (steps - timed) / (forecast.steps - timed);
  forecast.seconds = own.seconds() + change * (forecast.seconds - own.seconds());
  forecast.steps = steps;
}

// Time per step as a straight line in that of the coarse run at the same times, c + b (p - mean p). The slope
// is fitted between zero and proportionality, and is near the latter where the time of the coarse run hardly
// changes.
struct CostLine {
  double mean = 0, slope = 0;  ///< slope times mean of the coarse run over mean of the timed run: 0 to 1
  double coarse_mean = 1;
  double at(double coarse) const { return mean * (1 + slope * (coarse / coarse_mean - 1)); }
};

// Mean over intervals of about a fiftieth of the steps.
std::vector<double> smooth_cost(const TimedRun& run) {
  constexpr std::size_t intervals = 50;
  const std::size_t steps = run.steps.size(), length = steps / intervals + 1;
  std::vector<double> cost(steps);
  for (std::size_t begin = 0; begin < steps; begin += length) {
    const std::size_t count = std::min(length, steps - begin);
    double sum = 0;
    for (std::size_t i = begin; i < begin + count; ++i) sum += run.steps[i].seconds;
    std::fill_n(cost.begin() + static_cast<std::ptrdiff_t>(begin), count, sum / static_cast<double>(count));
  }
  return cost;
}

CostLine cost_line(const TimedRun& own, const TimedRun& coarse, const std::vector<double>& coarse_cost) {
  constexpr double weight_of_proportion = 0.05;  // as a variance of relative cost
  const std::vector<double> own_cost = smooth_cost(own);
  std::vector<double> at_same_time(own.steps.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < own.steps.size(); ++i) {
    while (next + 1 < coarse.steps.size() && coarse.steps[next + 1].time <= own.steps[i].time) ++next;
    at_same_time[i] = coarse_cost[next];
  }
  const auto count = static_cast<double>(own.steps.size());
  CostLine line;
  line.mean = std::accumulate(own_cost.begin(), own_cost.end(), 0.0) / count;
  line.coarse_mean = std::accumulate(at_same_time.begin(), at_same_time.end(), 0.0) / count;
  if (!(line.coarse_mean > 0)) return {line.mean, 0, 1};  // below the resolution of the clock
  double both = weight_of_proportion * count, square = both;
  for (std::size_t i = 0; i < own.steps.size(); ++i) {
    const double x = at_same_time[i] / line.coarse_mean - 1;
    both += x * (own_cost[i] / line.mean - 1);
    square += x * x;
  }
  line.slope = std::clamp(both / square, 0.0, 1.0);
  return line;
}

}  // namespace

StepForecast forecast_steps(const TimedRun& own, double end) {
  StepForecast forecast;
  const double left = own.reached_end ? 0 : std::ceil((end - own.time) / own.steps.back().size * (1 - 1e-12));
  forecast.steps = forecast.least = static_cast<double>(own.steps.size()) + left;
  forecast.exact = own.reached_end;
  if (own.reached_end) forecast.most = forecast.steps;
  forecast.seconds = own.seconds() + left * seconds_per_step(own, 0.5 * own.time);
  return forecast;
}

double decrease_ratio(const TimedRun& own, const TimedRun& coarse, double usual, double end) {
  double both = weight_of_usual * end * usual, square = weight_of_usual * end;
  for (const TimedStep& step : steps_at_the_bound(own)) {
    const double of_coarse_run = log_decrease(coarse, step.time);
    both += step.size * of_coarse_run * std::log(own.steps.front().size / step.size);
    square += step.size * of_coarse_run * of_coarse_run;
  }
  return std::max(both / square, 0.3);
}

StepForecast forecast_steps(const TimedRun& own, const TimedRun& coarse, Extrapolation extrapolation,
                            double end) {
  StepForecast forecast = forecast_steps(own, end);
  if (own.reached_end) return forecast;
  const double first = steps_at_the_bound(own).front().size;
  const double missed = std::log(first / steps_at_the_bound(own).back().size) -
                        extrapolation.ratio * log_decrease(coarse, own.time);
  const std::vector<double> coarse_cost = smooth_cost(coarse);
  const CostLine cost = cost_line(own, coarse, coarse_cost);
  forecast.decrease_ratio = extrapolation.ratio;
  forecast.steps = static_cast<double>(own.steps.size());
  forecast.seconds = own.seconds();
  for (std::size_t i = 0; i < coarse.steps.size(); ++i) {
    const TimedStep& step = coarse.steps[i];
    const double time = std::max(step.time, own.time);
    const double covered = std::min(step.time + step.size, end) - time;
    if (covered <= 0) continue;
    const double left = missed * std::exp((own.time - time) / extrapolation.decay_time);
    const double size = first * std::exp(-extrapolation.ratio * log_decrease(coarse, time) - left);
    forecast.steps += covered / size;
    forecast.seconds += covered / size * cost.at(coarse_cost[i]);
  }
  forecast.least = forecast.most = forecast.steps;
  return forecast;
}

StepForecast forecast_steps(const TimedRun& own, const CoarseRun& coarse, double end) {
  const StepForecast stays = forecast_steps(own, end);
  if (own.reached_end) return stays;
  const bool eroded = coarse.run.steps.back().deleted > 0;
  const double usual = std::pow(coarse.factor, usual_exponent);
  const double ratio = eroded ? usual : decrease_ratio(own, coarse.run, usual, end);
  const double decay_time = (eroded ? decay_with_deletions : decay) * end;
  StepForecast forecast = forecast_steps(own, coarse.run, {ratio, decay_time}, end);
  if (!eroded) average_with(stays, weight_of_constant_step(own, coarse.run, ratio), own, forecast);
  double least = std::min(forecast.steps, stays.steps), most = std::max(forecast.steps, stays.steps);
  for (const Extrapolation& extrapolation :
       {Extrapolation{1, decay_time}, Extrapolation{ratio, HUGE_VAL},
        Extrapolation{std::pow(coarse.factor, largest_exponent), decay_time}}) {
    const double steps = forecast_steps(own, coarse.run, extrapolation, end).steps;
    least = std::min(least, steps);
    most = std::max(most, steps);
  }
  // Extrapolations may agree and be wrong: remaining steps are predicted to a tenth at best.
  const auto timed = static_cast<double>(own.steps.size());
  forecast.least = timed + 0.9 * (least - timed);
  forecast.most = timed + 1.1 * (most - timed);
  return forecast;
}

}  // namespace brio
