#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/streams.hpp"
#include "io/study/write_study.hpp"

namespace brio {

namespace {

void print_progress(const StudyProgress& progress) {
  const StudyRow& row = progress.row;
  write_error("{} of {}  {:<30} {:.3g} s{}  elapsed {:.0f} s, about {:.0f} s left\n", progress.done,
              progress.all, row.run.name, row.processor_s,
              row.exit_code == 0 ? "" : fmt::format("  ended with {}: {}", row.exit_code, row.message),
              progress.elapsed_s, progress.remaining_s);
}

}  // namespace

int study(StudyArguments& arguments) {
  const std::atomic<int>& stop_signal = noted_signal();
  note_signals();
  StudyOptions& options = arguments.options;
  options.program = std::filesystem::read_symlink("/proc/self/exe");
  options.stop = &stop_signal;
  if (!arguments.quiet) options.progress = print_progress;
  const StudyOutcome outcome = run_study(options);
  const std::string name = options.study.stem().string();
  write_study_table(outcome.table, outcome.folder, name);
  const std::string no_pictures = draw_study(outcome.table, outcome.folder, name);
  write_out("{}\ntable: {}\n", study_text(outcome.table), (outcome.folder / (name + ".csv")).string());
  if (no_pictures.empty()) {
    write_out("pictures: {}, {}\n", (outcome.folder / (name + ".front.svg")).string(),
              (outcome.folder / (name + ".knobs.svg")).string());
  } else {
    write_out("no pictures: {}\n", no_pictures);
  }
  if (stop_signal != 0) {
    write_error("brio: stopped; the same command goes on where it was\n");
    return 128 + stop_signal;
  }
  return outcome.exit_code();
}

}  // namespace brio
