#pragma once
/// What a deck is, what it asks for, what is likely to be wrong with it, and what a run of it would take.

#include <functional>
#include <string>
#include <vector>

#include "io/run/forecast_deck.hpp"
#include "src/forecast/built_features.hpp"
#include "src/forecast/mesh_quality.hpp"
#include "src/forecast/warnings.hpp"

namespace brio {

struct PartReport {
  std::string name, element, material;
  std::size_t elements = 0, nodes = 0;
  double mass = 0;
  MeshQuality quality;
};

struct CheckReport {
  std::string title;
  std::vector<PartReport> parts;
  std::vector<std::string> mesh_notices;  ///< what was left out of mesh files
  std::size_t nodes = 0;
  std::vector<MergedParts> merged;
  std::vector<TiedParts> tied;
  double step_share_of_ties = 1;
  std::vector<InitialOverlap> initial_overlaps;
  std::vector<SpringSet> springs;  ///< those between sets
  double end = 0;
  double stable_step = 0;  ///< not finite: all parts are rigid, and no spring bounds it
  double first_step = 0;
  std::string critical_part;
  std::size_t critical_element = 0;
  std::string critical_spring;  ///< that sets the time step instead; empty: none
  std::vector<std::string> active_features;
  std::vector<BuiltFeature> built;
  std::vector<std::string> not_built;
  std::vector<SceneWarning> warnings;
  int threads = 1;
  Forecast forecast;
};

/// \param look is shown the report before the forecast, which takes time; forecast and `built` are still
/// missing. \throws DeckError, and Breakdown where the first step cannot be made
CheckReport check_deck(
    const ForecastOptions& given,
    const std::function<void(const CheckReport&)>& look = [](const CheckReport&) {});

/// Keys in full words; a number that is not finite becomes null.
std::string check_json(const CheckReport& report);

}  // namespace brio
