#pragma once
/// Number and cost of the time steps of a run, predicted from a timed run of its first steps.
///
/// Where the stable time step is constant, so are number and cost. In a scene that is crushed the stable time
/// step decreases, and its first steps do not say by how much. A coarse run does: the same deck, coarsely
/// meshed, run to its end. Its time step decreases at much the same times, but by less, the coarser it is.
/// With r(t) = (first time step) / (time step at t),
///
///     log r(t) = ratio * log r_coarse(t) + missed * exp(-(t - t_timed) / decay_time),
///
/// where `missed` is the difference at the end of the timed run, and `ratio` is fitted over the time that
/// both have covered, as far as the decreases seen there determine it. Otherwise it is the usual one: log r
/// grows as a power of the number of elements along an edge. Measured on ten scenes, the exponent is 0 to 0.4
/// for struck rods, for birds and for pipes that fracture, 0.5 for bricks, 0.7 for plates that fracture and 1
/// for walls that fold. Where elements are deleted, those that have set the time step may be deleted at any
/// time: there the timed run predicts nothing. Elsewhere the prediction is averaged (in logarithms) with that
/// of a constant time step, whose weight grows with `missed`. Time per step grows with that of the coarse
/// run, by the measured slope.

#include "src/forecast/timed_run.hpp"

namespace brio {

struct StepForecast {
  double steps = 0;
  /// Bounds over all extrapolations of the coarse run, widened by a tenth; without one, `most` is 0.
  double least = 0, most = 0;
  double seconds = 0;         ///< of all steps, by the work_clock
  double decrease_ratio = 1;  ///< log of the decrease of the time step over that of the coarse run
  bool exact = false;         ///< the timed run reached the end time
};

struct CoarseRun {
  double factor = 2;  ///< ratio of element lengths, coarse over original
  TimedRun run;       ///< to the end time
};

/// With a constant time step.
StepForecast forecast_steps(const TimedRun& own, double end);
StepForecast forecast_steps(const TimedRun& own, const CoarseRun& coarse, double end);

/// Parameters of the extrapolation from a coarse run.
struct Extrapolation {
  double ratio = 1;
  double decay_time = 1;
};
/// The same, for one set of parameters.
StepForecast forecast_steps(const TimedRun& own, const TimedRun& coarse, Extrapolation extrapolation,
                            double end);

/// Least-squares fit of the ratio of decreases, regularized towards `usual`.
double decrease_ratio(const TimedRun& own, const TimedRun& coarse, double usual, double end);

}  // namespace brio
