#pragma once
/// End of a run, and its time steps.

#include <array>
#include <optional>
#include <string>

#include "src/base/fields.hpp"

namespace brio {

/// Elements whose stable time step is below a target get the mass that raises it to the target.
struct MassScaling {
  double step = 0;
  double largest_share = 0.05;
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(
        required("step", &MassScaling::step, positive, "target time step, before and during the run, time"),
        optional("largest_share", &MassScaling::largest_share, positive,
                 "mass added over mass of all elements at which the run stops with exit code 3, -"));
  }
};

/// The scene comes to rest under the loads of time 0 before the run.
struct Relaxation {
  double tolerance = 1e-4;
  int steps = 1000000;
  static constexpr auto fields() {
    return field_table(
        optional("tolerance", &Relaxation::tolerance, Range{.lower = 0, .upper = 0.1, .lower_open = true},
                 "root of the kinetic over the internal energy below which the scene is at rest, -"),
        optional("steps", &Relaxation::steps, at_least_one,
                 "steps after which a scene that is not at rest ends the run with exit code 3, -"));
  }
};

/// What bounds the time step (src/sweep/assembled_step.hpp).
enum class StepBound { assembled, nodes, elements };
constexpr std::array<NamedValue<StepBound>, 3> named_values(StepBound) {
  return {
      {{"assembled", StepBound::assembled}, {"nodes", StepBound::nodes}, {"elements", StepBound::elements}}};
}

struct TimeSection {
  double end = 0;
  double step_scale = 0.9;
  StepBound step_bound = StepBound::assembled;
  std::optional<double> step;
  double step_growth = 1.05;
  std::optional<MassScaling> mass_scaling{};
  std::string place{};  ///< in the deck
  std::optional<Relaxation> relaxation{};
  static constexpr auto fields() {
    return field_table(
        required("end", &TimeSection::end, positive, "time at which the run ends"),
        optional("step_scale", &TimeSection::step_scale, Range{.lower = 0, .upper = 1, .lower_open = true},
                 "scale factor on the stable time step, -"),
        optional(
            "step_bound", &TimeSection::step_bound, any_number,
            "what bounds the stable time step: all elements assembled, by an estimate where step_scale is at "
            "most 0.95, else as for nodes; nodes: the elements around each; elements: each by itself. All "
            "but the estimate are proven"),
        optional("step", &TimeSection::step, positive,
                 "constant time step; refused if above the stable time step"),
        optional("step_growth", &TimeSection::step_growth, Range{.lower = 1, .lower_open = true},
                 "largest ratio of a time step to the previous one, -"),
        optional("mass_scaling", &TimeSection::mass_scaling, any_number,
                 "mass added to small elements so that they do not set the stable time step; absent: none"),
        optional(
            "relaxation", &TimeSection::relaxation, any_number,
            "the scene comes to rest under the loads of time 0, with supports that stand, before initial "
            "velocities are given to it; absent: it starts without stress"));
  }
};

}  // namespace brio
