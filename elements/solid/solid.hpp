#pragma once
/// What the solid elements share: accepted material models, the update at an integration point, bulk
/// viscosity and the stable time step.

#include "elements/base/motion.hpp"
#include "elements/solid/objective_rate.hpp"
#include "materials/material_law.hpp"

namespace brio {

/// A material model in rate form, on strain increments.
template <class Law>
concept RateLaw = Law::traits.update;
/// A material model on total stretch: Cauchy stress on material axes from the right stretch.
template <class Law>
concept StretchLaw = Law::traits.update_from_stretch;
/// A material model with a yield stress (plastic_flow.hpp).
template <class Law>
inline constexpr bool has_yield_stress = Law::traits.hardening;
template <class Law>
inline constexpr bool is_solid_law = RateLaw<Law> || StretchLaw<Law>;

/// Rotation state of an integration point: none for the Jaumann rate.
template <class T, ObjectiveRate rate>
struct RotationState {
  StretchAndRotation<T> axes;
};
template <class T>
struct RotationState<T, ObjectiveRate::jaumann> {};

/// State of one integration point. Stress and history are on material axes (green_naghdi) or fixed ones
/// (jaumann).
template <class T, class Law, ObjectiveRate rate>
struct SolidPoint {
  SymmetricTensor<T> stress;
  [[no_unique_address]] typename Law::template History<T> history;
  [[no_unique_address]] RotationState<T, rate> rotation;
};

template <class T, class Law, ObjectiveRate rate>
BRIO_INLINE void start(SolidPoint<T, Law, rate>& point) {
  if constexpr (rate == ObjectiveRate::green_naghdi) {
    point.rotation.axes.stretch = isotropic(T(1.0));
    point.rotation.axes.rotation = {T(1.0), T(0.0), T(0.0), T(0.0)};
  }
}

/// Result of the update of an integration point.
template <class T>
struct PointStep {
  T work;  ///< per volume of the middle of the step
  SymmetricTensor<T> old_stress;
  MaskOf<T> has_yielded;  ///< in this step; never for elastic models
};

/// Ratio of the returned deviatoric stress to the elastic trial stress, 1 in elastic steps: hourglass stress
/// is returned by the same ratio. \param shear elastic shear modulus. \param has_yielded lanes with plastic
/// strain in this step.
template <class T>
BRIO_INLINE T return_ratio(const SymmetricTensor<T>& old_stress, const SymmetricTensor<T>& stress,
                           const SymmetricTensor<T>& strain, T shear, MaskOf<T> has_yielded) {
  const SymmetricTensor<T> trial = deviator(old_stress) + (2.0 * shear) * deviator(strain);
  const T left = contract(stress, trial) / where(has_yielded, contract(trial, trial), T(1.0));
  return where(has_yielded, min(max(left, T(0.0)), T(1.0)), T(1.0));
}

/// Rotates the material axes, or the stress where that is on fixed ones. \param n dt/2 times the velocity
/// gradient of the middle of the step.
template <class T>
BRIO_INLINE MaterialAxes<T> follow(const Tensor<T>& n, SymmetricTensor<T>&,
                                   RotationState<T, ObjectiveRate::green_naghdi>& rotation) {
  return advance(rotation.axes, n);
}
template <class T>
BRIO_INLINE MaterialAxes<T> follow(const Tensor<T>& n, SymmetricTensor<T>& stress,
                                   RotationState<T, ObjectiveRate::jaumann>&) {
  const MaterialAxes<T> axes = turn_with_spin(n);
  stress = turned(axes.end, stress);
  return axes;
}

/// Updates the stress. \param axes that the point has followed
template <class T, class Law, ObjectiveRate rate>
BRIO_INLINE PointStep<T> update(const Law& law, const MaterialAxes<T>& axes,
                                SolidPoint<T, Law, rate>& point) {
  if constexpr (rate == ObjectiveRate::jaumann && Law::traits.back_stress)
    point.history.back_stress = turned(axes.end, point.history.back_stress);
  PointStep<T> step{T(0.0), point.stress, T(0.0) > T(0.0)};
  T old_plastic_strain(0.0);
  if constexpr (has_yield_stress<Law>) old_plastic_strain = point.history.equivalent_plastic_strain;
  if constexpr (RateLaw<Law>) {
    law.update(T(2.0) * axes.half_strain, point.stress, point.history);
  } else {
    law.update_from_stretch(point.rotation.axes.stretch, point.stress, point.history);
  }
  if constexpr (has_yield_stress<Law>)
    step.has_yielded = point.history.equivalent_plastic_strain > old_plastic_strain;
  step.work = contract(step.old_stress + point.stress, axes.half_strain);
  return step;
}

/// Cauchy stress on fixed axes. \param axes of the end of the last step.
template <ObjectiveRate rate, class T>
BRIO_INLINE SymmetricTensor<T> fixed_stress(const SymmetricTensor<T>& stress, const MaterialAxes<T>& axes) {
  if constexpr (rate == ObjectiveRate::green_naghdi) {
    return turned(axes.end, stress);
  } else {
    return stress;
  }
}
template <class Law, ObjectiveRate rate>
SymmetricTensor<double> fixed_stress(const SolidPoint<double, Law, rate>& point) {
  if constexpr (rate == ObjectiveRate::green_naghdi) {
    return turned(rotation_matrix(point.rotation.axes.rotation, 2.0), point.stress);
  } else {
    return point.stress;
  }
}

/// The volume of a step: exact at its end, from the affine part of the motion at its middle. Where either is
/// not positive the element has inverted; the numbers are then replaced by harmless ones.
template <class T>
struct StepVolume {
  T end, middle;
  MaskOf<T> is_valid;
};
template <class T>
BRIO_INLINE StepVolume<T> step_volume(T volume, T determinant) {
  const MaskOf<T> is_valid = (volume > T(0.0)) & (determinant > T(0.0));
  const T end = where(is_valid, volume, T(1.0));
  return {end, end * where(is_valid, determinant, T(1.0)), is_valid};
}

/// Bounds of the squared frequencies of an element, which give its stable time step. With G_ij = sum_I B_iI
/// B_jI and equal nodal masses m/8 the stiffness of the uniform strains has its frequency squared bounded by
///
///     8 V / m (lambda tr G + 2 mu g),     g the largest eigenvalue of G,
///
/// exact for a cube: dt = 2/omega = h/c sqrt((1-nu)/(1+nu)). Flanagan & Belytschko 1984 have (lambda + 2 mu)
/// tr G, kept here as the reference for viscosity.
template <class T>
struct SolidSpectrum {
  T uniform;    ///< bound of omega^2 of the uniform strains
  T reference;  ///< (lambda + 2 mu) tr G 8 V / m: omega^2 of Flanagan & Belytschko
};
/// Largest eigenvalue of a symmetric positive matrix, from above; exact where the two smaller ones are equal.
template <class T>
BRIO_INLINE T largest_eigenvalue_bound(const SymmetricTensor<T>& g) {
  const T mean = trace(g) * (1.0 / 3.0);
  const SymmetricTensor<T> s = deviator(g);
  return mean + sqrt((2.0 / 3.0) * contract(s, s));
}
template <class T>
BRIO_INLINE SolidSpectrum<T> solid_spectrum(const ElasticModuli<T>& moduli, const SymmetricTensor<T>& g,
                                            T volume_by_mass) {
  const T factor = 8.0 * volume_by_mass;
  const T trace_g = trace(g);
  const T dilatational = max(moduli.first_lame, T(0.0)) * trace_g;
  return {factor * (dilatational + 2.0 * moduli.shear * largest_eigenvalue_bound(g)),
          factor * (moduli.first_lame + 2.0 * moduli.shear) * trace_g};
}

/// D:D of a velocity gradient.
template <class T>
BRIO_INLINE T strain_rate_squared(const Tensor<T>& l) {
  const SymmetricTensor<T> d = symmetric_part(l);
  return contract(d, d);
}

/// tr D at the middle of the step, where it is zero in rigid rotation; before the first time step that of the
/// velocities. \param n dt/2 times the velocity gradient of the middle.
template <class T>
BRIO_INLINE T middle_dilatation_rate(const Tensor<T>& n, T half_step, T rate_at_start) {
  const MaskOf<T> moved = half_step > T(0.0);
  return where(moved, trace(n) / where(moved, half_step, T(1.0)), rate_at_start);
}

/// Bulk viscosity on the length l = 1/sqrt(2 tr G), for which l c is a quarter of the reference frequency
/// over tr G.
template <class T>
struct BulkViscosity {
  T pressure;  ///< positive where it resists compression
  T damping;   ///< bound of the eigenvalues of (mass)^-1 (damping matrix), 1/time
};
/// q = - b1 rho c l tr D + [tr D < 0] rho (b2 l tr D)^2
/// \param reference_frequency square root of SolidSpectrum::reference.
template <class T>
BRIO_INLINE BulkViscosity<T> bulk_viscosity(double linear, double quadratic, T trace_d, T trace_g, T density,
                                            T reference_frequency) {
  const T compression = max(-trace_d, T(0.0));
  const T inverse = 1.0 / trace_g;
  const double squared = quadratic * quadratic;
  const T pressure =
      density * inverse *
      (0.5 * squared * compression * compression - (0.25 * linear) * reference_frequency * trace_d);
  return {pressure, 2.0 * linear * reference_frequency + (4.0 * squared) * compression};
}

/// Stable time step: the largest dt for which dt^2 omega^2 + 2 dt damping <= 4: central differences with the
/// damping force one half step behind, for any modes with these bounds. For one mode of damping ratio e this
/// is (sqrt(1 + e^2)
/// - e) 2/omega.
template <class T>
BRIO_INLINE T damped_stable_step(T frequency_squared, T damping) {
  return 4.0 / (damping + sqrt(square(damping) + 4.0 * frequency_squared));
}

}  // namespace brio
