#pragma once
/// Forecast of steps, wall time, memory and results of a run, from a timed run and coarse runs in memory.

#include <filesystem>
#include <string>
#include <vector>

#include "io/results/output_cost.hpp"
#include "src/forecast/forecast.hpp"
#include "src/forecast/memory.hpp"

namespace brio {

struct ForecastOptions {
  std::filesystem::path deck;
  std::vector<std::string> overrides;  ///< KEY.PATH=VALUE
  int threads = 1;
  bool threads_by_size = false;    ///< as of RunOptions
  double timed_run_s = 1;          ///< budget of the first timed run, by the work_clock
  double coarse_run_s = 0;         ///< budget of coarse runs and further timed steps; 0: none
  double coarse_run_fraction = 1;  ///< the same as a fraction of the predicted run
};

struct Forecast {
  double end = 0;
  double first_step = 0;
  TimedRun timed_run;
  StepForecast steps;
  std::vector<double> coarse_run_factors;  ///< of the coarse runs that reached the end time; the last is used
  std::string coarse_run_fault;            ///< why there is none, if one was asked for
  double build_seconds = 0;
  OutputCost output;
  std::string output_fault;   ///< why output could not be measured
  double new_topologies = 0;  ///< dumps after the first that bring one, because elements were deleted
  double result_bytes = 0;
  double peak_memory_mb = 0;  ///< as `run` reports it

  /// Wall time of the run on a machine that has nothing else to do.
  double seconds() const { return build_seconds + steps.seconds + output.seconds(); }
};

/// A scene that is built and whose first step is known.
struct ScenePrepared {
  MemoryWatch memory;  ///< first: it watches the rest
  Deck deck;
  Model model;
  double seconds = 0;  ///< of the processor, to build it
};

/// \throws DeckError, and Breakdown where the first step cannot be made
ScenePrepared prepare_scene(const ForecastOptions& options);

/// Advances the scene.
Forecast forecast(const ForecastOptions& options, ScenePrepared& scene);

/// Both. \throws DeckError, and Breakdown where the first step cannot be made
Forecast forecast_deck(const ForecastOptions& options);

}  // namespace brio
