#include "io/run/check_deck.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cmath>
#include <string>

#include "apps/commands.hpp"
#include "apps/streams.hpp"

namespace brio {

namespace {

void print_parts(const CheckReport& report) {
  constexpr const char* line = "{:<20} {:<10} {:<22} {:>10} {:>10} {:>12.5g}\n";
  write_out("{:<20} {:<10} {:<22} {:>10} {:>10} {:>12}\n", "part", "element", "material", "elements", "nodes",
            "mass");
  double mass = 0;
  for (const PartReport& part : report.parts) {
    write_out(line, part.name, part.element, part.material, part.elements, part.nodes, part.mass);
    mass += part.mass;
  }
  write_out(line, "all", "", "", "", report.nodes, mass);
}

void print_quality(const CheckReport& report) {
  write_out("\n{:<20} {:>10} {:>10} {:>10} {:>12} {:>10}\n", "element quality", "aspect", "warp", "Jacobian",
            "stable step", "degenerate");
  for (const PartReport& part : report.parts) {
    const MeshQuality& quality = part.quality;
    const std::string step = std::isfinite(quality.step) ? fmt::format("{:.4g}", quality.step) : "rigid";
    write_out("{:<20} {:>10.3g} {:>10.3g} {:>10.3g} {:>12} {:>10}\n", part.name, quality.aspect, quality.warp,
              quality.jacobian, step, quality.degenerate);
  }
  for (const std::string& notice : report.mesh_notices) write_out("mesh: {}\n", notice);
}

void print_joints(const CheckReport& report) {
  for (const MergedParts& merged : report.merged)
    write_out("merged: {} nodes of '{}' are equivalenced with nodes of '{}', at distances up to {:.3g}\n",
              merged.nodes, merged.second, merged.first, merged.farthest);
  for (const TiedParts& tied : report.tied)
    write_out("tied: {} nodes of '{}' to the surface of '{}', at distances up to {:.3g}\n", tied.count,
              tied.nodes, tied.surface, tied.largest_gap);
  if (report.step_share_of_ties < 1)
    write_out(
        "tied: nodes at a distance from their faces reduce the stable time step to {:.3g} of that of the "
        "elements\n",
        report.step_share_of_ties);
}

void print_springs(const CheckReport& report) {
  for (const SpringSet& set : report.springs)
    write_out("springs: '{}' are {} pairs of nodes, {:.3g} to {:.3g} apart\n", set.name, set.count,
              set.shortest, set.longest);
}

void print_step(const CheckReport& report) {
  if (std::isfinite(report.stable_step)) {
    const std::string critical =
        report.critical_spring.empty()
            ? fmt::format("element {} of part '{}'", report.critical_element, report.critical_part)
            : fmt::format("spring '{}'", report.critical_spring);
    write_out("\nstable time step {:.4g}, set by {}; first time step {:.4g}\n", report.stable_step, critical,
              report.first_step);
  } else {
    write_out("\nall parts are rigid; time step {:.4g}\n", report.first_step);
  }
}

std::string memory(std::size_t bytes) {
  const auto size = static_cast<double>(bytes);
  return bytes < 100000 ? fmt::format("{:.1f} kB", size * 1e-3) : fmt::format("{:.1f} MB", size * 1e-6);
}

void print_built(const CheckReport& report) {
  write_out("\nswitched on: {}\n\n", fmt::join(report.active_features, " "));
  for (const BuiltFeature& feature : report.built) {
    write_out("  {}: because of {}", feature.name, feature.because);
    if (!feature.detail.empty()) write_out("; {}", feature.detail);
    if (feature.bytes > 0) write_out("; {}", memory(feature.bytes));
    write_out("\n");
  }
  if (!report.not_built.empty()) write_out("  not built: {}\n", fmt::join(report.not_built, ", "));
}

std::string rounded_duration(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.2g} s", seconds);
  if (seconds < 600) return fmt::format("{:.0f} s", seconds);
  if (seconds < 36000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

void print_steps(const Forecast& forecast) {
  const StepForecast& steps = forecast.steps;
  if (steps.exact) {
    write_out("  steps      {:.0f}, all of them timed\n", steps.steps);
  } else if (forecast.coarse_run_factors.empty()) {
    write_out(
        "  steps      {:.0f} if the stable time step is constant; it decreases in a scene that is crushed\n",
        steps.steps);
  } else {
    write_out(
        "  steps      {:.0f}, between {:.0f} and {:.0f}, from a coarse run with elements {:g} times "
        "as long\n",
        steps.steps, steps.least, steps.most, forecast.coarse_run_factors.back());
  }
  if (!forecast.coarse_run_fault.empty())
    write_out("             coarse runs: {}\n", forecast.coarse_run_fault);
}

void print_results(const Forecast& forecast) {
  const OutputCost& output = forecast.output;
  if (!forecast.output_fault.empty()) {
    write_out("  results    not measured: {}\n", forecast.output_fault);
    return;
  }
  write_out("  results    {:.1f} MB: {:.0f} dumps of {:.2f} MB", forecast.result_bytes * 1e-6, output.dumps,
            output.dump_bytes * 1e-6);
  if (forecast.new_topologies > 0)
    write_out(", {:.0f} of them with {:.2f} MB more after deletions", forecast.new_topologies,
              output.topology_bytes * 1e-6);
  write_out(", {:.0f} rows of history\n", output.rows);
}

void print_forecast(const Forecast& forecast, int threads) {
  const TimedRun& run = forecast.timed_run;
  if (run.steps.empty()) return;
  write_out("\nforecast for {} thread{}, from {} steps to time {:.4g}, timed in {:.2f} s:\n", threads,
            threads == 1 ? "" : "s", run.steps.size(), run.time, run.wall_seconds);
  if (!run.breakdown.empty()) write_out("  breakdown  {}\n", run.breakdown);
  print_steps(forecast);
  write_out("  wall time  {}: {} to build, {} for steps, {} for output", rounded_duration(forecast.seconds()),
            rounded_duration(forecast.build_seconds), rounded_duration(forecast.steps.seconds),
            rounded_duration(forecast.output.seconds()));
  if (run.waiting() > 1.1)
    write_out("; at the present load of the machine {}",
              rounded_duration(forecast.seconds() * run.waiting()));
  write_out("\n  memory     {:.1f} MB at its peak\n", forecast.peak_memory_mb);
  print_results(forecast);
  if (!forecast.steps.exact)
    write_out("  assumed    {}\n", forecast.coarse_run_factors.empty()
                                       ? "time step, contact and cost of a step stay as they were timed"
                                       : "cost of a step changes with that of the coarse run");
}

// What a terminal shows during coarse runs.
void tell_wait(const ForecastOptions& options) {
  if (!(options.coarse_run_s > 0 && options.coarse_run_fraction > 0) || isatty(STDERR_FILENO) == 0) return;
  std::string limits;
  if (options.coarse_run_s < HUGE_VAL) limits = rounded_duration(options.coarse_run_s);
  if (options.coarse_run_fraction < HUGE_VAL)
    limits +=
        fmt::format("{}{:g} % of the run", limits.empty() ? "" : " or ", 100 * options.coarse_run_fraction);
  write_error("coarse runs to predict the time step, at most {} (--coarse-run=0: none)\n", limits);
}

}  // namespace

std::string overlaps_text(std::span<const InitialOverlap> overlaps) {
  std::string text;
  const InitialOverlap* first = nullptr;  // that only touches
  double gap = 0, moved = 0;
  for (const InitialOverlap& overlap : overlaps) {
    if (overlap.is_overlap()) {
      text += fmt::format(
          "initial overlap: {} nodes of '{}' lay in '{}', the deepest by {:.3g}; nodes were moved by up to "
          "{:.3g}\n",
          overlap.nodes, overlap.node_part, overlap.face_part, overlap.depth, overlap.moved);
      continue;
    }
    if (first == nullptr) first = &overlap;
    gap = std::max(gap, overlap.gap);
    moved = std::max(moved, overlap.moved);
  }
  if (first == nullptr) return text;
  return text + fmt::format(
                    "contact gap: parts touched, '{}' and '{}' among them; nodes were moved by up to {:.3g} "
                    "to make a gap of {:.3g}\n",
                    first->node_part, first->face_part, moved, gap);
}

void check(const ForecastOptions& options, bool json) {
  if (json) {
    write_out("{}", check_json(check_deck(options)));
    return;
  }
  const CheckReport report = check_deck(options, [&options](const CheckReport& scene) {
    if (!scene.title.empty()) write_out("{}\n\n", scene.title);
    print_parts(scene);
    print_quality(scene);
    print_joints(scene);
    print_springs(scene);
    print_step(scene);
    write_out_text(overlaps_text(scene.initial_overlaps));
    for (const SceneWarning& warning : scene.warnings)
      write_out("warning: {}: {}; {}\n", warning.subject, warning.what, warning.advice);
    flush_output();
    tell_wait(options);
  });
  print_built(report);
  print_forecast(report.forecast, report.threads);
}

}  // namespace brio
