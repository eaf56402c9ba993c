#pragma once
/// A timed run: time steps without output, to measure their sizes and their wall time.

#include <cstdint>
#include <string>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

struct TimedStep {
  double time;           ///< at its beginning
  double size;           ///< the time step
  double seconds;        ///< its cost by the work_clock
  std::int64_t deleted;  ///< deleted elements so far
};

struct TimedRun {
  std::vector<TimedStep> steps;
  double time = 0;  ///< reached
  double wall_seconds = 0;
  bool reached_end = false;
  std::string breakdown;  ///< why it ended early; empty if it did not

  bool is_over() const { return reached_end || !breakdown.empty(); }
  double seconds() const;
  /// Ratio of the wall time to that on an idle machine; 1 with several threads.
  double waiting() const;
};

/// Seconds of processor time with one thread, so that other processes do not count; else of wall time.
double work_clock(int threads);

/// Time steps until the end time, a breakdown or the end of the budget; at least one is appended, unless the
/// end time is reached. On entry and on return velocities have been updated, so that fields may be read.
void continue_run(TimedRun& timed, Model& model, double energy_error_limit, double budget_s,
                  ThreadTeam& team);

/// Mean cost of the steps from a time on, without the first few, in which memory is used for the first time,
/// if there are others.
double seconds_per_step(const TimedRun& run, double from_time = 0);

}  // namespace brio
