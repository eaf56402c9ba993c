#pragma once
/// Eight-node hexahedron with one integration point (Flanagan & Belytschko 1981), for one objective rate.
///
/// The gradient is taken once, on the configuration at the end of the step: L_end. The velocity gradient of
/// the middle follows exactly for affine motion, so that a rigid rotation of any size strains nothing, and so
/// does the volume of the middle, V_mid = V det(I - dt/2 L_end). Forces are V sigma B at the end; the work
/// booked is V_mid (sigma_old + sigma_new)/2 : D dt, which differs from the work of the forces by third order
/// in the step.

#include "elements/hex8.hpp"
#include "elements/hourglass.hpp"
#include "elements/mean_gradient.hpp"

namespace brio {

/// Rotation state of an element: none for Jaumann.
template <class T, ObjectiveRate rate>
struct RotationState {
  StretchAndRotation<T> axes;
};
template <class T>
struct RotationState<T, ObjectiveRate::jaumann> {};

template <ObjectiveRate rate>
struct Hex8Kernel : Hex8 {
  using Settings = Hex8;
  static constexpr int points() { return 1; }
  static constexpr bool is_unrotated = rate == ObjectiveRate::green_naghdi;
  template <class Law>
  static constexpr bool accepts = RateLaw<Law> || (is_unrotated && StretchLaw<Law>);

  template <class T, class Law>
  struct Header {
    T mass;
    T internal_energy;
    T viscous_pressure;             ///< of the last step
    HourglassVectors<T> hourglass;  ///< generalized forces, on the axes of the stress
    [[no_unique_address]] RotationState<T, rate> rotation;
  };
  template <class T, class Law>
  using Point = SolidPoint<T, Law>;

  template <class T, class Law>
  NodalMass<T> initialize(const NodalMotion<T, 8>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>*) const {
    header.mass = T(law.density) * mean_gradient(modes(motion.position)).volume;
    if constexpr (is_unrotated) {
      header.rotation.axes.stretch = isotropic(T(1.0));
      header.rotation.axes.rotation = {T(1.0), T(0.0), T(0.0), T(0.0)};
    }
    return {header.mass * 0.125, T(0.0)};
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
    const Tensor<T> l = gradient_of(v, b, scaled_inverse_volume);
    T determinant;
    const Tensor<T> n = centered(half_step * l, determinant);
    const StepVolume<T> volume = step_volume(b.volume, determinant);

    HourglassVectors<T> hourglass_rate = hourglass_rates(x, v, l);
    const MaterialAxes<T> axes = follow_rotation(header, *point, n, hourglass_rate);
    Increment<T> increment;
    increment.internal_energy = volume.middle * update_stress(law, axes, header, *point);
    header.internal_energy += increment.internal_energy;

    const ElasticModuli<T> moduli = law.moduli(point->history);
    const SymmetricTensor<T> g = gradient_product(b, scaled_inverse_volume);
    const T trace_g = trace(g);
    const SolidSpectrum<T> spectrum = solid_spectrum(moduli, g, volume.end / header.mass);
    const T reference_frequency = sqrt(spectrum.reference);
    const T trace_l = l.m[0][0] + l.m[1][1] + l.m[2][2];
    const BulkViscosity<T> viscosity =
        bulk_viscosity(linear_bulk_viscosity, quadratic_bulk_viscosity, trace_l, trace_g,
                       header.mass / volume.end, reference_frequency);
    increment.viscous_energy =
        -(header.viscous_pressure + viscosity.pressure) * (n.m[0][0] + n.m[1][1] + n.m[2][2]) * volume.middle;
    header.viscous_pressure = viscosity.pressure;

    const HourglassOverlap<T> overlap = hourglass_overlap(x, b, g, scaled_inverse_volume);
    const T stiffness = brio::hourglass_stiffness(hourglass_stiffness, moduli.first_lame, moduli.shear,
                                                  volume.end, trace_g, overlap.projection);
    const T resistance =
        hourglass_viscosity * header.mass * reference_frequency * (0.25 / (8.0 + overlap.projection));
    HourglassVectors<T> q =
        update_hourglass(header, hourglass_rate, stiffness, resistance, half_step, increment);

    SymmetricTensor<T> stress = point->stress;
    if constexpr (is_unrotated) {
      stress = turned(axes.end, stress);
      for (Vector3<T>& mode : q.mode) mode = turned(axes.end, mode);
    }
    stress = stress - isotropic(viscosity.pressure);
    nodal_forces(x, b, stress, q, scaled_inverse_volume, forces);
    increment.stable_step =
        stable_step(moduli, spectrum, viscosity.damping, overlap, stiffness, resistance, volume, header.mass);
    return increment;
  }

  template <class Law>
  ElementSample sample(const NodalMotion<double, 8>&, const Law&, const Header<double, Law>& header,
                       const Point<double, Law>* point) const {
    ElementSample result{.stress = point->stress,
                         .equivalent_plastic_strain = equivalent_plastic_strain_of(*point),
                         .internal_energy = header.internal_energy};
    if constexpr (is_unrotated)
      result.stress = turned(rotation_matrix(header.rotation.axes.rotation, 2.0), point->stress);
    return result;
  }

 private:
  /// Turns the state, and hourglass rates to the axes on which their forces are kept.
  template <class T, class Law>
  static BRIO_INLINE MaterialAxes<T> follow_rotation(Header<T, Law>& header, Point<T, Law>& point,
                                                     const Tensor<T>& n,
                                                     HourglassVectors<T>& hourglass_rate) {
    if constexpr (is_unrotated) {
      const MaterialAxes<T> axes = advance(header.rotation.axes, n);
      for (Vector3<T>& mode : hourglass_rate.mode) mode = turned_back(axes.middle, mode);
      return axes;
    } else {
      const MaterialAxes<T> axes = turn_with_spin(n);
      const Vector3<T> w = spin_vector(n);
      point.stress = turned(axes.end, point.stress);
      if constexpr (requires { point.history.back_stress; })
        point.history.back_stress = turned(axes.end, point.history.back_stress);
      for (int a = 0; a < hourglass_modes; ++a) {
        header.hourglass.mode[a] = turned(axes.end, header.hourglass.mode[a]);
        hourglass_rate.mode[a] = hourglass_rate.mode[a] + cross(w, hourglass_rate.mode[a]);
      }
      return axes;
    }
  }

  /// Stress at the end of the step; returns the work per volume of the middle.
  template <class T, class Law>
  static BRIO_INLINE T update_stress(const Law& law, const MaterialAxes<T>& axes, Header<T, Law>& header,
                                     Point<T, Law>& point) {
    const SymmetricTensor<T> old_stress = point.stress;
    if constexpr (RateLaw<Law>) {
      law.update(T(2.0) * axes.half_strain, point.stress, point.history);
    } else {
      law.update_from_stretch(header.rotation.axes.stretch, point.stress, point.history);
    }
    return contract(old_stress + point.stress, axes.half_strain);
  }

  /// Generalized hourglass forces, elastic and viscous together; the elastic ones are kept.
  template <class T, class Law>
  static BRIO_INLINE HourglassVectors<T> update_hourglass(Header<T, Law>& header,
                                                          const HourglassVectors<T>& rates, T stiffness,
                                                          T resistance, T half_step,
                                                          Increment<T>& increment) {
    HourglassVectors<T> q;
    T elastic_work(0.0), viscous_power(0.0);
    const T twice_stiffness = 2.0 * stiffness;
    for (int a = 0; a < hourglass_modes; ++a) {
      const Vector3<T> half_displacement = half_step * rates.mode[a];
      const Vector3<T> old_force = header.hourglass.mode[a];
      const Vector3<T> new_force = old_force + twice_stiffness * half_displacement;
      elastic_work += dot(old_force + new_force, half_displacement);
      viscous_power += dot(rates.mode[a], rates.mode[a]);
      header.hourglass.mode[a] = new_force;
      q.mode[a] = new_force + resistance * rates.mode[a];
    }
    increment.hourglass_energy = elastic_work;
    increment.viscous_energy += 2.0 * half_step * resistance * viscous_power;
    return q;
  }

  template <class T>
  static BRIO_INLINE void nodal_forces(const HexahedronModes<T>& x, const MeanGradient<T>& b,
                                       const SymmetricTensor<T>& stress, const HourglassVectors<T>& q,
                                       T scaled_inverse_volume, NodalForces<T, 8>& forces) {
    T t[3][3] = {{gradient_scale * stress.xx, gradient_scale * stress.xy, gradient_scale * stress.xz},
                 {gradient_scale * stress.xy, gradient_scale * stress.yy, gradient_scale * stress.yz},
                 {gradient_scale * stress.xz, gradient_scale * stress.yz, gradient_scale * stress.zz}};
    const auto component = [](const Vector3<T>& a, int i) { return i == 0 ? a.x : i == 1 ? a.y : a.z; };
    for (int i = 0; i < 3; ++i) {
      Vector3<T> drag{T(0.0), T(0.0), T(0.0)};
      for (int a = 0; a < hourglass_modes; ++a) drag = drag + component(q.mode[a], i) * x.hourglass(a);
      const Vector3<T> row{t[i][0] - scaled_inverse_volume * drag.x, t[i][1] - scaled_inverse_volume * drag.y,
                           t[i][2] - scaled_inverse_volume * drag.z};
      T s[hexahedron_modes];
      for (int m = 0; m < gradient_modes; ++m) s[m] = dot(row, b.beta[m]);
      for (int a = 0; a + linear_modes < gradient_modes; ++a) s[linear_modes + a] += component(q.mode[a], i);
      s[hexahedron_modes - 1] = component(q.mode[hourglass_modes - 1], i);
      corner_values(s, forces.force[i]);
    }
  }

  /// The uniform strains (stiffness a) and the hourglass modes (stiffness b) of a distorted brick share
  /// displacements; two positive matrices whose product of roots is bounded by c have a sum bounded by (a + b
  /// + sqrt((a - b)^2 + 4 c^2)) / 2.
  template <class T>
  static BRIO_INLINE T stable_step(const ElasticModuli<T>& moduli, const SolidSpectrum<T>& spectrum,
                                   T damping, const HourglassOverlap<T>& overlap, T stiffness, T resistance,
                                   const StepVolume<T>& volume, T mass) {
    const T inverse_nodal_mass = 8.0 / mass;
    // |gamma| is at most |Gamma| and its subtracted part: (sqrt(8) + sqrt(p))^2 <= 2 (8 + p)
    const T twice_gamma = 2.0 * (8.0 + overlap.projection);
    const T b = inverse_nodal_mass * stiffness * twice_gamma;
    const T bulk = max(3.0 * moduli.first_lame, T(0.0)) + 2.0 * moduli.shear;
    const T c_squared = square(inverse_nodal_mass) * stiffness * volume.end * bulk * overlap.coupling;
    const T a = spectrum.uniform;
    const T bound = 0.5 * (a + b + sqrt(square(a - b) + 4.0 * c_squared));
    const T total_damping = damping + inverse_nodal_mass * resistance * twice_gamma;
    return where(volume.is_valid, damped_stable_step(bound, total_damping), T(-1.0));
  }
};

}  // namespace brio
