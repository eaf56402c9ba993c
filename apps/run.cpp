#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "apps/commands.hpp"
#include "apps/ranks.hpp"
#include "apps/run_log.hpp"
#include "apps/streams.hpp"

namespace brio {

namespace {

std::string duration(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{:.1f} s", seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string progress_line(const Progress& progress) {
  std::string line = fmt::format(
      "time {:.4e}  step {}  dt {:.3e} ({})  {:5.1f} %  {}  left {}  energy error {:+.3f} %", progress.time,
      progress.step, progress.dt, progress.critical, 100 * progress.time / progress.end,
      duration(progress.elapsed_s), duration(progress.remaining_s), 100 * progress.energy_error);
  if (progress.deleted > 0) line += fmt::format("  deleted {}", progress.deleted);
  if (!progress.hourglassing.empty())
    line += fmt::format("  hourglass {:.0f} % of '{}'", std::min(100 * progress.hourglass_ratio, 999.0),
                        progress.hourglassing);
  return line;
}

// On a terminal one line that is written over; in the log, and elsewhere, a line every ten seconds.
class ProgressLine {
 public:
  ProgressLine(RunLog& log, bool quiet) : log_(log), quiet_(quiet) {}

  void operator()(const Progress& progress) {
    const bool finished = progress.time >= progress.end;
    const bool is_due = finished || progress.elapsed_s - noted_ >= 10;
    if (!is_due && (quiet_ || !on_terminal_)) return;
    const std::string line = progress_line(progress);
    if (is_due) {
      noted_ = progress.elapsed_s;
      log_.add(line + "\n");
    }
    if (quiet_) return;
    if (!on_terminal_) return write_error("{}\n", line);
    write_error("\r{:<118}", line);
    if (finished) write_error("\n");
  }

 private:
  RunLog& log_;
  bool quiet_;
  bool on_terminal_ = isatty(STDERR_FILENO) != 0;
  double noted_ = -10;
};

std::string outcome_text(const RunOutcome& outcome) {
  std::string text = overlaps_text(outcome.initial_overlaps);
  const Summary& summary = outcome.summary;
  text += fmt::format("{} at time {:.6g} after {} steps, {} ({:.3g} million element updates a second)\n",
                      summary.status, summary.time, summary.steps, duration(summary.wall_s.total),
                      summary.element_updates_per_s * 1e-6);
  const Summary::Energies& energy = summary.energy;
  text += fmt::format(
      "energy: kinetic {:.4g}, internal {:.4g}, hourglass {:.3g}, viscous {:.3g}, contact {:.3g}, friction "
      "{:.3g}; error {:+.3f} %\n",
      energy.kinetic, energy.internal, energy.hourglass, energy.viscous, energy.contact, energy.friction,
      100 * energy.error_relative);
  const std::int64_t deleted = summary.deleted.total();
  if (deleted > 0)
    text +=
        fmt::format("deleted: {} elements, energy {:.4g}; free nodes: mass {:.4g} retained, {:.4g} removed\n",
                    deleted, energy.deleted, summary.mass.debris, summary.mass.deleted);
  if (summary.mass_scaling)
    text += fmt::format("mass added to small elements: {:.4g}, {:.3g} % of the mass\n",
                        summary.mass_scaling->added, 100 * summary.mass_scaling->share);
  text += "wall time by stage:";
  for (const auto& [stage, seconds] : summary.wall_s.by_stage)
    if (seconds > 0) text += fmt::format(" {} {:.2f} s", stage, seconds);
  return text + fmt::format("\nresults: {} (ParaView 5.12 or later), {} (ParaView 5.11 or later, by parts)\n",
                            outcome.vtkhdf.string(), outcome.xdmf.string());
}

// Of the whole run.
std::string traffic_text(const Ranks& ranks, std::int64_t steps) {
  std::string text = fmt::format("sent by the first of {} ranks:", ranks.count());
  for (std::size_t kind = 0; kind < Ranks::kinds.size(); ++kind) {
    const Ranks::Traffic& sent = ranks.traffic(static_cast<Ranks::Kind>(kind));
    text += fmt::format(" {} {} bytes in {} exchanges", Ranks::kinds[kind], sent.bytes, sent.exchanges);
  }
  return text + fmt::format(", in {} steps; domains were dealt anew {} times\n", steps, ranks.moves());
}

/// To standard error and to the log.
void tell(RunLog& log, const std::string& text) {
  write_error_text(text);
  log.add(text);
}

RunOutcome run_with_log(RunOptions& options, RunLog& log, bool quiet) {
  ProgressLine line(log, quiet);
  options.progress = [&](const Progress& progress) { line(progress); };
  options.moved_aside = [&](const std::filesystem::path& to, bool lost) {
    if (quiet && !lost) return;
    tell(log, fmt::format("results of an earlier run were moved to {}{}\n", to.string(),
                          lost ? ", in place of those that were there" : ""));
  };
  options.notice = [&](const std::string& text) { tell(log, "brio: " + text + "\n"); };
  options.published = [&](const std::filesystem::path& path, bool goes_on) { log.open(path, goes_on); };
  try {
    return run_deck(options);
  } catch (const std::exception& fault) {
    log.add(std::string("brio: ") + fault.what() + "\n");
    throw;
  }
}

// The first of several processes writes and speaks for all.
void share_work(RunOptions& options) {
  options.ranks = join_ranks();
  if (options.ranks == nullptr) return;
  mute(options.ranks->number() > 0);
  if (options.threads_by_size) options.threads = std::min(options.threads, processors_of_rank());
}

}  // namespace

int run(RunArguments& arguments) {
  share_work(arguments.options);
  arguments.options.stop = &noted_signal();
  arguments.options.built = note_signals;  // until then there is nothing to close
  const char* bound = arguments.options.threads_by_size ? "at most " : "";
  std::string threads = fmt::format("{}{}", bound, arguments.options.threads);
  if (arguments.options.ranks != nullptr)
    threads += fmt::format(", ranks {}", arguments.options.ranks->count());
  RunLog log(arguments.command, threads);
  const RunOutcome outcome = run_with_log(arguments.options, log, arguments.quiet);
  if (!outcome.message.empty()) tell(log, "\nbrio: " + outcome.message + "\n");
  for (const std::string& warning : outcome.summary.warnings) tell(log, "brio: warning: " + warning + "\n");
  std::string text = outcome_text(outcome);
  if (arguments.options.ranks != nullptr)
    text += traffic_text(*arguments.options.ranks, outcome.summary.steps);
  log.add(text);
  if (!arguments.quiet && !arguments.json) write_out_text(text);
  if (arguments.json) {
    std::ostringstream summary;
    summary << std::ifstream(outcome.summary_file).rdbuf();
    write_out_text(summary.str());
  }
  return outcome.summary.exit_code;
}

}  // namespace brio
