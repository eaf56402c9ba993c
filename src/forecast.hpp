#pragma once
/// How many steps a run takes and how long they last, from the first of them, which were marched.
///
/// Where the step stays as it is, so do number and cost. A scene that is crushed loses step, and nothing in
/// its first steps says how much. A pilot does: the same deck, coarsely meshed, marched to its end. Its step
/// falls at much the same times, but less, the coarser it is. With r the first step over the step of a time,
///
///     log r(t) = share * log r_pilot(t),
///
/// with the share that fits best over the time that both were marched, shifted to where the march ended; and
/// time per step grows as that of the pilot grows. Where nothing can be fitted, or where elements were
/// deleted, so that those that have set the step may be gone at any time, the share follows from how the
/// falls of two pilots differ: log r grows as a power of the number of elements along an edge (measured: 0 to
/// 0.4 for struck rods, 0.75 for plates and pipes that tear, 1 for walls that fold).

#include <optional>
#include <span>

#include "src/march.hpp"

namespace brio {

struct StepForecast {
  double steps = 0;
  /// Of all readings of the pilots, and a tenth more; without a pilot, `most` is 0.
  double least = 0, most = 0;
  double seconds = 0;        ///< of all steps, as a march counts them
  double share_of_fall = 1;  ///< of the finest pilot's fall
  bool exact = false;        ///< the march came to the end
};

struct Pilot {
  double factor = 2;  ///< by which its elements are longer
  March march;        ///< to the end
};

/// \param pilots the finest last. Without them the step stays as it is.
StepForecast forecast_steps(const March& own, std::span<const Pilot> pilots, double end);

/// How a pilot is read.
struct Reading {
  double share = 1;  ///< of its fall
  double shift = 1;  ///< share of the difference, where the march ended, that stays
};
/// The same, of a single pilot that is read in one way.
StepForecast forecast_steps(const March& own, const March& pilot, Reading reading, double end);

/// The share of a pilot's fall that fits a march best; nothing where the pilot's step has not fallen yet.
std::optional<double> share_of_fall(const March& own, const March& pilot);

/// The share of the finest pilot's fall that the trend of the finest two, or of one a usual trend, leads to.
double share_by_trend(std::span<const Pilot> pilots);

}  // namespace brio
