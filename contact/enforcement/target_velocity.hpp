#pragma once
/// What relative velocity a row asks for.

#include <algorithm>

#include "contact/options.hpp"

namespace brio {

/// How overlap is recovered in a step.
struct Recovery {
  double share = 0.1;  ///< of a deep overlap that a step may remove, ...
  double deep = 0;     ///< ... and from which depth on; of shallower ones the less the shallower they are
  double cap = 0;      ///< most that a step removes
};
/// As the options say. \param deep_share of the smallest edge: from there on an overlap is deep.
inline Recovery recovery_of(const ContactOptions& options, double smallest_edge, double deep_share = 0.1) {
  return {options.overlap_recovery, deep_share * smallest_edge, options.overlap_recovery_cap * smallest_edge};
}

/// Least normal relative velocity over a step: a gap may close, no more; an overlap is opened a little.
/// Shallow overlaps are opened the slower the shallower they are: where impulses lag behind what iterations
/// have yet to find, opening in proportion to depth integrates the overlap, which feeds slow vibrations of
/// what rests. A contact under load is opened the slower the more it carries beyond what a node gains by its
/// recovery: it would otherwise be opened with any force, and so give energy to what is pressed together; one
/// that has carried nothing is not opened, since what it will carry is not known.
/// \param impulse carried over from the step before. \param mass effective mass along the normal; 0
/// where nothing can move.
inline double target_velocity(const Recovery& recovery, double gap, double impulse, double mass, double dt) {
  if (gap >= 0) return -gap / dt;
  if (!(impulse > 0)) return 0;
  const double share = recovery.share * (-gap < recovery.deep ? -gap / recovery.deep : 1);
  const double unloaded = std::min(share * -gap, recovery.cap) / dt;
  const double gain = mass * unloaded;
  return impulse > gain ? unloaded * (gain / impulse) : unloaded;
}

}  // namespace brio
