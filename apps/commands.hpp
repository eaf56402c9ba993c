#pragma once
/// What the subcommands of `brio` do, once the command line is read. The library that reads it is seen by
/// brio.cpp alone: it takes seconds to compile.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "contact/start/initial_gap.hpp"
#include "io/plot/plot_history.hpp"
#include "io/report/write_report.hpp"
#include "io/run/forecast_deck.hpp"
#include "io/run/run_deck.hpp"
#include "io/study/run_study.hpp"

namespace brio {

/// Exit codes that scripts rely on.
inline constexpr int exit_good = 0;
inline constexpr int exit_bad_input = 2;          ///< bad command, deck or mesh: nothing was computed
inline constexpr int exit_numerical_failure = 3;  ///< the last good state was written
inline constexpr int exit_file_failure = 4;       ///< the system refused a file, memory or a thread: what was
                                                  ///< written before stays readable
inline constexpr int exit_defect = 70;            ///< the program itself is at fault

/// A line for each pair of parts whose nodes were moved apart before the first step.
std::string overlaps_text(std::span<const InitialOverlap> overlaps);

struct RunArguments {
  RunOptions options;
  std::string command;  ///< as it was given, for the log
  bool quiet = false;
  bool json = false;
};
/// \return the exit code.
int run(RunArguments& arguments);
struct StudyArguments {
  StudyOptions options;
  bool quiet = false;
};
/// \return the exit code.
int study(StudyArguments& arguments);
void check(const ForecastOptions& options, bool json);
/// \param verify whether everything is read and compared with its checksums as well
void print_info(const std::filesystem::path& result, bool verify);
/// \param words results, which exist, and columns of their histories
void plot(PlotOptions options, const std::vector<std::string>& words);
/// A first deck, NAME.yaml. \throws DeckError where the name is taken, FileError
void write_new_deck(const std::filesystem::path& name);
void report(const ReportOptions& options);
void print_schema(bool of_study, bool of_results, bool markdown);

}  // namespace brio
