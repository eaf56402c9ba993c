#pragma once
/// One time step of the uniform-gradient hexahedron around the update of its integration point, in three
/// parts that are the same for all laws: they are compiled once and called.

#include "elements/solid/hex8.hpp"
#include "elements/solid/hourglass.hpp"
#include "elements/solid/mean_gradient.hpp"
#include "elements/solid/solid.hpp"

namespace brio {

/// State of an element besides that of its integration point.
template <class T>
struct Hex8State {
  T mass;
  T internal_energy;
  T viscous_pressure;  ///< of the last step
  HourglassState<T> hourglass;
};

/// Hourglass strain before the material yields. Energies are those of an element.
template <class T>
struct HourglassTrial {
  HourglassStrain<T> growth;  ///< strain increment
  T bending;                  ///< HourglassModuli::bending
  T work;                     ///< if all of it is elastic
  T old_energy;               ///< stored before
  T energy;                   ///< stored now
};

/// What the parts of a step hand on.
template <class T>
struct Hex8Step {
  HourglassVectors<T> x, rate;
  MeanGradient<T> b;
  T scaled_inverse_volume;
  Tensor<T> n;        ///< dt/2 times the velocity gradient of the middle
  T dilatation_rate;  ///< of the middle
  StepVolume<T> volume;
  MaterialAxes<T> axes;
  HourglassAxes<T> edges;
  HourglassTrial<T> hourglass;
  T hourglass_resistance;  ///< viscous
};

/// First part: the motion, followed by stress or material axes.
template <class T, ObjectiveRate rate>
BRIO_CALLED void follow_motion(const NodalMotion<T, 8>& motion, T step, SymmetricTensor<T>& stress,
                               RotationState<T, rate>& rotation, Hex8Step<T>& s, Increment<T>& increment) {
  const HexahedronModes<T> x = modes(motion.position);
  const HexahedronModes<T> v = modes(motion.velocity);
  s.b = mean_gradient(x);
  s.scaled_inverse_volume = gradient_scale / where(s.b.volume > T(0.0), s.b.volume, T(1.0));
  const Tensor<T> l = s.scaled_inverse_volume * scaled_gradient_of(v, s.b);
  s.x = hourglass_sums(x);
  s.rate = hourglass_rate(s.x, hourglass_sums(v), l);
  const T half_step = 0.5 * step;
  T determinant;
  s.n = centered(half_step * l, determinant);
  s.volume = step_volume(s.b.volume, determinant);
  s.dilatation_rate = middle_dilatation_rate(s.n, half_step, trace(l));
  increment.strain_rate_squared = strain_rate_squared(l);
  s.axes = follow(s.n, stress, rotation);
}

/// Elastic hourglass strain of the step. While the point yields, only a part of the increment is elastic;
/// unloading is elastic. \param moduli with the present shape \param has_yielded in this step
template <class T>
BRIO_INLINE void try_hourglass_strain(const Hex8& element, T step, const HourglassModuli<T>& moduli,
                                      MaskOf<T> has_yielded, HourglassState<T>& state, Hex8Step<T>& s) {
  s.edges = hourglass_axes(s.b, s.scaled_inverse_volume);
  const HourglassScale<T> old_scale = state.scale;
  state.scale = hourglass_scale(moduli);
  const SpringChange<T> change = spring_change(old_scale.stiffness, state.scale.stiffness);
  // As the gradients, displacements of the middle follow from those on the end configuration.
  HourglassVectors<T> q;
  for (int a = 0; a < hourglass_modes; ++a) q.mode[a] = step * (s.rate.mode[a] + turned(s.n, s.rate.mode[a]));
  HourglassTrial<T>& trial = s.hourglass;
  trial.growth =
      hourglass_strain(centered(s.edges, s.n), change.growth, 0.5 * (old_scale.twist + state.scale.twist), q);
  trial.bending = moduli.bending;
  trial.old_energy = square(change.carried) * stored_energy(state);
  T share(1.0);
  if (any(has_yielded)) {
    const MaskOf<T> grows = has_yielded & (dot(state.strain, trial.growth) >= T(0.0));
    share = where(grows, T(hourglass_share_in_flow(element.hourglass_stiffness)), T(1.0));
  }
  trial.work = state.scale.stiffness * stretch_hourglass(state.strain, change.carried, trial.growth, share);
  trial.energy = stored_energy(state);
}

/// Second part, after the update of stress: bulk viscosity, hourglass strain before it yields, stable step.
/// \param has_yielded in this step
template <class T>
BRIO_CALLED void resist_motion(const Hex8& element, T step, const ElasticModuli<T>& moduli,
                               MaskOf<T> has_yielded, Hex8State<T>& state, Hex8Step<T>& s,
                               Increment<T>& increment) {
  const SymmetricTensor<T> g = gradient_product(s.b, s.scaled_inverse_volume);
  const T inverse_mass = 1.0 / state.mass;
  const SolidSpectrum<T> spectrum = solid_spectrum(moduli, g, s.volume.end * inverse_mass);
  const T reference_frequency = sqrt(spectrum.reference);
  const BulkViscosity<T> viscosity =
      bulk_viscosity(element.linear_bulk_viscosity, element.quadratic_bulk_viscosity, s.dilatation_rate,
                     trace(g), state.mass * (s.scaled_inverse_volume / gradient_scale), reference_frequency);
  increment.viscous_energy = -(state.viscous_pressure + viscosity.pressure) * trace(s.n) * s.volume.middle;
  state.viscous_pressure = viscosity.pressure;

  const T distortion = hourglass_distortion(s.x, g);
  const HourglassModuli<T> stiffness =
      hourglass_stiffness(element.hourglass_stiffness, moduli, s.volume.end, distortion);
  try_hourglass_strain(element, step, stiffness, has_yielded, state.hourglass, s);
  T damping = viscosity.damping;
  if (element.hourglass_viscosity > 0) {
    s.hourglass_resistance =
        (0.25 * element.hourglass_viscosity) * state.mass * reference_frequency / (8.0 + distortion);
    damping += 8.0 * inverse_mass * s.hourglass_resistance * largest_gamma(distortion);
  }
  increment.frequency_squared = spectrum.uniform + (8.0 * hourglass_overlap) * inverse_mass *
                                                       stiffness.bending * largest_eigenvalue_bound(g) *
                                                       distortion;
  increment.stable_step =
      where(s.volume.is_valid, damped_stable_step(increment.frequency_squared, damping), T(-1.0));
}

/// Hourglass stress yields with the stress of the integration point: it is reduced by the ratio by which the
/// radial return reduces the deviatoric stress, and limited to that of a fully plastic section. Work that is
/// not stored is plastic work. Where no lane of a pack yields, plasticity costs nothing.
/// \param stress of the point, on its axes \param most energy that hourglass stress can store
template <class T>
BRIO_INLINE HourglassWork<T> return_hourglass_strain(const PointStep<T>& point,
                                                     const SymmetricTensor<T>& stress, T shear, T most,
                                                     const Hex8Step<T>& s, HourglassState<T>& state) {
  const HourglassTrial<T>& trial = s.hourglass;
  const MaskOf<T> exceeds = trial.energy > most;
  if (!any(point.has_yielded | exceeds)) return {trial.work, T(0.0)};
  T left = return_ratio(point.old_stress, stress, T(2.0) * s.axes.half_strain, shear, point.has_yielded);
  left *= where(exceeds, sqrt(most / where(exceeds, trial.energy, T(1.0))), T(1.0));
  const T work = trial.work - state.scale.stiffness * shrink_hourglass(state.strain, left, trial.growth);
  const T stored = square(left) * trial.energy - trial.old_energy;
  return {stored, work - stored};
}

/// Third part: hourglass strain returned to the yield surface, nodal forces.
template <ObjectiveRate rate, class T>
BRIO_CALLED void resist_with_forces(const Hex8& element, T step, const PointStep<T>& point,
                                    const SymmetricTensor<T>& stress, T shear, T most, Hex8State<T>& state,
                                    const Hex8Step<T>& s, Increment<T>& increment,
                                    NodalForces<T, 8>& forces) {
  const HourglassWork<T> hourglass = return_hourglass_strain(point, stress, shear, most, s, state.hourglass);
  increment.hourglass_energy = hourglass.stored;
  increment.internal_energy = s.volume.middle * point.work + hourglass.dissipated;
  state.internal_energy += increment.internal_energy;
  HourglassVectors<T> q = hourglass_forces(s.edges, state.hourglass);
  if (element.hourglass_viscosity > 0) {
    const T power = resist_hourglass(s.rate, s.hourglass_resistance, q);
    increment.viscous_energy += step * power;
  }
  nodal_forces(s.x, s.b, fixed_stress<rate>(stress, s.axes) - isotropic(state.viscous_pressure), q,
               s.scaled_inverse_volume, forces);
}

}  // namespace brio
