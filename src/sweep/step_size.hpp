#pragma once
/// Choice of the time step, from the stable time step of the elements.

#include <cstddef>

#include "src/deck/deck.hpp"

namespace brio {

/// The time step and its bounds.
struct StepControl {
  TimeSection settings;
  double stable = 0;                 ///< stable time step of all elements, at the present time
  std::size_t critical_block = 0;    ///< block of the element that has the least by itself
  std::size_t critical_element = 0;  ///< that element, of the part's mesh
  double held = 0;                   ///< least bound since the last increase
  double window_least = 0;           ///< least bound of the steps counted in `window`
  int window = 0;
  double whole = 0;  ///< time step of which a whole number reaches the end time; 0: none chosen
  double first = 0;  ///< bound of the first time step
  double least = 0;
  double largest = 0;

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(stable, critical_block, critical_element, held, window_least, window, whole, first, least,
            largest);
  }
};

/// Up to this share of the stable time step there is a margin for what it is not known to exactly.
inline constexpr double largest_scale_with_margin = 0.95;

/// A time step that follows the stable time step through every vibration is in phase with it and adds energy
/// (Skeel 1993, Variable step size destabilizes the Stoermer/leapfrog/Verlet method). It therefore decreases
/// at once, but increases only to the least bound of a whole window of steps, and only if that is a
/// worthwhile increase.
double held_step(StepControl& control, double bound);

/// The time step for a bound and the remaining time: the bound, or, where few steps remain, one of which a
/// whole number reaches the end time. A change of the time step from d to d' changes the energy of the
/// central difference method by |f|^2 / m (d'^2 - d^2) / 8, f the force on a mass m: of an oscillation near
/// its stable time step by twice the relative change, so that a last step of half the size can end a run.
double whole_step(StepControl& control, double bound, double left);

}  // namespace brio
