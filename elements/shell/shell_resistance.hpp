#pragma once
/// One time step of the Belytschko-Tsay shell around the updates of stress at its integration points, the
/// same for all laws: stable step, viscosity, resistance to hourglass modes and drilling, nodal
/// forces. Inlined: compiled once and called, it would make the sweep 1 to 3 % slower.

#include <cmath>

#include "elements/base/changing_spring.hpp"
#include "elements/shell/shell4.hpp"
#include "elements/shell/shell_step.hpp"
#include "elements/shell/shell_strain.hpp"

namespace brio {

/// State of an element besides that of its integration points.
template <class T>
struct Shell4State {
  T mass;
  T thickness;
  T inverse_gyration;  ///< 1 / r^2: nodal mass over nodal rotational inertia
  T internal_energy;
  T viscous_force;  ///< per length, of the last step
  ReferenceShape<T> reference;
  T hourglass[3];  ///< strains of the elastic hourglass control (changing_spring.hpp)
  T rotation[2];
  T drilling;                                 ///< angle about the normal
  HourglassStiffness<T> hourglass_stiffness;  ///< of the last step
  T drilling_stiffness;
  T viscous_drilling;  ///< moment of the last step
};

/// Angle, in radians, at which resistance to drilling yields.
inline constexpr double drilling_limit = 0.01;

/// Upper bound of the highest frequency squared, without resistance to drilling.
template <class T>
BRIO_INLINE T frequency_square(const Shell4& element, const ShellGeometry<T>& g,
                               const PlaneStressModuli<T>& moduli, const Shell4State<T>& state) {
  return highest_frequency_square(g, moduli, element.shear_factor, element.rule().second_moment, state.mass,
                                  state.thickness, state.inverse_gyration, element.hourglass_stiffness,
                                  element.warping_projection);
}

/// Moment per spin about the normal.
template <class T>
BRIO_INLINE T drill_stiffness(const Shell4& element, T frequency_squared, const Shell4State<T>& state) {
  return element.drilling_stiffness * frequency_squared * state.mass / state.inverse_gyration;
}

/// What resistance to drilling adds to the largest square of a frequency: its only mode is all four nodes'
/// spin against that of the material.
template <class T>
BRIO_INLINE T drilling_frequency_square(const ShellGeometry<T>& g, T drill, const Shell4State<T>& state) {
  return (drill / state.mass) * (state.inverse_gyration + 1.25 * gradient_square(g));
}

/// What damping of drilling adds to the ratio of damping. Strain meets the part of the mode that is the
/// material's spin, a share t = s r^2 of that of the nodes. For a mode p joined with strain by the root of
/// t p, all together is below the larger of (strain + 5/4 t p) and 5 p; 5 p is below 1 where the spring is
/// weak.
template <class T>
BRIO_INLINE T drilling_damping(const Shell4& element, const ShellGeometry<T>& g,
                               const Shell4State<T>& state) {
  const double ratio = element.drilling_viscosity * std::sqrt(element.drilling_stiffness);
  const T share = gradient_square(g) / state.inverse_gyration;
  const bool is_weak = 5 * (element.drilling_stiffness + 2 * ratio) <= 1;
  return is_weak ? (1.25 * ratio) * share : ratio * (1.0 + share);
}

/// Nodal spin about the normal bends no element that is flat, and nothing else would resist it; but moments
/// of elements that are tilted against each other drive it, and turn it into what bends. (After Hughes &
/// Brezzi 1989: a weak spring between the spin of the nodes and that of the material. One for the mean of
/// the nodes, as one point of integration gives: nodes spin unequally where a warped surface bends, and one
/// for each would lock it. It yields at a hundredth of a radian, so that it does not resist where the
/// corners of folds shear in their plane. Moments are not those of a potential in that spin: it swings up
/// in strips of short elements that are bent strongly, unless damped.)
template <class T>
BRIO_INLINE void resist_drilling(const Shell4& element, T drill, const ShellRates<T>& rates, T step,
                                 Shell4State<T>& state, ShellRates<T>& result, Increment<T>& increment) {
  const SpringChange<T> change = spring_change(state.drilling_stiffness, drill);
  state.drilling_stiffness = drill;
  const T before = change.carried * state.drilling;
  const T growth = (step * change.growth) * rates.drilling;
  state.drilling = min(max(before + growth, -drilling_limit), drilling_limit);
  increment.hourglass_energy += (0.5 * drill) * growth * (before + state.drilling);
  const T elastic = drill * state.drilling;
  const T damper = (2 * element.drilling_viscosity) * sqrt(drill * state.mass / state.inverse_gyration);
  const T most = drilling_limit * drill;
  result.drilling = min(max(elastic + damper * rates.drilling, -most), most);
  const T viscous = result.drilling - elastic;
  increment.viscous_energy += (0.5 * step) * rates.drilling * (state.viscous_drilling + viscous);
  state.viscous_drilling = viscous;
}

/// Elastic and viscous hourglass forces (Belytschko, Ong, Liu & Kennedy 1984).
/// They stay elastic where the material flows: shrunk with its stress, as those of bricks are, they let the
/// elements of a can's folds collapse into slivers.
template <class T>
BRIO_INLINE void resist_hourglass(const Shell4& element, const ShellGeometry<T>& g,
                                  const PlaneStressModuli<T>& moduli, const ShellRates<T>& rates, T step,
                                  T undamped_step, Shell4State<T>& state, ShellRates<T>& result,
                                  Increment<T>& increment) {
  const HourglassStiffness<T> stiffness = brio::hourglass_stiffness(
      g, moduli, element.shear_factor, state.thickness, element.hourglass_stiffness);
  const HourglassStiffness<T> old = state.hourglass_stiffness;
  state.hourglass_stiffness = stiffness;
  const SpringChange<T> in_plane = spring_change(old.membrane, stiffness.membrane);
  const SpringChange<T> bow = spring_change(old.normal, stiffness.normal);
  const SpringChange<T> turning = spring_change(old.rotation, stiffness.rotation);
  T work = T(0.0);
  const auto force = [step, &work](T& strain, const SpringChange<T>& change, T rate, T end_stiffness) {
    const T before = change.carried * strain;
    const T growth = (step * change.growth) * rate;
    strain = before + growth;
    work += end_stiffness * ((before + strain) * growth);
    return end_stiffness * strain;
  };
  for (int c = 0; c < 2; ++c) {
    result.hourglass[c] = force(state.hourglass[c], in_plane, rates.hourglass[c], stiffness.membrane);
    result.rotation[c] = force(state.rotation[c], turning, rates.rotation[c], stiffness.rotation);
  }
  result.hourglass[2] = force(state.hourglass[2], bow, rates.hourglass[2], stiffness.normal);
  increment.hourglass_energy = 0.5 * work;
  if (element.hourglass_viscosity > 0) {
    const T damper = element.hourglass_viscosity * state.mass / (4.0 * undamped_step);
    const T rotation_damper = damper / state.inverse_gyration;
    T power = T(0.0);
    for (int c = 0; c < 3; ++c) {
      result.hourglass[c] += damper * rates.hourglass[c];
      power += damper * square(rates.hourglass[c]);
    }
    for (int c = 0; c < 2; ++c) {
      result.rotation[c] += rotation_damper * rates.rotation[c];
      power += rotation_damper * square(rates.rotation[c]);
    }
    increment.viscous_energy += step * power;
  }
}

/// A step that more than halves the area of an element has crushed it or turned it over: strains mean
/// nothing.
inline constexpr double most_shrinkage = 2;

/// After the updates of stress. \param result membrane forces, moments and shear forces per length that
/// stress has
template <class T>
BRIO_INLINE void resist_motion(const Shell4& element, T step, const ElasticModuli<T>& elastic,
                               const ShellGeometry<T>& g, const ShellRates<T>& rates, Shell4State<T>& state,
                               ShellRates<T>& result, Increment<T>& increment,
                               RotatingNodalForces<T, 4>& nodal) {
  const auto moduli = plane_stress_moduli(elastic);
  T frequency = frequency_square(element, g, moduli, state);
  T drill = T(0.0);
  if (element.drilling_stiffness > 0) {
    drill = drill_stiffness(element, frequency, state);
    frequency += drilling_frequency_square(g, drill, state);
  }
  const T undamped = 2.0 / sqrt(frequency);
  T damping = T(element.linear_bulk_viscosity);
  if (element.hourglass_viscosity > 0)
    damping += element.hourglass_viscosity * (1.0 + 0.5 * (square(g.skew[0]) + square(g.skew[1])));
  if (element.drilling_stiffness > 0) damping += drilling_damping(element, g, state);
  increment.frequency_squared = frequency;
  increment.strain_rate_squared = strain_rate_squared(rates, state.thickness);
  const MaskOf<T> is_whole = g.is_valid & (rates.squared_area_at_start < T(square(most_shrinkage)));
  increment.stable_step = where(is_whole, undamped * damped_share(damping), 0.0);

  // Viscosity as if the stiffness of equal stretch in both directions, E' (1 + nu) / 2, acted for b1 stable
  // steps.
  const T stretching = rates.membrane[0] + rates.membrane[1];
  const T viscous_force = (0.5 * element.linear_bulk_viscosity) * (state.thickness * undamped) *
                          (moduli.stretch * (1.0 + moduli.ratio)) * stretching;
  result.membrane[0] += viscous_force;
  result.membrane[1] += viscous_force;
  const T middle_area = g.area * (1.0 - 0.5 * step * stretching);
  increment.viscous_energy =
      (0.5 * middle_area * step) * ((state.viscous_force + viscous_force) * stretching);
  state.viscous_force = viscous_force;

  resist_hourglass(element, g, moduli, rates, step, undamped, state, result, increment);
  result.drilling = T(0.0);
  if (element.drilling_stiffness > 0) resist_drilling(element, drill, rates, step, state, result, increment);
  shell_forces(g, result, element.warping_projection, nodal);
}

}  // namespace brio
