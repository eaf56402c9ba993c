#pragma once
/// A particle as an integration point: from the sums over its neighbours to its stress and pair forces.
/// As in the hexahedron, the velocity gradient is taken on the configuration at the end of the step; that of
/// the middle follows exactly for affine motion.

#include <cmath>

#include "elements/particle/particle.hpp"
#include "elements/particle/particle_cloud.hpp"
#include "materials/hardening.hpp"

namespace brio {

/// Motion of a neighbourhood, of lanes T.
template <class T>
struct ParticleMotion {
  Tensor<T> gradient;       ///< F
  Tensor<T> gradient_rate;  ///< of F
  Tensor<T> cofactor;       ///< det F F^-T
  T jacobian;               ///< det F
  SymmetricTensor<T> correction;
  T volume;             ///< at the start
  T spacing;            ///< its cube root
  T hourglass_weight;   ///< by which a modulus makes k
  T residual_power;     ///< sum of s e.v
  T residual_rate;      ///< sum of s times the rate of e squared
  T frequency_squared;  ///< bound for the initial moduli
  T weight;             ///< sum of s, updated-Lagrangian kernel
  // Likewise:
  Tensor<T> middle_gradient;    ///< L of the middle of the step
  Tensor<T> residual_gradient;  ///< L of residual velocities
  SymmetricTensor<T> share;     ///< S of particle_support.hpp
};

template <class T>
BRIO_INLINE Tensor<T> cofactors(const Tensor<T>& a) {
  const auto& m = a.m;
  return {{{m[1][1] * m[2][2] - m[1][2] * m[2][1], m[1][2] * m[2][0] - m[1][0] * m[2][2],
            m[1][0] * m[2][1] - m[1][1] * m[2][0]},
           {m[0][2] * m[2][1] - m[0][1] * m[2][2], m[0][0] * m[2][2] - m[0][2] * m[2][0],
            m[0][1] * m[2][0] - m[0][0] * m[2][1]},
           {m[0][1] * m[1][2] - m[0][2] * m[1][1], m[0][2] * m[1][0] - m[0][0] * m[1][2],
            m[0][0] * m[1][1] - m[0][1] * m[1][0]}}};
}
/// a b^T
template <class T>
BRIO_INLINE Tensor<T> times_transposed(const Tensor<T>& a, const Tensor<T>& b) {
  Tensor<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c.m[i][j] = a.m[i][0] * b.m[j][0] + a.m[i][1] * b.m[j][1] + a.m[i][2] * b.m[j][2];
  return c;
}

/// A particle without support stands still: F = I.
template <class T>
BRIO_INLINE ParticleMotion<T> particle_motion(const Tensor<T>& x_sum, const Tensor<T>& v_sum, T xv_sum,
                                              T vv_sum, const SymmetricTensor<T>& correction) {
  const Tensor<T> k = full(correction);
  ParticleMotion<T> motion;
  const MaskOf<T> has_support = trace(correction) > T(0.0);
  motion.gradient = x_sum * k;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      motion.gradient.m[i][j] = where(has_support, motion.gradient.m[i][j], T(i == j ? 1.0 : 0.0));
  motion.gradient_rate = v_sum * k;
  motion.cofactor = cofactors(motion.gradient);
  motion.jacobian = motion.gradient.m[0][0] * motion.cofactor.m[0][0] +
                    motion.gradient.m[0][1] * motion.cofactor.m[0][1] +
                    motion.gradient.m[0][2] * motion.cofactor.m[0][2];
  motion.correction = correction;
  motion.residual_power = xv_sum - contract(motion.gradient, v_sum);
  motion.residual_rate = vv_sum - contract(motion.gradient_rate, v_sum);
  return motion;
}

/// A, and k; L and the viscosity of residual velocities.
template <class T>
struct ParticleForces {
  Tensor<T> a, residual;
  T stiffness, viscosity;
  T power;  ///< of the forces that the particle's own energy exerts
};

struct ParticleKernel;
template <class T>
struct SeenByKernel<ParticleKernel, T> {
  using Motion = ParticleMotion<T>;
  using Forces = ParticleForces<T>;
};

struct ParticleKernel : Particle {
  using Settings = Particle;
  static constexpr KernelTraits kernel_traits{.bounded_alone = false};
  static constexpr int most_points = 1;
  static constexpr int points() { return 1; }
  static double point_size(double volume) { return edge_of_cube(volume); }

  template <class T, class Law>
  struct Header {
    T mass;
    T internal_energy;
    T viscous_pressure;  ///< of the last step
    T hourglass_energy;
    T hourglass_stiffness;  ///< of the last step
    T volume;               ///< at the end of the last step
    T stiffness_at_start;   ///< lambda + 2 mu
  };
  template <class T, class Law>
  using Point = SolidPoint<T, Law, ObjectiveRate::green_naghdi>;

  template <class T>
  static BRIO_INLINE T youngs_modulus(const ElasticModuli<T>& moduli) {
    return moduli.shear * (3.0 * moduli.first_lame + 2.0 * moduli.shear) / (moduli.first_lame + moduli.shear);
  }

  /// N of the middle of the step, and the volumes: from F at the end; or, with the updated-Lagrangian kernel,
  /// whose weights change within the step, from L of the middle itself.
  template <class T>
  BRIO_INLINE StepVolume<T> end_of_step(const ParticleMotion<T>& motion, T half_step, const Tensor<T>& l,
                                        T last_volume, Tensor<T>& n) const {
    T shrinking, stretching;
    if (!is_eulerian()) {
      n = centered(half_step * l, shrinking);
      return step_volume(motion.volume * motion.jacobian, shrinking);
    }
    n = half_step * motion.middle_gradient;
    centered(n, shrinking);
    centered(T(-1.0) * n, stretching);
    const MaskOf<T> is_valid = (shrinking > T(0.0)) & (stretching > T(0.0));
    const T middle = last_volume / where(is_valid, shrinking, T(1.0));
    return {middle * where(is_valid, stretching, T(1.0)), middle, is_valid};
  }

  /// The modulus of the stabilization is reduced when the material yields: with the yield stress Y and the
  /// plastic strain p it is the secant modulus Y / (Y/E + p).
  template <class T, class Law>
  static BRIO_INLINE T secant_modulus(const Law& law, T modulus,
                                      const typename Law::template History<T>& history) {
    if constexpr (has_yield_stress<Law>) {
      const T plastic_strain = history.equivalent_plastic_strain;
      const T yield_stress = point_of(law.hardening(), history).stress;
      return modulus * yield_stress / (yield_stress + modulus * plastic_strain);
    }
    return modulus;
  }

  /// Force per residual motion.
  template <class T, class Law>
  BRIO_INLINE T residual_stiffness(const Law& law, const ElasticModuli<T>& moduli, const Point<T, Law>& point,
                                   T volume, T weight) const {
    return stiffness_share() * secant_modulus(law, youngs_modulus(moduli), point.history) * volume * weight;
  }

  /// \param motion of it the volume and the weight against residual motions
  template <class T, class Law>
  NodalMass<T> initialize(const ParticleMotion<T>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>* point) const {
    header.volume = motion.volume;
    header.mass = T(law.density) * header.volume;
    start(*point);
    const ElasticModuli<T> moduli = law.moduli(point->history);
    header.stiffness_at_start = moduli.first_lame + 2.0 * moduli.shear;
    header.hourglass_stiffness =
        residual_stiffness(law, moduli, *point, header.volume, motion.hourglass_weight);
    return {header.mass, T(0.0)};
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const ParticleMotion<T>& motion, T step, const Law& law,
                                 Header<T, Law>& header, Point<T, Law>* point,
                                 ParticleForces<T>& forces) const {
    const T half_step = 0.5 * step;
    const MaskOf<T> is_upright = motion.jacobian > T(0.0);
    const T jacobian = where(is_upright, motion.jacobian, T(1.0));
    const Tensor<T> l = (1.0 / jacobian) * times_transposed(motion.gradient_rate, motion.cofactor);
    Tensor<T> n;
    const StepVolume<T> volume = end_of_step(motion, half_step, l, header.volume, n);
    header.volume = volume.end;
    const MaterialAxes<T> axes = follow(n, point->stress, point->rotation);
    Increment<T> increment;
    increment.internal_energy = volume.middle * update(law, axes, *point).work;

    const ElasticModuli<T> moduli = law.moduli(point->history);
    const T stiffness = moduli.first_lame + 2.0 * moduli.shear;
    const T density = header.mass / volume.end;
    const T sound_speed = sqrt(stiffness / density);
    const T dilatation_rate = middle_dilatation_rate(n, half_step, trace(l));
    const T linear = linear_bulk_viscosity * motion.spacing * sound_speed;
    const T compression = max(-dilatation_rate, T(0.0));
    const T quadratic = square(quadratic_bulk_viscosity * motion.spacing) * compression;
    const T pressure = density * (quadratic * compression - linear * dilatation_rate);
    increment.viscous_energy = -(header.viscous_pressure + pressure) * trace(n) * volume.middle;
    header.viscous_pressure = pressure;

    // A stiffness that grew would supply energy. What the control had stored shrinks with it: that is lost
    // like plastic work.
    const T old_stiffness = header.hourglass_stiffness;
    forces.stiffness =
        min(residual_stiffness(law, moduli, *point, motion.volume, motion.hourglass_weight), old_stiffness);
    header.hourglass_stiffness = forces.stiffness;
    const T old_power = motion.residual_power - step * motion.residual_rate;
    const T lost = old_stiffness - forces.stiffness;
    const T dissipated =
        lost / where(old_stiffness > T(0.0), old_stiffness, T(1.0)) * header.hourglass_energy;
    increment.hourglass_energy =
        half_step * forces.stiffness * (motion.residual_power + old_power) - dissipated;
    increment.internal_energy += dissipated + half_step * lost * old_power;
    header.hourglass_energy += increment.hourglass_energy;
    header.internal_energy += increment.internal_energy;

    // V P = V sigma cof F of the volume V that F is of.
    const SymmetricTensor<T> stress =
        fixed_stress<ObjectiveRate::green_naghdi>(point->stress, axes) - isotropic(pressure);
    const T volume_of_reference = is_eulerian() ? volume.end : motion.volume;
    Tensor<T> force_tensor = volume_of_reference * (full(stress) * motion.cofactor);
    if (is_eulerian()) force_tensor = full(motion.share) * force_tensor;
    forces.power = contract(force_tensor, motion.gradient_rate) + forces.stiffness * motion.residual_power;
    forces.a = force_tensor * full(motion.correction);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) forces.a.m[i][j] -= forces.stiffness * motion.gradient.m[i][j];
    forces.viscosity =
        viscosity_share() * density * sound_speed * motion.spacing * volume.end * motion.hourglass_weight;
    forces.residual = forces.viscosity * motion.residual_gradient;

    // A quadratic form of gradients on the present configuration, (lambda + 2 mu) V |grad u|^2, over that at
    // the start is at most the ratio of the moduli times det F times the largest eigenvalue of F^-1 F^-T.
    const Tensor<T>& c = motion.cofactor;
    const auto entry = [&](int i, int j) {
      return c.m[0][i] * c.m[0][j] + c.m[1][i] * c.m[1][j] + c.m[2][i] * c.m[2][j];
    };
    const SymmetricTensor<T> g{entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)};
    const T growth = stiffness * largest_eigenvalue_bound(g) * (volume_of_reference / motion.volume) /
                     (header.stiffness_at_start * jacobian);
    const T frequency_squared = motion.frequency_squared * max(growth, T(1.0));
    // sum s |v_j - v_i|^2 <= 2 sum s (v_j^2 + v_i^2), as one of two in every pair.
    const T damping = frequency_squared * (linear + quadratic) / square(sound_speed) +
                      4.0 * forces.viscosity * motion.weight / header.mass;
    increment.frequency_squared = frequency_squared;
    increment.strain_rate_squared = T(0.0);
    increment.stable_step = where(volume.is_valid, damped_stable_step(frequency_squared, damping), T(-1.0));
    return increment;
  }

  template <class Law>
  ElementSample sample(const NodalMotion<double, 1>&, const Law&, const Header<double, Law>& header,
                       const Point<double, Law>* point) const {
    return {.stress = fixed_stress(*point),
            .internal_energy = header.internal_energy,
            .hourglass_energy = header.hourglass_energy,
            .volume = header.volume,
            .radius = 0.5 * edge_of_cube(header.volume),
            .density = header.mass / header.volume};
  }
};

}  // namespace brio
