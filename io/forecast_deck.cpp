#include "io/forecast_deck.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>

#include "io/deck_error.hpp"
#include "io/file_error.hpp"
#include "io/run_deck.hpp"
#include "src/advance.hpp"
#include "src/coarser.hpp"
#include "src/output_schedule.hpp"

namespace brio {

namespace {

// Dumps before which elements were deleted since the dump before.
double dumps_with_deletion(const March& march, const Deck& deck) {
  OutputSchedule schedule = field_schedule(deck);
  schedule.due(0);
  std::int64_t deleted = 0;
  double count = 0;
  for (const MarchedStep& step : march.steps) {
    if (!schedule.due(step.time + step.size) && &step != &march.steps.back()) continue;
    if (step.deleted != deleted) ++count;
    deleted = step.deleted;
  }
  return count;
}

// What came to its end says; where nothing did, each dump may.
double new_topologies(const ScenePrepared& scene, const Forecast& forecast, std::span<const Pilot> pilots) {
  if (!scene.model.erosion) return 0;
  if (forecast.march.reached_end) return dumps_with_deletion(forecast.march, scene.deck);
  if (!pilots.empty()) return dumps_with_deletion(pilots.back().march, scene.deck);
  return std::max(0.0, forecast.output.dumps - 1);
}

// A scene with longer elements to its end. Nothing where it does not get there in time.
std::optional<March> pilot_of(const ForecastOptions& options, const Deck& deck, double factor,
                              double budget_s, Forecast& forecast) {
  try {
    ThreadTeam team(options.threads);
    Model model = build_scene(coarser(deck, factor));
    update_velocities(model, HUGE_VAL, team);
    March pilot;
    march(pilot, model, HUGE_VAL, budget_s, team);
    if (!pilot.breakdown.empty()) forecast.pilot_fault = pilot.breakdown;
    if (pilot.reached_end) return pilot;
  } catch (const DeckError& fault) {
    forecast.pilot_fault = fault.what();
  } catch (const Breakdown& fault) {
    forecast.pilot_fault = fault.what();
  }
  return {};
}

// A coarse pilot, and the finest that may be expected to come to its end in what is left of the time.
std::vector<Pilot> march_pilots(const ForecastOptions& options, const Deck& deck, double budget_s,
                                Forecast& forecast) {
  constexpr double cost_exponent = 3.5;  // elements of surfaces and solids, and steps
  std::vector<Pilot> pilots;
  const double start = work_clock(options.threads);
  double last_factor = 0, last_cost = 0;
  for (double factor : {4.0, 1.5, 2.0, 3.0}) {
    const double left = budget_s - (work_clock(options.threads) - start);
    if (left <= 0) break;
    const bool too_long = last_cost * std::pow(last_factor / factor, cost_exponent) > left;
    if (last_factor > 0 && (factor > last_factor || too_long)) continue;
    const double begin = work_clock(options.threads);
    std::optional<March> pilot = pilot_of(options, deck, factor, left, forecast);
    if (!pilot) continue;
    last_factor = factor;
    last_cost = work_clock(options.threads) - begin;
    forecast.pilot_factors.push_back(factor);
    pilots.push_back({factor, std::move(*pilot)});
  }
  if (pilots.empty() && forecast.pilot_fault.empty())
    forecast.pilot_fault = "none came to its end in " + std::to_string(std::lround(budget_s)) + " s";
  return pilots;
}

void march_on(const ForecastOptions& options, ScenePrepared& scene, double budget_s, March& march) {
  ThreadTeam team(options.threads);
  brio::march(march, scene.model, scene.deck.numerics.energy_error_limit, budget_s, team);
}

}  // namespace

ScenePrepared prepare_scene(const ForecastOptions& options) {
  ScenePrepared scene;
  const std::clock_t start = std::clock();
  scene.deck = load_deck(options.deck, options.overrides, scene.model);
  scene.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  ThreadTeam team(options.threads);
  update_velocities(scene.model, scene.deck.numerics.energy_error_limit, team);
  return scene;
}

Forecast forecast(const ForecastOptions& options, ScenePrepared& scene) {
  Forecast forecast;
  forecast.end = scene.deck.time.end;
  forecast.first_step = scene.model.times.next;
  forecast.build_seconds = scene.seconds;
  march_on(options, scene, options.march_s, forecast.march);
  if (forecast.march.steps.empty()) return forecast;
  forecast.steps = forecast_steps(forecast.march, {}, forecast.end);
  try {
    forecast.output = measure_output(scene.deck, scene.model, forecast.steps.steps);
  } catch (const FileError& fault) {
    forecast.output_fault = fault.what();
  }
  forecast.peak_memory_mb = scene.memory.peak_mb();
  std::vector<Pilot> pilots;
  const bool step_is_given = scene.deck.time.step || scene.deck.time.mass_scaling;
  if (options.pilot_s > 0 && step_is_given)
    forecast.pilot_fault = "none is made where the deck gives the step";
  if (options.pilot_s > 0 && !forecast.march.reached_end && !step_is_given) {
    const double start = work_clock(options.threads);
    pilots = march_pilots(options, scene.deck, 0.5 * options.pilot_s, forecast);
    march_on(options, scene, options.pilot_s - (work_clock(options.threads) - start), forecast.march);
    forecast.steps = forecast_steps(forecast.march, pilots, forecast.end);
  }
  forecast.new_topologies = new_topologies(scene, forecast, pilots);
  forecast.result_bytes = forecast.output.bytes(forecast.new_topologies);
  return forecast;
}

Forecast forecast_deck(const ForecastOptions& options) {
  ScenePrepared scene = prepare_scene(options);
  return forecast(options, scene);
}

}  // namespace brio
