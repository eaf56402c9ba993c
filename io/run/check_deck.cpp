#include "io/run/check_deck.hpp"

#include "io/run/run_deck.hpp"
#include "src/base/index.hpp"
#include "src/output/observe.hpp"

namespace brio {

CheckReport check_deck(const ForecastOptions& given, const std::function<void(const CheckReport&)>& look) {
  ForecastOptions options = given;
  ScenePrepared scene = prepare_scene(options);
  options.threads = threads_of(scene.model, options.threads, options.threads_by_size);
  const Deck& deck = scene.deck;
  const Model& model = scene.model;
  CheckReport report;
  report.title = deck.title;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const PartInModel& part = model.parts[p];
    report.parts.push_back({.name = part.name,
                            .element = std::string(name_of(deck.parts[p].element)),
                            .material = deck.parts[p].material,
                            .elements = part.element_slot.size(),
                            .nodes = part.node.size(),
                            .mass = part.mass,
                            .quality = quality_of(model, p)});
  }
  report.mesh_notices = deck.mesh_notices;
  report.nodes = model.nodes.size();
  report.merged = model.merged;
  report.tied = model.ties.found;
  report.step_share_of_ties = model.ties.step_share;
  report.initial_overlaps = model.initial_overlaps;
  for (const SpringSet& set : model.springs.set)
    if (set.joins_sets) report.springs.push_back(set);
  report.end = deck.time.end;
  report.stable_step = model.control.stable;
  report.first_step = model.times.next;
  report.critical_part = model.parts[model.control.critical_block].name;
  report.critical_element =
      index(model.parts[model.control.critical_block].number_of_element(model.control.critical_element));
  if (const int spring = model.springs.critical; spring >= 0)
    report.critical_spring = model.springs.spring[index(spring)].name;
  report.active_features = active_features(model);
  report.not_built = features_not_built(model);
  report.warnings = scene_warnings(deck, model);
  report.threads = options.threads;
  look(report);
  report.forecast = forecast(options, scene);
  report.built = built_features(deck, std::move(scene.model));  // after the peak of memory was read
  return report;
}

}  // namespace brio
