#include "io/forecast_deck.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "io/deck_error.hpp"
#include "io/file_error.hpp"
#include "io/run_deck.hpp"
#include "src/advance.hpp"
#include "src/coarser.hpp"
#include "src/output_schedule.hpp"

namespace brio {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

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
double new_topologies(const ScenePrepared& scene, const Forecast& forecast, std::span<const March> pilots) {
  if (!scene.model.erosion) return 0;
  if (forecast.march.reached_end) return dumps_with_deletion(forecast.march, scene.deck);
  if (!pilots.empty()) return dumps_with_deletion(pilots.back(), scene.deck);
  return std::max(0.0, forecast.output.dumps - 1);
}

// From the coarsest on, as long as the budget lasts: each takes several times as long as the one before.
std::vector<March> march_pilots(const ForecastOptions& options, const Deck& deck, Forecast& forecast) {
  std::vector<March> pilots;
  const auto start = Clock::now();
  ThreadTeam team(options.threads);
  for (const double factor : {4.0, 3.0, 2.0, 1.5}) {
    const double left = 0.5 * options.pilot_s - seconds_since(start);
    if (left <= 0) break;
    const Deck coarse = coarser(deck, factor);
    try {
      Model model = build_scene(coarse);
      update_velocities(model, HUGE_VAL, team);
      March pilot;
      march(pilot, model, HUGE_VAL, left, team);
      if (!pilot.breakdown.empty()) forecast.pilot_fault = pilot.breakdown;
      if (!pilot.reached_end) continue;
      forecast.pilot_factors.push_back(factor);
      pilots.push_back(std::move(pilot));
    } catch (const DeckError& fault) {
      forecast.pilot_fault = fault.what();
    } catch (const Breakdown& fault) {
      forecast.pilot_fault = fault.what();
    }
  }
  if (pilots.empty() && forecast.pilot_fault.empty())
    forecast.pilot_fault = "no pilot came to its end in " + std::to_string(0.5 * options.pilot_s) + " s";
  return pilots;
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
  {
    ThreadTeam team(options.threads);
    const double budget = options.march_s + (scene.deck.time.step ? 0 : 0.5 * options.pilot_s);
    march(forecast.march, scene.model, scene.deck.numerics.energy_error_limit, budget, team);
  }
  if (forecast.march.steps.empty()) return forecast;
  forecast.steps = forecast_steps(forecast.march, {}, forecast.end);
  try {
    forecast.output = measure_output(scene.deck, scene.model, forecast.steps.steps);
  } catch (const FileError& fault) {
    forecast.output_fault = fault.what();
  }
  forecast.peak_memory_mb = scene.memory.peak_mb();
  std::vector<March> pilots;
  if (options.pilot_s > 0 && !forecast.march.reached_end && !scene.deck.time.step) {
    pilots = march_pilots(options, scene.deck, forecast);
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
