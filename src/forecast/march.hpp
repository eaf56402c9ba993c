#pragma once
/// Steps without output, to learn what steps take: of time and of wall time.

#include <cstdint>
#include <string>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

struct MarchedStep {
  double time;           ///< at its beginning
  double size;           ///< of the step
  double seconds;        ///< that it took, by the work_clock
  std::int64_t deleted;  ///< elements, so far
};

struct March {
  std::vector<MarchedStep> steps;
  double time = 0;  ///< reached
  double wall_seconds = 0;
  bool reached_end = false;
  std::string breakdown;  ///< why it ended early; empty if it did not

  bool is_over() const { return reached_end || !breakdown.empty(); }
  double seconds() const;
  /// Wall time over what steps take on a machine that has nothing else to do; 1 with several threads.
  double waiting() const;
};

/// Seconds of a clock: of the processor with one thread, so that others who use the machine do not count,
/// else of the wall.
double work_clock(int threads);

/// Steps until the end time, a breakdown, or as long as the budget lasts; at least one is appended, unless
/// the end is reached. On entry and on return velocities have been updated, so that fields may be looked at.
void march(March& march, Model& model, double energy_error_limit, double budget_s, ThreadTeam& team);

/// Mean of the steps from a time on; the first few, in which memory is touched for the first time, are left
/// out where there are others.
double seconds_per_step(const March& march, double from_time = 0);

}  // namespace brio
