#include "io/run/forecast_deck.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/files/file_error.hpp"
#include "io/run/initial_state.hpp"
#include "io/run/run_deck.hpp"
#include "io/yaml/deck_error.hpp"
#include "src/forecast/coarser.hpp"
#include "src/output/output_schedule.hpp"
#include "src/step/advance.hpp"

namespace brio {

namespace {

// Dumps before which elements were deleted since the dump before.
double dumps_with_deletion(const TimedRun& run, const Deck& deck) {
  OutputSchedule schedule = field_schedule(deck);
  schedule.due(0);
  std::int64_t deleted = 0;
  double count = 0;
  for (const TimedStep& step : run.steps) {
    if (!schedule.due(step.time + step.size) && &step != &run.steps.back()) continue;
    if (step.deleted != deleted) ++count;
    deleted = step.deleted;
  }
  return count;
}

// From a run that reached the end time; if none did, an upper bound: every dump.
double new_topologies(const ScenePrepared& scene, const Forecast& forecast,
                      const std::optional<CoarseRun>& coarse) {
  if (!scene.model.erosion) return 0;
  if (forecast.timed_run.reached_end) return dumps_with_deletion(forecast.timed_run, scene.deck);
  if (coarse) return dumps_with_deletion(coarse->run, scene.deck);
  return std::max(0.0, forecast.output.dumps - 1);
}

// A scene with longer elements. Nothing where no part can be coarser, as with one element across.
std::optional<Model> coarse_scene(const ScenePrepared& scene, double factor, Forecast& forecast) {
  try {
    Model model = build_scene(coarser(scene.deck, factor));
    if (model.nodes.size() < scene.model.nodes.size()) return model;
  } catch (const DeckError& fault) {
    forecast.coarse_run_fault = fault.what();
  }
  return {};
}

// Nothing where it does not reach the end time within the budget.
std::optional<TimedRun> run_to_end(Model& model, int threads, double budget_s, Forecast& forecast) {
  try {
    ThreadTeam team(threads);
    update_velocities(model, HUGE_VAL, team);
    TimedRun timed;
    continue_run(timed, model, HUGE_VAL, budget_s, team);
    if (timed.reached_end) return timed;
    forecast.coarse_run_fault = timed.breakdown;
  } catch (const Breakdown& fault) {
    forecast.coarse_run_fault = fault.what();
  }
  return {};
}

void time_steps(const ForecastOptions& options, ScenePrepared& scene, double budget_s, TimedRun& run) {
  ThreadTeam team(options.threads);
  continue_run(run, scene.model, scene.deck.numerics.energy_error_limit, budget_s, team);
}

// Coarse runs and further timed steps, and the forecast from both.
class Exploration {
 public:
  Exploration(const ForecastOptions& options, ScenePrepared& scene, Forecast& forecast)
      : options_(options), scene_(scene), forecast_(forecast), start_(work_clock(options.threads)) {}

  // Coarse runs, each finer than the one before. The first may take the whole budget; further ones are made
  // where they are expected to finish in half of the remaining budget. The timed run is continued between
  // them: the predicted wall time, of which the budget is a fraction, is better known before an expensive
  // coarse run.
  void make_coarse_runs() {
    constexpr double timed_between = 1.0 / 3, fraction_of_finer = 0.5;
    constexpr double cost_exponent = 4;  // elements of surfaces and solids, steps, and their decrease
    double last_factor = 0, last_cost = 0;
    for (const double factor : {4.0, 2.0, 1.5}) {
      if (coarse) time_scene(timed_between);
      const double begin = spent();
      const double left = (coarse ? fraction_of_finer : 1) * (budget() - begin);
      if (left <= 0 || forecast_.timed_run.is_over()) break;
      if (coarse && last_cost * std::pow(last_factor / factor, cost_exponent) > left) break;
      std::optional<Model> model = coarse_scene(scene_, factor, forecast_);
      if (!model) continue;
      std::optional<TimedRun> run = run_to_end(*model, options_.threads, left, forecast_);
      if (!run) continue;
      coarse = CoarseRun{factor, std::move(*run)};
      forecast_.coarse_run_factors.push_back(factor);
      forecast_.steps = forecast_steps(forecast_.timed_run, *coarse, forecast_.end);
      last_factor = factor;
      last_cost = spent() - begin;
    }
    if (!coarse && forecast_.coarse_run_fault.empty())
      forecast_.coarse_run_fault = "no coarser mesh, or its run did not reach the end time within the budget";
  }

  // For a fraction of the remaining budget.
  void time_scene(double fraction) {
    const double left = fraction * (budget() - spent());
    if (left <= 0 || forecast_.timed_run.is_over()) return;
    time_steps(options_, scene_, left, forecast_.timed_run);
    forecast_.steps = coarse ? forecast_steps(forecast_.timed_run, *coarse, forecast_.end)
                             : forecast_steps(forecast_.timed_run, forecast_.end);
  }

  std::optional<CoarseRun> coarse;  // the finest

 private:
  double spent() const { return work_clock(options_.threads) - start_; }
  double budget() const {
    return std::min(options_.coarse_run_s, options_.coarse_run_fraction * forecast_.steps.seconds);
  }

  const ForecastOptions& options_;
  ScenePrepared& scene_;
  Forecast& forecast_;
  double start_;
};

/// Of which no coarser mesh can be made.
bool has_mesh_file(const Deck& deck) {
  return std::any_of(deck.parts.begin(), deck.parts.end(), [](const Part& part) {
    return std::holds_alternative<MeshFromFile>(part.mesh) && !std::holds_alternative<Rigid>(part.element);
  });
}

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
  time_steps(options, scene, options.timed_run_s, forecast.timed_run);
  if (forecast.timed_run.steps.empty()) return forecast;
  forecast.steps = forecast_steps(forecast.timed_run, forecast.end);
  try {
    forecast.output = measure_output(scene.deck, scene.model, forecast.steps.steps);
  } catch (const FileError& fault) {
    forecast.output_fault = fault.what();
  }
  forecast.peak_memory_mb = scene.memory.peak_mb();
  Exploration exploration(options, scene, forecast);
  const bool is_asked_for =
      options.coarse_run_s > 0 && options.coarse_run_fraction > 0 && !forecast.timed_run.reached_end;
  if (is_asked_for && (scene.deck.time.step || scene.deck.time.mass_scaling)) {
    forecast.coarse_run_fault = "none is made where the deck prescribes the time step";
  } else if (is_asked_for && has_initial_state(scene.deck)) {
    forecast.coarse_run_fault =
        "none is made of states from earlier results; time steps are timed for longer";
    exploration.time_scene(1);
  } else if (is_asked_for && has_mesh_file(scene.deck)) {
    forecast.coarse_run_fault = "none is made of meshes from files; time steps are timed for longer";
    exploration.time_scene(1);
  } else if (is_asked_for && forecast.timed_run.breakdown.empty()) {
    exploration.make_coarse_runs();
    exploration.time_scene(0.5);  // changes the predicted wall time and by that the budget
    exploration.time_scene(1);
  }
  forecast.new_topologies = new_topologies(scene, forecast, exploration.coarse);
  forecast.result_bytes = forecast.output.bytes(forecast.new_topologies);
  return forecast;
}

Forecast forecast_deck(const ForecastOptions& options) {
  ScenePrepared scene = prepare_scene(options);
  return forecast(options, scene);
}

}  // namespace brio
