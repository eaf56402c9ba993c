#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "apps/commands.hpp"
#include "apps/streams.hpp"

namespace brio {

namespace {

std::string duration(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{:.1f} s", seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

// One line that is written over on a terminal; a plain line every ten seconds elsewhere.
class ProgressLine {
 public:
  void operator()(const Progress& progress) {
    const bool finished = progress.time >= progress.end;
    if (!on_terminal_ && !finished && progress.elapsed_s - printed_ < 10) return;
    printed_ = progress.elapsed_s;
    std::string line = fmt::format(
        "time {:.4e}  step {}  dt {:.3e} ({} {})  {:5.1f} %  {}  left {}  energy error {:+.3f} %",
        progress.time, progress.step, progress.dt, progress.critical_part, progress.critical_element,
        100 * progress.time / progress.end, duration(progress.elapsed_s), duration(progress.remaining_s),
        100 * progress.energy_error);
    if (progress.deleted > 0) line += fmt::format("  deleted {}", progress.deleted);
    if (!progress.hourglassing.empty())
      line += fmt::format("  hourglass {:.0f} % of '{}'", std::min(100 * progress.hourglass_ratio, 999.0),
                          progress.hourglassing);
    if (on_terminal_) {
      write_error("\r{:<118}", line);
      if (finished) write_error("\n");
    } else {
      write_error("{}\n", line);
    }
  }

 private:
  bool on_terminal_ = isatty(STDERR_FILENO) != 0;
  double printed_ = -10;
};

void print_outcome(const RunOutcome& outcome) {
  print_overlaps(outcome.initial_overlaps);
  const Summary& summary = outcome.summary;
  write_out("{} at time {:.6g} after {} steps, {} ({:.3g} million element updates a second)\n",
            summary.status, summary.time, summary.steps, duration(summary.wall_s.total),
            summary.element_updates_per_s * 1e-6);
  const Summary::Energies& energy = summary.energy;
  write_out(
      "energy: kinetic {:.4g}, internal {:.4g}, hourglass {:.3g}, viscous {:.3g}, contact {:.3g}, friction "
      "{:.3g}; "
      "error {:+.3f} %\n",
      energy.kinetic, energy.internal, energy.hourglass, energy.viscous, energy.contact, energy.friction,
      100 * energy.error_relative);
  const std::int64_t deleted = summary.deleted.total();
  if (deleted > 0)
    write_out("deleted: {} elements, energy {:.4g}; free nodes: mass {:.4g} retained, {:.4g} removed\n",
              deleted, energy.deleted, summary.mass.debris, summary.mass.deleted);
  if (summary.mass_scaling)
    write_out("mass added to small elements: {:.4g}, {:.3g} % of the mass\n", summary.mass_scaling->added,
              100 * summary.mass_scaling->share);
  write_out("wall time by stage:");
  for (const auto& [stage, seconds] : summary.wall_s.by_stage)
    if (seconds > 0) write_out(" {} {:.2f} s", stage, seconds);
  write_out("\nresults: {} (ParaView 5.12 or later), {} (ParaView 5.11)\n", outcome.vtkhdf.string(),
            outcome.xdmf.string());
}

}  // namespace

int run(RunArguments& arguments) {
  arguments.options.stop = &noted_signal();
  arguments.options.built = note_signals;  // until then there is nothing to close
  ProgressLine line;
  if (!arguments.quiet) arguments.options.progress = [&](const Progress& progress) { line(progress); };
  arguments.options.moved_aside = [&](const std::filesystem::path& to, bool lost) {
    if (arguments.quiet && !lost) return;
    write_error("results of an earlier run were moved to {}{}\n", to.string(),
                lost ? ", in place of those that were there" : "");
  };
  arguments.options.notice = [](const std::string& text) { write_error("brio: {}\n", text); };
  const RunOutcome outcome = run_deck(arguments.options);
  if (!outcome.message.empty()) write_error("\nbrio: {}\n", outcome.message);
  for (const std::string& warning : outcome.summary.warnings) write_error("brio: warning: {}\n", warning);
  if (!arguments.quiet && !arguments.json) print_outcome(outcome);
  if (arguments.json) {
    std::ostringstream summary;
    summary << std::ifstream(outcome.summary_file).rdbuf();
    write_out_text(summary.str());
  }
  return outcome.summary.exit_code;
}

}  // namespace brio
