#pragma once
/// Hourglass control of the one-point hexahedron (Flanagan & Belytschko 1981): forces along
/// gamma_aI = Gamma_aI - x_a . B_I, which are zero in rigid and linear motion. gamma is never formed: with
/// sums against the base vectors (mean_gradient.hpp), gamma_a . v = v_a - L x_a, and the force of a
/// generalized force Q_a is Q_a on pattern a together with the stress - sum_a Q_a (x) x_a / V on the mean
/// gradient.

#include "elements/base/changing_spring.hpp"
#include "elements/base/motion.hpp"
#include "elements/solid/mean_gradient.hpp"

namespace brio {

/// One vector for each base vector.
template <class T>
struct HourglassVectors {
  Vector3<T> mode[hourglass_modes];
};

template <class T>
BRIO_INLINE T dot(const HourglassVectors<T>& a, const HourglassVectors<T>& b) {
  T sum(0.0);
  for (int i = 0; i < hourglass_modes; ++i) sum += dot(a.mode[i], b.mode[i]);
  return sum;
}

/// The sums of a field against the hourglass base vectors.
template <class T>
BRIO_INLINE HourglassVectors<T> hourglass_sums(const HexahedronModes<T>& field) {
  HourglassVectors<T> sums;
  for (int a = 0; a < hourglass_modes; ++a) sums.mode[a] = field.sum[linear_modes + a];
  return sums;
}

/// gamma . v for each mode. \param l mean gradient of v on the configuration of x
template <class T>
BRIO_INLINE HourglassVectors<T> hourglass_rate(const HourglassVectors<T>& x, const HourglassVectors<T>& v,
                                               const Tensor<T>& l) {
  HourglassVectors<T> rate;
  for (int a = 0; a < hourglass_modes; ++a) rate.mode[a] = v.mode[a] - turned(l, x.mode[a]);
  return rate;
}

/// p = sum_a x_a . G x_a, dimensionless: what is subtracted from the base vectors to form gamma. It measures
/// distortion and is zero for a parallelepiped.
template <class T>
BRIO_INLINE T hourglass_distortion(const HourglassVectors<T>& x, const SymmetricTensor<T>& g) {
  SymmetricTensor<T> c = isotropic(T(0.0));
  for (const Vector3<T>& xa : x.mode) {
    c.xx += xa.x * xa.x;
    c.yy += xa.y * xa.y;
    c.zz += xa.z * xa.z;
    c.xy += xa.x * xa.y;
    c.yz += xa.y * xa.z;
    c.xz += xa.x * xa.z;
  }
  return contract(c, g);
}

/// |gamma|^2 of any mode is at most (|Gamma| + sqrt(p))^2 <= 2 (8 + p).
template <class T>
BRIO_INLINE T largest_gamma(T distortion) {
  return 2.0 * (8.0 + distortion);
}

/// Factor on the distortion by which hourglass stiffness may raise the frequencies of uniform strains. For p
/// >= 8 a factor of 4 is enough because (sqrt(8) + sqrt(p))^2 <= 4 p; below, the two stiffnesses overlap in
/// proportion to p, and the tests compare the factor with assembled stiffness matrices.
inline constexpr double hourglass_overlap = 6;

/// Moduli times a volume: S_b for bending, the modulus of plane-strain bending 4 mu (lambda + mu) /
/// (lambda + 2 mu), which stays finite for incompressible materials; S_t for twist, mu.
template <class T>
struct HourglassModuli {
  T bending, twist;
};

/// With the coefficient 1/9 a box bends exactly; distorted bricks get less, so that |gamma| does not raise
/// the frequency. That of bending squared is at most 24 `coefficient` times 8 V / m g times the modulus, g
/// the largest eigenvalue of G, and in the range of the coefficient below that of the uniform strains, 16 mu
/// g (solid.hpp).
template <class T>
BRIO_INLINE HourglassModuli<T> hourglass_stiffness(double coefficient, const ElasticModuli<T>& moduli,
                                                   T volume, T distortion) {
  const T scaled_volume = 3.0 * coefficient * volume / (8.0 + distortion);
  return {scaled_volume * (4.0 * moduli.shear * (moduli.first_lame + moduli.shear) /
                           (moduli.first_lame + 2.0 * moduli.shear)),
          scaled_volume * moduli.shear};
}

/// Rates of hourglass strain in twelve components, one for each base vector a and edge direction k, of the
/// displacement q_a: n_k . q_a with n_k = beta_k / (64 V), which of a box is one over four edges along edge
/// k. They are zero in rotation.
///
/// Each component has the stiffness of its own direction, as in an assumed-strain element (Belytschko &
/// Bindeman 1993): the bending of a flat brick is resisted over its length, not over its thickness. For k = a
/// pattern a strains no fibre but shears: eta zeta along the normal of the faces xi = +-1, and so on. Three
/// such motions a_k, u_k = a_k x_l x_m, shear a box of edges L_k by gamma_kl = (a_k + a_l) x_m and store mu V
/// / 24 times the sum of L_m^2 (a_k + a_l)^2: entry [m][m] is the twist a_k + a_l with its length. Taken one
/// by one the a_k would lock: in the twist of a thin wall all shears cancel but the one that varies over the
/// thickness.
template <class T>
struct HourglassStrain {
  T entry[hourglass_modes][linear_modes];
};

template <class T>
BRIO_INLINE T dot(const HourglassStrain<T>& a, const HourglassStrain<T>& b) {
  T sum(0.0);
  for (int i = 0; i < hourglass_modes; ++i)
    for (int k = 0; k < linear_modes; ++k) sum += a.entry[i][k] * b.entry[i][k];
  return sum;
}

/// Edge directions of a configuration: n_k, and |n_k|, 1 where it vanishes.
template <class T>
struct HourglassAxes {
  Vector3<T> normal[linear_modes];
  T length[linear_modes];
};

template <class T>
BRIO_INLINE HourglassAxes<T> hourglass_axes(const MeanGradient<T>& b, T scaled_inverse_volume) {
  HourglassAxes<T> axes;
  for (int k = 0; k < linear_modes; ++k) {
    axes.normal[k] = scaled_inverse_volume * b.beta[k];
    const T squared = dot(axes.normal[k], axes.normal[k]);
    axes.length[k] = sqrt(where(squared > T(0.0), squared, T(1.0)));
  }
  return axes;
}

/// The axes of the middle of the step: n_k follows F^-T, and one step of Newton's method its length.
/// \param n dt/2 times the velocity gradient of the middle.
template <class T>
BRIO_INLINE HourglassAxes<T> centered(const HourglassAxes<T>& end, const Tensor<T>& n) {
  HourglassAxes<T> middle;
  for (int k = 0; k < linear_modes; ++k) {
    middle.normal[k] = end.normal[k] + turned_back(n, end.normal[k]);
    const T squared = dot(middle.normal[k], middle.normal[k]);
    middle.length[k] = 0.5 * (end.length[k] + squared / end.length[k]);
  }
  return middle;
}

/// Stiffness of the hourglass strains, and the factor of twists by which it is that of twists too.
template <class T>
struct HourglassScale {
  T stiffness;  ///< 8 times that of bending
  T twist;      ///< root of the ratio of the moduli
};

template <class T>
BRIO_INLINE HourglassScale<T> hourglass_scale(const HourglassModuli<T>& moduli) {
  const MaskOf<T> resists = moduli.bending > T(0.0);
  return {max(8.0 * moduli.bending, T(0.0)),
          sqrt(max(moduli.twist, T(0.0)) / where(resists, moduli.bending, T(1.0)))};
}

/// Hourglass strains and stiffness, part of the state of an element.
template <class T>
struct HourglassState {
  HourglassStrain<T> strain;
  HourglassScale<T> scale;  ///< of the end of the last step
};

template <class T>
BRIO_INLINE T stored_energy(const HourglassState<T>& state) {
  return (0.5 * state.scale.stiffness) * dot(state.strain, state.strain);
}

/// Work of one step against the elastic hourglass forces; plastic work is dissipated.
template <class T>
struct HourglassWork {
  T stored, dissipated;
};

/// Strains of hourglass displacements, by a factor.
template <class T>
BRIO_INLINE HourglassStrain<T> hourglass_strain(const HourglassAxes<T>& axes, T factor, T twist,
                                                const HourglassVectors<T>& q) {
  HourglassStrain<T> strain;
  T along[linear_modes];
  for (int a = 0; a < hourglass_modes; ++a)
    for (int k = 0; k < linear_modes; ++k) {
      const T component = factor * dot(axes.normal[k], q.mode[a]);
      if (a == k)
        along[k] = component;
      else
        strain.entry[a][k] = component;
    }
  for (int m = 0; m < linear_modes; ++m) {
    const int k = (m + 1) % linear_modes, l = (m + 2) % linear_modes;
    strain.entry[m][m] =
        twist * (axes.length[l] / axes.length[k] * along[k] + axes.length[k] / axes.length[l] * along[l]);
  }
  return strain;
}

/// Generalized forces of the strains: stiffness times the transpose of hourglass_strain.
template <class T>
BRIO_INLINE HourglassVectors<T> hourglass_forces(const HourglassAxes<T>& axes,
                                                 const HourglassState<T>& state) {
  const T twist = state.scale.stiffness * state.scale.twist;
  HourglassVectors<T> force;
  T along[linear_modes] = {T(0.0), T(0.0), T(0.0)};
  for (int m = 0; m < linear_modes; ++m) {
    const int k = (m + 1) % linear_modes, l = (m + 2) % linear_modes;
    const T shear = twist * state.strain.entry[m][m];
    along[k] += shear * (axes.length[l] / axes.length[k]);
    along[l] += shear * (axes.length[k] / axes.length[l]);
  }
  for (int a = 0; a < hourglass_modes; ++a) {
    force.mode[a] = {T(0.0), T(0.0), T(0.0)};
    for (int k = 0; k < linear_modes; ++k)
      force.mode[a] = force.mode[a] +
                      (a == k ? along[k] : state.scale.stiffness * state.strain.entry[a][k]) * axes.normal[k];
  }
  return force;
}

/// Rescales the strains of the last step to the present stiffness and adds the increment. \return the work
/// over stiffness.
template <class T>
BRIO_INLINE T stretch_hourglass(HourglassStrain<T>& strain, T carried, const HourglassStrain<T>& growth,
                                T share) {
  T work(0.0);
  for (int a = 0; a < hourglass_modes; ++a)
    for (int k = 0; k < linear_modes; ++k) {
      const T half_way = carried * strain.entry[a][k] + (0.5 * share) * growth.entry[a][k];
      work += half_way * growth.entry[a][k];
      strain.entry[a][k] = half_way + (0.5 * share) * growth.entry[a][k];
    }
  return work;
}

/// Largest coefficient of hourglass stiffness in a yielding brick. During uniform plastic flow the consistent
/// tangent has no stiffness along the flow, which the return to the yield surface (shrink_hourglass) does not
/// reproduce: with a larger coefficient, fracturing bricks resist by a third too much. With none, layers of
/// bricks fold onto each other at the foot of a rod that hits a wall.
inline constexpr double hourglass_stiffness_in_flow = 0.01;

/// Ratio of the hourglass stiffness of a yielding brick to the elastic one.
constexpr double hourglass_share_in_flow(double coefficient) {
  return coefficient > hourglass_stiffness_in_flow ? hourglass_stiffness_in_flow / coefficient : 1;
}

/// Energy that hourglass stress can store at yield. Bending stress +-s over a brick of edges L, E its plane
/// modulus, is Q = s V / (12 L), and the yield stress over all of the section carries 3/2 of the Q at first
/// yield: Q G^-1 Q = V^2 yield^2 / 32, and twice S times the energy is Q G^-1 Q.
template <class T>
BRIO_INLINE T hourglass_energy_at_yield(T yield_stress, T volume, T stiffness) {
  return square(yield_stress * volume) / (64.0 * stiffness);
}

/// Strains shrink to a share of what they are. \return what they then miss of the step's work over stiffness.
template <class T>
BRIO_INLINE T shrink_hourglass(HourglassStrain<T>& strain, T share, const HourglassStrain<T>& growth) {
  const T all = dot(strain, growth);
  for (auto& row : strain.entry)
    for (T& entry : row) entry = share * entry;
  return (0.5 * (1.0 - share)) * all;
}

/// Viscous forces, added to `q`. \return their power.
template <class T>
BRIO_INLINE T resist_hourglass(const HourglassVectors<T>& rate, T resistance, HourglassVectors<T>& q) {
  for (int a = 0; a < hourglass_modes; ++a) q.mode[a] = q.mode[a] + resistance * rate.mode[a];
  return resistance * dot(rate, rate);
}

/// Corner forces of a stress on the mean gradient and of generalized hourglass forces.
template <class T>
BRIO_INLINE void nodal_forces(const HourglassVectors<T>& x, const MeanGradient<T>& b,
                              const SymmetricTensor<T>& stress, const HourglassVectors<T>& q,
                              T scaled_inverse_volume, NodalForces<T, 8>& forces) {
  const SymmetricTensor<T> t = T(gradient_scale) * stress;
  const Vector3<T> rows[3] = {{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}};
  const auto component = [](const Vector3<T>& a, int i) { return i == 0 ? a.x : i == 1 ? a.y : a.z; };
  for (int i = 0; i < 3; ++i) {
    Vector3<T> drag = component(q.mode[0], i) * x.mode[0];
    for (int a = 1; a < hourglass_modes; ++a) drag = drag + component(q.mode[a], i) * x.mode[a];
    const Vector3<T> row = rows[i] - scaled_inverse_volume * drag;
    T s[hexahedron_modes];
    for (int m = 0; m < linear_modes; ++m) s[m] = dot(row, b.beta[m]);
    for (int m = linear_modes; m < gradient_modes; ++m)
      s[m] = component(q.mode[m - linear_modes], i) + dot(row, b.beta[m]);
    s[hexahedron_modes - 1] = component(q.mode[hourglass_modes - 1], i);
    corner_values(s, forces.force[i]);
  }
}

}  // namespace brio
