#pragma once
/// The size of a step, from the bound that elements set.

#include <cstddef>

#include "src/deck/deck.hpp"

namespace brio {

/// The step and what bounds it.
struct StepControl {
  TimeSection settings;
  double stable = 0;                 ///< of all elements, at the present time
  std::size_t critical_block = 0;    ///< where it is set
  std::size_t critical_element = 0;  ///< of the part's mesh
  double held = 0;                   ///< what the bound has left since it last grew
  double window_least = 0;           ///< least bound of the steps counted in `window`
  int window = 0;
  double whole = 0;  ///< of which a whole number leads to the end; 0: none is known
  double first = 0;  ///< bound of the first step made
  double least = 0;
  double largest = 0;
};

/// A step that follows the stable step through every vibration is in time with that vibration and feeds it
/// (Skeel 1993, Variable step size destabilizes the Stoermer/leapfrog/Verlet method): it comes down at once,
/// but goes up only by what the least bound of a whole window leaves, and only where that is worth it.
double held_step(StepControl& control, double bound);

/// The step for a bound and the time that is left: the bound, and where few steps are left, one of which a
/// whole number leads to the end. A change of the step from d to d' changes the energy of central differences
/// by |f|^2 / m (d'^2 - d^2) / 8, f the force on a mass m: of an oscillation near its stable step by twice
/// the share by which the step is shortened, so that a last step of half the size can end a run.
double whole_step(StepControl& control, double bound, double left);

}  // namespace brio
