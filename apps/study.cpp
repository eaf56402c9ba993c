#include <fmt/format.h>

#include <atomic>
#include <csignal>
#include <cstdio>

#include "apps/commands.hpp"
#include "io/write_study.hpp"

namespace brio {

namespace {

std::atomic<int> stop_signal{0};

void stop_after_these_runs(int signal) { stop_signal = signal; }

void print_progress(const StudyProgress& progress) {
  const StudyRow& row = progress.row;
  fmt::print(stderr, "{} of {}  {:<30} {:.3g} s{}  elapsed {:.0f} s, about {:.0f} s left\n", progress.done,
             progress.all, row.run.name, row.processor_s,
             row.exit_code == 0 ? "" : fmt::format("  ended with {}: {}", row.exit_code, row.message),
             progress.elapsed_s, progress.remaining_s);
  std::fflush(stderr);
}

}  // namespace

int study(StudyArguments& arguments) {
  std::signal(SIGINT, stop_after_these_runs);
  std::signal(SIGTERM, stop_after_these_runs);
  StudyOptions& options = arguments.options;
  options.program = std::filesystem::read_symlink("/proc/self/exe");
  options.stop = &stop_signal;
  if (!arguments.quiet) options.progress = print_progress;
  const StudyOutcome outcome = run_study(options);
  const std::string name = options.study.stem().string();
  write_study_table(outcome.table, outcome.folder, name);
  const std::string no_pictures = draw_study(outcome.table, outcome.folder, name);
  fmt::print("{}\ntable: {}\n", study_text(outcome.table), (outcome.folder / (name + ".csv")).string());
  if (no_pictures.empty()) {
    fmt::print("pictures: {}, {}\n", (outcome.folder / (name + ".front.svg")).string(),
               (outcome.folder / (name + ".knobs.svg")).string());
  } else {
    fmt::print("no pictures: {}\n", no_pictures);
  }
  if (stop_signal != 0) {
    fmt::print(stderr, "brio: stopped; the same command goes on where it was\n");
    return 128 + stop_signal;
  }
  return outcome.complete ? exit_good : exit_numerical_failure;
}

}  // namespace brio
