#pragma once
/// How many steps a run takes and how long they last, from the first of them, which were marched.
///
/// Where the step stays as it is, so do number and cost. A scene that is crushed loses step, and nothing in
/// its first steps says how much. A pilot does: the same deck, coarsely meshed, marched to its end. Its step
/// falls at much the same times, but less, the coarser it is. With r the first step over the step of a time,
///
///     log r(t) = share * log r_pilot(t) + missed * exp(-(t - t_marched) / lasting),
///
/// with what is missed where the march ended, and the share that fits best over the time that both were
/// marched, as far as their falls say anything, and else is usual: log r grows as a power of the number of
/// elements along an edge. Measured on ten scenes, the exponent is 0 to 0.4 for struck rods, for birds and
/// for pipes that tear, 0.5 for bricks, 0.7 for plates that tear and 1 for walls that fold. Where elements
/// are deleted, those that have set the step may be gone at any time: there the march says nothing of what
/// follows. Elsewhere the forecast leans towards a step that stays as it is, the more the pilot missed (in
/// logarithms). Time per step grows with that of the pilot, by as much as it was seen to.

#include "src/forecast/march.hpp"

namespace brio {

struct StepForecast {
  double steps = 0;
  /// Of all readings of the pilot, and a tenth more; without a pilot, `most` is 0.
  double least = 0, most = 0;
  double seconds = 0;        ///< of all steps, as a march counts them
  double share_of_fall = 1;  ///< of the pilot's fall
  bool exact = false;        ///< the march came to the end
};

struct Pilot {
  double factor = 2;  ///< by which its elements are longer
  March march;        ///< to the end
};

/// The step stays as it is.
StepForecast forecast_steps(const March& own, double end);
StepForecast forecast_steps(const March& own, const Pilot& pilot, double end);

/// How a pilot is read.
struct Reading {
  double share = 1;    ///< of its fall
  double lasting = 1;  ///< time over which what it missed fades
};
/// The same, read in one way.
StepForecast forecast_steps(const March& own, const March& pilot, Reading reading, double end);

/// The share of a pilot's fall that a march shows as far as it goes, and `usual` as far as it says nothing.
double share_of_fall(const March& own, const March& pilot, double usual, double end);

}  // namespace brio
