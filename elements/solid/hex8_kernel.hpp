#pragma once
/// Uniform-gradient hexahedron: eight nodes, one integration point (Flanagan & Belytschko 1981), for one
/// objective rate.
///
/// The gradient is taken once, on the configuration at the end of the step: L_end. The velocity gradient of
/// the middle follows exactly for affine motion, so that a rigid rotation of any size gives no strain, and so
/// does the volume at the middle, V_mid = V det(I - dt/2 L_end). Forces are V sigma B at the end; the work
/// accounted for is V_mid (sigma_old + sigma_new)/2 : D dt, which differs from the work of the forces by
/// third order in the step.

#include "elements/solid/hex8.hpp"
#include "elements/solid/hourglass.hpp"
#include "elements/solid/mean_gradient.hpp"
#include "materials/hardening.hpp"

namespace brio {

template <ObjectiveRate rate>
struct Hex8Kernel : Hex8 {
  using Settings = Hex8;
  static constexpr KernelTraits kernel_traits{
      .uses_differences = true, .tangent = true, .completes_samples = true};
  static constexpr int most_points = 1;
  static constexpr int points() { return 1; }
  static double point_size(double volume) { return std::cbrt(volume); }
  static constexpr bool is_unrotated = rate == ObjectiveRate::green_naghdi;
  template <class Law>
  static constexpr bool accepts = RateLaw<Law> || (is_unrotated && StretchLaw<Law>);

  template <class T, class Law>
  struct Header {
    T mass;
    T internal_energy;
    T viscous_pressure;  ///< of the last step
    HourglassState<T> hourglass;
  };
  template <class T, class Law>
  using Point = SolidPoint<T, Law, rate>;

  template <class T, class Law>
  NodalMass<T> initialize(const NodalMotion<T, 8>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>* point) const {
    const HexahedronModes<T> x = modes(motion.position);
    const MeanGradient<T> b = mean_gradient(x);
    header.mass = T(law.density) * b.volume;
    start(*point);
    const T volume = where(b.volume > T(0.0), b.volume, T(1.0));
    const T distortion = hourglass_distortion(x, gradient_product(b, gradient_scale / volume));
    header.hourglass.scale = hourglass_scale(brio::hourglass_stiffness(
        hourglass_stiffness, law.template moduli<T>(point->history), volume, distortion));
    return {header.mass * 0.125, T(0.0)};
  }

  /// The same without damping forces.
  Hex8Kernel undamped() const {
    Hex8Kernel kernel = *this;
    kernel.linear_bulk_viscosity = 0;
    kernel.quadratic_bulk_viscosity = 0;
    kernel.hourglass_viscosity = 0;
    return kernel;
  }
  /// State with the present shape and without stress. \param header, point out, zero before
  template <class T, class Law, class Other>
  void start_unstressed(const Header<T, Law>& now, Header<T, Other>& header, Point<T, Other>* point) const {
    header.mass = now.mass;
    header.hourglass.scale = now.hourglass.scale;
    start(*point);
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const NodalMotion<T, 8>& motion, T step, const Law& law,
                                 Header<T, Law>& header, Point<T, Law>* point,
                                 NodalForces<T, 8>& forces) const {
    const HexahedronModes<T> x = modes(motion.position);
    const HexahedronModes<T> v = modes(motion.velocity);
    const MeanGradient<T> b = mean_gradient(x);
    const T half_step = 0.5 * step;
    const T scaled_inverse_volume = gradient_scale / where(b.volume > T(0.0), b.volume, T(1.0));
    const Tensor<T> scaled_l = scaled_gradient_of(v, b);
    const Tensor<T> half_l = (half_step * scaled_inverse_volume) * scaled_l;
    T determinant;
    const Tensor<T> n = centered(half_l, determinant);
    const StepVolume<T> volume = step_volume(b.volume, determinant);

    MaterialAxes<T> axes;
    Increment<T> increment;
    const PointStep<T> point_step = update(law, n, *point, axes);
    increment.internal_energy = volume.middle * point_step.work;

    const ElasticModuli<T> moduli = law.moduli(point->history);
    const SymmetricTensor<T> g = gradient_product(b, scaled_inverse_volume);
    const T trace_g = trace(g);
    const T inverse_mass = 1.0 / header.mass;
    const SolidSpectrum<T> spectrum = solid_spectrum(moduli, g, volume.end * inverse_mass);
    const T reference_frequency = sqrt(spectrum.reference);
    const T dilatation_rate = middle_dilatation_rate(n, half_step, scaled_inverse_volume * trace(scaled_l));
    const BulkViscosity<T> viscosity =
        bulk_viscosity(linear_bulk_viscosity, quadratic_bulk_viscosity, dilatation_rate, trace_g,
                       header.mass * (scaled_inverse_volume / gradient_scale), reference_frequency);
    increment.viscous_energy = -(header.viscous_pressure + viscosity.pressure) * trace(n) * volume.middle;
    header.viscous_pressure = viscosity.pressure;

    const T distortion = hourglass_distortion(x, g);
    const HourglassModuli<T> stiffness =
        brio::hourglass_stiffness(hourglass_stiffness, moduli, volume.end, distortion);
    const HourglassAxes<T> edges = hourglass_axes(b, scaled_inverse_volume);
    HourglassScale<T>& scale = header.hourglass.scale;
    const HourglassScale<T> old_scale = scale;
    scale = hourglass_scale(stiffness);
    const SpringChange<T> change = spring_change(old_scale.stiffness, scale.stiffness);
    // As the gradients, displacements of the middle follow from those on the end configuration.
    HourglassVectors<T> q = hourglass_motion(x, v, half_step, half_l);
    for (Vector3<T>& mode : q.mode) mode = T(2.0) * (mode + turned(n, mode));
    const HourglassStrain<T> growth =
        hourglass_strain(centered(edges, n), change.growth, 0.5 * (old_scale.twist + scale.twist), q);
    const HourglassWork<T> hourglass =
        resist_hourglass_motion(law, *point, point_step, axes, moduli.shear, stiffness.bending, volume.end,
                                change.carried, growth, header.hourglass);
    increment.hourglass_energy = hourglass.stored;
    increment.internal_energy += hourglass.dissipated;
    header.internal_energy += increment.internal_energy;
    q = hourglass_forces(edges, header.hourglass);
    T damping = viscosity.damping;
    if (hourglass_viscosity > 0) {
      const T resistance =
          (0.25 * hourglass_viscosity) * header.mass * reference_frequency / (8.0 + distortion);
      const T power =
          resist_hourglass(hourglass_motion(x, v, T(1.0), scaled_inverse_volume * scaled_l), resistance, q);
      increment.viscous_energy += step * power;
      damping += 8.0 * inverse_mass * resistance * largest_gamma(distortion);
    }
    const SymmetricTensor<T> stress = fixed_stress(*point, axes) - isotropic(viscosity.pressure);
    nodal_forces(x, b, stress, q, scaled_inverse_volume, forces);
    const T frequency_squared = spectrum.uniform + (8.0 * hourglass_overlap) * inverse_mass *
                                                       stiffness.bending * largest_eigenvalue_bound(g) *
                                                       distortion;
    increment.frequency_squared = frequency_squared;
    increment.strain_rate_squared = strain_rate_squared(scaled_l, scaled_inverse_volume);
    increment.stable_step = where(volume.is_valid, damped_stable_step(frequency_squared, damping), T(-1.0));
    return increment;
  }

  /// Hourglass stress yields with the stress of the integration point: it is reduced by the ratio by which
  /// the radial return reduces the deviatoric stress, and limited to that of a fully plastic section. While
  /// the point yields, only a part of the hourglass strain increment is elastic; unloading is elastic. Work
  /// that is not stored is plastic work. Where no lane of a pack yields, plasticity costs nothing. \param
  /// carried of the strain of the last step (SpringChange)
  template <class T, class Law>
  BRIO_INLINE HourglassWork<T> resist_hourglass_motion(const Law& law, const Point<T, Law>& point,
                                                       const PointStep<T>& step, const MaterialAxes<T>& axes,
                                                       T shear, T bending, T volume, T carried,
                                                       const HourglassStrain<T>& growth,
                                                       HourglassState<T>& state) const {
    const T stiffness = state.scale.stiffness;
    if constexpr (!has_yield_stress<Law>) {
      return {stiffness * stretch_hourglass(state.strain, carried, growth, T(1.0)), T(0.0)};
    } else {
      const T old_energy = square(carried) * stored_energy(state);
      const auto hardening = law.hardening();
      const T plastic_strain = point.history.equivalent_plastic_strain;
      const MaskOf<T> has_yielded = plastic_strain > step.old_plastic_strain;
      T share(1.0);
      if (any(has_yielded)) {
        const MaskOf<T> grows = has_yielded & (dot(state.strain, growth) >= T(0.0));
        share = where(grows, T(hourglass_share_in_flow(hourglass_stiffness)), T(1.0));
      }
      const T elastic_work = stiffness * stretch_hourglass(state.strain, carried, growth, share);
      const T trial_energy = stored_energy(state);
      const T at_first_yield =
          hourglass_energy_at_yield(T(hardening.initial_yield_stress()), volume, bending);
      const bool any_yields = any(trial_energy > at_first_yield);
      if (any(has_yielded) || any_yields) {
        T left = return_ratio(step.old_stress, point.stress, T(2.0) * axes.half_strain, shear, has_yielded);
        if (any_yields) {
          const T most =
              hourglass_energy_at_yield(point_of(hardening, point.history).stress, volume, bending);
          const MaskOf<T> yields = trial_energy > most;
          left *= where(yields, sqrt(most / where(yields, trial_energy, T(1.0))), T(1.0));
        }
        const T work = elastic_work - stiffness * shrink_hourglass(state.strain, left, growth);
        const T stored = square(left) * trial_energy - old_energy;
        return {stored, work - stored};
      }
      return {elastic_work, T(0.0)};
    }
  }

  template <class Law>
  ElementSample sample(const NodalMotion<double, 8>&, const Law&, const Header<double, Law>& header,
                       const Point<double, Law>* point) const {
    return {.stress = fixed_stress(*point), .internal_energy = header.internal_energy};
  }
  template <class Law>
  void complete(const NodalMotion<double, 8>& motion, const Header<double, Law>& header,
                const Point<double, Law>*, ElementSample& sample) const {
    sample.hourglass_energy = stored_energy(header.hourglass);
    sample.volume = mean_gradient(modes(motion.position)).volume;
  }
};

}  // namespace brio
