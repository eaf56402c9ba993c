#include "src/sweep/step_size.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

constexpr int window_steps = 100;
constexpr double worthwhile_growth = 1.02;

/// A number of steps that differs from a whole one by this share is whole: rounding of the time.
constexpr double rounding_of_count = 1e-9;
/// A whole number is chosen when so many are left: one more shortens each by less than a hundredth.
constexpr double few_steps = 100;
/// By this share the chosen step may exceed a bound that falls, where that is below the stable step by more.
constexpr double tolerated_excess = 1e-2;

}  // namespace

double held_step(StepControl& control, double bound) {
  if (control.held == 0) control.held = control.window_least = bound;
  control.window_least = std::min(control.window_least, bound);
  if (++control.window == window_steps) {
    if (control.window_least > worthwhile_growth * control.held) control.held = control.window_least;
    control.window = 0;
    control.window_least = bound;
  }
  control.held = std::min(control.held, bound);
  return control.held;
}

double whole_step(StepControl& control, double bound, double left) {
  if (bound >= left) return left;  // without elements there is no bound
  const double count = left / bound;
  if (!(count < few_steps)) return bound;
  const bool has_margin = !control.settings.step && control.settings.step_scale <= largest_scale_with_margin;
  if (control.whole > (1 + (has_margin ? tolerated_excess : 0)) * bound) control.whole = 0;
  if (control.whole == 0) {
    const double even = left / std::ceil(count * (1 - rounding_of_count));
    control.whole = std::abs(even - bound) <= rounding_of_count * bound ? bound : even;
  }
  return control.whole;
}

}  // namespace brio
