#pragma once
/// A whole study: one deck over a table of settings, what each costs and how far off it is.

#include <atomic>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "io/files/folder_lock.hpp"
#include "src/forecast/study.hpp"

namespace brio {

/// One line of the table.
struct StudyRow {
  StudyRun run;
  int exit_code = 0;
  std::string message;   ///< why it failed
  bool has_run = false;  ///< in this call or an earlier one
  bool reused = false;   ///< the result of an earlier call was still good
  bool is_reference = false;
  double processor_s = 0, wall_s = 0, peak_memory_mb = 0;
  double steps = 0;
  std::vector<double> figures;  ///< one a quantity; not-a-number where the run failed
  std::vector<double> errors;   ///< the same, relative
  /// Root mean square of the errors.
  double error = std::numeric_limits<double>::quiet_NaN();
  bool on_front = false;
  bool beats_default = false;  ///< cheaper and more accurate by more than `beating_share`
};

/// What makes a setting better than the default beyond doubt, cost and error alike.
inline constexpr double beating_share = 0.05;

struct StudyTable {
  Study study;
  std::vector<double> references;  ///< one a quantity
  std::vector<StudyRow> rows;
};

struct StudyProgress {
  std::size_t done = 0, all = 0;
  double elapsed_s = 0, remaining_s = 0;
  const StudyRow& row;  ///< that has just ended
};

struct StudyOptions {
  std::filesystem::path study;
  std::filesystem::path output;   ///< empty: NAME.study where the program runs
  std::filesystem::path program;  ///< that runs decks
  int jobs = 1;                   ///< runs side by side
  bool again = false;             ///< whether runs that are there are made again
  const std::atomic<int>* stop = nullptr;
  std::function<void(const StudyProgress&)> progress;
};

struct StudyOutcome {
  StudyTable table;
  std::filesystem::path folder;
  std::shared_ptr<const FolderLock> lock;  ///< of the folder, for what is still to be written there

  /// 0, or that of a run that failed: 4 where the file system did, else 3.
  int exit_code() const;
};

/// Runs what has not been run with this program and these settings before. An earlier result is taken where
/// its record, its summary and every checksum of it are as they should be; else the run is made again. One
/// that fails does not keep the others from being run. \throws DeckError, FileError
StudyOutcome run_study(const StudyOptions& options);

}  // namespace brio
