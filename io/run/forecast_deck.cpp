#include "io/run/forecast_deck.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/deck/deck_error.hpp"
#include "io/files/file_error.hpp"
#include "io/run/run_deck.hpp"
#include "src/forecast/coarser.hpp"
#include "src/output/output_schedule.hpp"
#include "src/step/advance.hpp"

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
double new_topologies(const ScenePrepared& scene, const Forecast& forecast,
                      const std::optional<Pilot>& pilot) {
  if (!scene.model.erosion) return 0;
  if (forecast.march.reached_end) return dumps_with_deletion(forecast.march, scene.deck);
  if (pilot) return dumps_with_deletion(pilot->march, scene.deck);
  return std::max(0.0, forecast.output.dumps - 1);
}

// A scene with longer elements. Nothing where there are none, as of parts that have but one across.
std::optional<Model> coarse_scene(const ScenePrepared& scene, double factor, Forecast& forecast) {
  try {
    Model model = build_scene(coarser(scene.deck, factor));
    if (model.nodes.size() < scene.model.nodes.size()) return model;
  } catch (const DeckError& fault) {
    forecast.pilot_fault = fault.what();
  }
  return {};
}

// Nothing where it does not get to its end in time.
std::optional<March> march_to_end(Model& model, int threads, double budget_s, Forecast& forecast) {
  try {
    ThreadTeam team(threads);
    update_velocities(model, HUGE_VAL, team);
    March pilot;
    march(pilot, model, HUGE_VAL, budget_s, team);
    if (pilot.reached_end) return pilot;
    forecast.pilot_fault = pilot.breakdown;
  } catch (const Breakdown& fault) {
    forecast.pilot_fault = fault.what();
  }
  return {};
}

void march_on(const ForecastOptions& options, ScenePrepared& scene, double budget_s, March& march) {
  ThreadTeam team(options.threads);
  brio::march(march, scene.model, scene.deck.numerics.energy_error_limit, budget_s, team);
}

// Pilots and more steps, and what follows from them.
class Exploration {
 public:
  Exploration(const ForecastOptions& options, ScenePrepared& scene, Forecast& forecast)
      : options_(options), scene_(scene), forecast_(forecast), start_(work_clock(options.threads)) {}

  // Pilots that are ever finer. The first may take all of the budget, without it nothing is known; the next
  // ones are made where they may be expected to come to their end in half of what is left. The scene is
  // marched between them: what the budget is a share of is known better before a pilot that costs much.
  void march_pilots() {
    constexpr double marched_between = 1.0 / 3, share_of_finer = 0.5;
    constexpr double cost_exponent = 4;  // elements of surfaces and solids, steps, and the fall of these
    double last_factor = 0, last_cost = 0;
    for (const double factor : {4.0, 2.0, 1.5}) {
      if (pilot) march_scene(marched_between);
      const double begin = spent();
      const double left = (pilot ? share_of_finer : 1) * (budget() - begin);
      if (left <= 0 || forecast_.march.is_over()) break;
      if (pilot && last_cost * std::pow(last_factor / factor, cost_exponent) > left) break;
      std::optional<Model> model = coarse_scene(scene_, factor, forecast_);
      if (!model) continue;
      std::optional<March> march = march_to_end(*model, options_.threads, left, forecast_);
      if (!march) continue;
      pilot = Pilot{factor, std::move(*march)};
      forecast_.pilot_factors.push_back(factor);
      forecast_.steps = forecast_steps(forecast_.march, *pilot, forecast_.end);
      last_factor = factor;
      last_cost = spent() - begin;
    }
    if (!pilot && forecast_.pilot_fault.empty())
      forecast_.pilot_fault = "none is coarser and came to its end in time";
  }

  // For a part of what is left of the budget.
  void march_scene(double part) {
    const double left = part * (budget() - spent());
    if (left <= 0 || forecast_.march.is_over()) return;
    march_on(options_, scene_, left, forecast_.march);
    forecast_.steps = pilot ? forecast_steps(forecast_.march, *pilot, forecast_.end)
                            : forecast_steps(forecast_.march, forecast_.end);
  }

  std::optional<Pilot> pilot;  // the finest

 private:
  double spent() const { return work_clock(options_.threads) - start_; }
  double budget() const { return std::min(options_.pilot_s, options_.pilot_share * forecast_.steps.seconds); }

  const ForecastOptions& options_;
  ScenePrepared& scene_;
  Forecast& forecast_;
  double start_;
};

}  // namespace

ScenePrepared prepare_scene(const ForecastOptions& options) {
  ScenePrepared scene;
  const double start = work_clock(options.threads);
  scene.deck = load_deck(options.deck, options.overrides, options.threads, scene.model);
  scene.seconds = work_clock(options.threads) - start;
  ThreadTeam team(options.threads);
  make_first_step(scene.deck, scene.model, team);
  return scene;
}

Forecast forecast(const ForecastOptions& options, ScenePrepared& scene) {
  Forecast forecast;
  forecast.end = scene.deck.time.end;
  forecast.first_step = scene.model.times.next;
  forecast.build_seconds = scene.seconds;
  march_on(options, scene, options.march_s, forecast.march);
  if (forecast.march.steps.empty()) return forecast;
  forecast.steps = forecast_steps(forecast.march, forecast.end);
  try {
    forecast.output = measure_output(scene.deck, scene.model, forecast.steps.steps);
  } catch (const FileError& fault) {
    forecast.output_fault = fault.what();
  }
  forecast.peak_memory_mb = scene.memory.peak_mb();
  Exploration exploration(options, scene, forecast);
  const bool is_asked_for = options.pilot_s > 0 && options.pilot_share > 0 && !forecast.march.reached_end;
  if (is_asked_for && (scene.deck.time.step || scene.deck.time.mass_scaling)) {
    forecast.pilot_fault = "none is made where the deck gives the step";
  } else if (is_asked_for && forecast.march.breakdown.empty()) {
    exploration.march_pilots();
    exploration.march_scene(0.5);  // changes what the budget is a share of
    exploration.march_scene(1);
  }
  forecast.new_topologies = new_topologies(scene, forecast, exploration.pilot);
  forecast.result_bytes = forecast.output.bytes(forecast.new_topologies);
  return forecast;
}

Forecast forecast_deck(const ForecastOptions& options) {
  ScenePrepared scene = prepare_scene(options);
  return forecast(options, scene);
}

}  // namespace brio
