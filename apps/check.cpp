#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "io/run_deck.hpp"
#include "src/advance.hpp"
#include "src/observe.hpp"

namespace brio {

namespace {

void print_parts(const Deck& deck, const Model& model) {
  fmt::print("{:<20} {:<10} {:<22} {:>10} {:>10} {:>12}\n", "part", "element", "material", "elements",
             "nodes", "mass");
  double mass = 0;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const PartInModel& part = model.parts[p];
    const Block& block = model.blocks[part.block];
    fmt::print("{:<20} {:<10} {:<22} {:>10} {:>10} {:>12.5g}\n", part.name, name_of(block.element),
               deck.parts[p].material, part.element_slot.size(), part.node.size(), part.mass);
    mass += part.mass;
  }
  fmt::print("{:<20} {:<10} {:<22} {:>10} {:>10} {:>12.5g}\n", "all", "", "", "", model.nodes.size(), mass);
}

std::size_t state_bytes(const Model& model) {
  std::size_t bytes = model.nodes.size() * (sizeof(NodeRecord) + sizeof(NodeVector) + sizeof(double));
  bytes += (model.nodes.velocity_before.size() + model.nodes.angular_velocity_before.size() +
            model.nodes.moment.size() + model.nodes.angular_velocity.size()) *
           sizeof(NodeVector);
  for (const Block& block : model.blocks)
    bytes += block.state.size() + (block.connectivity.size() + block.lost.size()) * sizeof(int) +
             block.held.size() * sizeof(double);
  return bytes;
}

std::string duration(double seconds) {
  if (seconds < 600) return fmt::format("{:.2g} s", seconds);
  if (seconds < 36000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

void print_steps(const Forecast& forecast) {
  const StepForecast& steps = forecast.steps;
  if (steps.exact) {
    fmt::print("  steps      {:.0f}, all of them marched\n", steps.steps);
  } else if (forecast.pilot_factors.empty()) {
    fmt::print(
        "  steps      {:.0f} if the step stays as it is; a scene that is crushed takes more: --pilot tells\n",
        steps.steps);
  } else {
    fmt::print(
        "  steps      {:.0f}, between {:.0f} and {:.0f}, as told by a pilot with elements {:g} times as "
        "long\n",
        steps.steps, steps.least, steps.most, forecast.pilot_factors.back());
  }
  if (!forecast.pilot_fault.empty()) fmt::print("             of the pilots: {}\n", forecast.pilot_fault);
}

void print_forecast(const Forecast& forecast, int threads) {
  const March& march = forecast.march;
  fmt::print("\nforecast for {} thread{}, from {} steps to time {:.4g}, marched in {:.2f} s:\n", threads,
             threads == 1 ? "" : "s", march.steps.size(), march.time, march.wall_seconds);
  if (!march.breakdown.empty()) fmt::print("  breakdown  {}\n", march.breakdown);
  print_steps(forecast);
  fmt::print("  wall time  {}: {} to build, {} for steps, {} for output", duration(forecast.seconds()),
             duration(forecast.build_seconds), duration(forecast.steps.seconds),
             duration(forecast.output.seconds()));
  if (march.waiting() > 1.1)
    fmt::print("; with the machine as busy as now {}", duration(forecast.seconds() * march.waiting()));
  fmt::print("\n  memory     {:.1f} MB at its peak\n", forecast.peak_memory_mb);
  if (!forecast.output_fault.empty()) {
    fmt::print("  results    not measured: {}\n", forecast.output_fault);
    return;
  }
  fmt::print("  results    {:.1f} MB: {:.0f} dumps of {:.2f} MB, {:.0f} rows of history\n",
             forecast.result_bytes * 1e-6, forecast.output.dumps, forecast.output.dump_bytes * 1e-6,
             forecast.output.rows);
}

}  // namespace

void print_overlaps(std::span<const InitialOverlap> overlaps) {
  for (const InitialOverlap& overlap : overlaps)
    fmt::print(
        "initial overlap: {} nodes of '{}' lay in '{}', the deepest by {:.3g}; nodes were moved by up to "
        "{:.3g}\n",
        overlap.nodes, overlap.node_part, overlap.face_part, overlap.depth, overlap.moved);
}

void check(const ForecastOptions& options) {
  ScenePrepared scene = prepare_scene(options);
  const Deck& deck = scene.deck;
  const Model& model = scene.model;

  if (!deck.title.empty()) fmt::print("{}\n\n", deck.title);
  print_parts(deck, model);
  for (const MergedParts& merged : model.merged)
    fmt::print("merged: {} nodes of '{}' are nodes of '{}', from up to {:.3g} away\n", merged.nodes,
               merged.second, merged.first, merged.farthest);
  for (const TiedParts& tied : model.ties.found)
    fmt::print("tied: {} nodes of '{}' to the surface of '{}', from up to {:.3g} away\n", tied.count,
               tied.nodes, tied.surface, tied.largest_gap);
  if (model.ties.step_share < 1)
    fmt::print(
        "tied: nodes away from their faces take the stable step down to {:.3g} of that of the elements\n",
        model.ties.step_share);
  const StepControl& control = model.control;
  if (std::isfinite(control.stable)) {
    const PartInModel& critical = model.parts[control.critical_block];
    fmt::print("\nstable step {:.4g}, set by element {} of part '{}'; first step {:.4g}\n", control.stable,
               control.critical_element, critical.name, model.times.next);
  } else {
    fmt::print("\nall parts are rigid; step {:.4g}\n", model.times.next);
  }
  fmt::print("about {:.0f} steps to time {:g} at that step\n", deck.time.end / model.times.next,
             deck.time.end);
  fmt::print("memory of nodes and elements {:.1f} MB\n", static_cast<double>(state_bytes(model)) * 1e-6);
  fmt::print("switched on:");
  for (const std::string& feature : active_features(model)) fmt::print(" {}", feature);
  fmt::print("\n");
  print_overlaps(model.initial_overlaps);
  print_forecast(forecast(options, scene), options.threads);
}

}  // namespace brio
