#include "src/step/choose_step.hpp"

#include <algorithm>

#include "src/base/breakdown.hpp"
#include "src/step/diagnosis.hpp"

namespace brio {

namespace {

// A time step this much smaller than the first means that the mesh has collapsed.
constexpr double collapse_ratio = 1e-5;

// The last step may be longer than the others by this ratio: rounding of the time.
constexpr double last_step_share = 1e-3;

}  // namespace

void choose_step(Model& model) {
  StepControl& control = model.control;
  double step = held_step(control, control.settings.step_scale * control.stable);
  if (control.settings.step) {
    step = *control.settings.step;
    if (step > control.stable)
      throw Breakdown("the constant time step " + written(step) + " exceeds the stable time step " +
                      written(control.stable) + " of " + critical_name(model));
  }
  const double largest = model.step > 0 ? control.settings.step_growth * model.times.previous : step;
  if (model.step > 0 && std::min(step, largest) < collapse_ratio * control.first)
    throw Breakdown("the stable time step has collapsed to " + written(step) + ", set by " +
                    critical_name(model) + ", at time " + written(model.times.time) + "; " +
                    cause_of_collapse(model));
  if (model.step == 0) control.first = step;
  const double left = control.settings.end - model.times.time;
  step = left > 0 ? whole_step(control, step, left) : model.times.previous;
  if (step > largest) {
    step = largest;
    control.whole = 0;
  }
  // The remaining time is reached without a very short last step.
  if (left > 0 && step >= (1 - last_step_share) * left) {
    step = left;
  } else if (left > 0 && 2 * step > (1 + last_step_share) * left) {
    step = 0.5 * left;
  }
  model.times.next = step;
  if (model.step == 0) control.least = control.largest = step;
  if (left > 2 * step) control.least = std::min(control.least, step);
  control.largest = std::max(control.largest, step);
}

}  // namespace brio
