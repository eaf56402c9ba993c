#pragma once
/// What a run would take, told from its first steps: made in memory, with a model of its own.

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
  double march_s = 1;      ///< of the work_clock, for steps of the scene itself
  double pilot_s = 0;      ///< most of it for pilots and for more steps; 0: none
  double pilot_share = 1;  ///< of the run foretold, most of it for the same
};

struct Forecast {
  double end = 0;
  double first_step = 0;
  March march;
  StepForecast steps;
  std::vector<double>
      pilot_factors;        ///< of the pilots that came to their ends: how much coarser; the last is read
  std::string pilot_fault;  ///< why there is none, if one was asked for
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

/// Marches the scene.
Forecast forecast(const ForecastOptions& options, ScenePrepared& scene);

/// Both. \throws DeckError, and Breakdown where the first step cannot be made
Forecast forecast_deck(const ForecastOptions& options);

}  // namespace brio
