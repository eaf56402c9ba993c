#pragma once
/// Hourglass control of the one-point hexahedron (Flanagan & Belytschko 1981): forces along
/// gamma_aI = Gamma_aI - x_a . B_I, which see neither rigid nor linear motion. gamma is never formed: with
/// sums against the base vectors (mean_gradient.hpp), gamma_a . v = v_a - L x_a, and the force of a
/// generalized force Q_a is Q_a on pattern a together with the stress - sum_a Q_a (x) x_a / V on the mean
/// gradient.

#include "elements/mean_gradient.hpp"
#include "elements/motion.hpp"

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

/// scale gamma . v for each mode. \param l `scale` times the mean gradient of v on the configuration of x.
template <class T>
BRIO_INLINE HourglassVectors<T> hourglass_motion(const HexahedronModes<T>& x, const HexahedronModes<T>& v,
                                                 T scale, const Tensor<T>& l) {
  HourglassVectors<T> motion;
  for (int a = 0; a < hourglass_modes; ++a) {
    const Vector3<T>& xa = x.hourglass(a);
    const Vector3<T>& va = v.hourglass(a);
    motion.mode[a] = {scale * va.x - (l.m[0][0] * xa.x + l.m[0][1] * xa.y + l.m[0][2] * xa.z),
                      scale * va.y - (l.m[1][0] * xa.x + l.m[1][1] * xa.y + l.m[1][2] * xa.z),
                      scale * va.z - (l.m[2][0] * xa.x + l.m[2][1] * xa.y + l.m[2][2] * xa.z)};
  }
  return motion;
}

/// p = sum_a x_a . G x_a, dimensionless: what is subtracted from the base vectors to form gamma. It measures
/// distortion and is zero for a parallelepiped.
template <class T>
BRIO_INLINE T hourglass_distortion(const HexahedronModes<T>& x, const SymmetricTensor<T>& g) {
  SymmetricTensor<T> c = isotropic(T(0.0));
  for (int a = 0; a < hourglass_modes; ++a) {
    const Vector3<T>& xa = x.hourglass(a);
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

/// Share of the distortion by which hourglass stiffness may raise the frequencies of uniform strains. For p
/// >= 8 a factor of 4 is enough because (sqrt(8) + sqrt(p))^2 <= 4 p; below, the two stiffnesses overlap in
/// proportion to p, and the factor is held against assembled stiffness matrices in the tests.
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

template <class T>
BRIO_INLINE Vector3<T> operator*(const SymmetricTensor<T>& a, const Vector3<T>& b) {
  return {a.xx * b.x + a.xy * b.y + a.xz * b.z, a.xy * b.x + a.yy * b.y + a.yz * b.z,
          a.xz * b.x + a.yz * b.y + a.zz * b.z};
}

/// What resists hourglass motion, as part of the state of an element.
template <class T>
struct HourglassState {
  HourglassVectors<T> force;  ///< generalized forces, on the axes of the stress
  T energy;                   ///< stored
};

/// Work of one step against the elastic hourglass forces; plastic work is dissipated.
template <class T>
struct HourglassWork {
  T stored, dissipated;
};

/// The directions in which an element resists hourglass motion, on the axes of the stress.
template <class T>
struct HourglassAxes {
  SymmetricTensor<T> g;             ///< G
  Vector3<T> normal[linear_modes];  ///< beta_k / (64 V): of a box one over four edges
};

/// Generalized forces of hourglass displacements. Each component meets the stiffness of its own direction, as
/// in an assumed-strain element (Belytschko & Bindeman 1993): the bending of a flat brick is resisted over
/// its length, not over its thickness.
///
/// Bending is S_b G q_a without the component of q_a along n_a, in which pattern a strains no fibre but
/// shears: eta zeta along the normal of the faces xi = +-1, and so on. Three such motions a_k, u_k = a_k x_l
/// x_m, shear a box of edges L_k by gamma_kl = (a_k + a_l) x_m and store mu V / 24 times the sum of
/// L_m^2 (a_k + a_l)^2. Taken one by one they would lock: in the twist of a thin wall all shears cancel but
/// the one that varies over the thickness.
template <class T>
BRIO_INLINE HourglassVectors<T> hourglass_forces(const HourglassAxes<T>& axes, const HourglassModuli<T>& s,
                                                 const HourglassVectors<T>& q) {
  HourglassVectors<T> force;
  const SymmetricTensor<T> bending = s.bending * axes.g;
  for (int a = 0; a < hourglass_modes; ++a) force.mode[a] = bending * q.mode[a];
  T squared[linear_modes], along[linear_modes];
  for (int k = 0; k < linear_modes; ++k) {
    squared[k] = dot(axes.normal[k], axes.normal[k]);
    along[k] = dot(axes.normal[k], q.mode[k]);
  }
  for (int k = 0; k < linear_modes; ++k) {
    const int l = (k + 1) % linear_modes, m = (k + 2) % linear_modes;
    const T others = (squared[l] + squared[m]) / where(squared[k] > T(0.0), squared[k], T(1.0));
    const T twist = s.twist * (others * along[k] + along[l] + along[m]);
    force.mode[k] = force.mode[k] + (8.0 * (twist - s.bending * along[k])) * axes.normal[k];
  }
  return force;
}

/// Forces grow with the displacement. \param q half of the step's hourglass displacement. \return the work.
template <class T>
BRIO_INLINE T stretch_hourglass(HourglassVectors<T>& force, const HourglassAxes<T>& axes,
                                const HourglassModuli<T>& stiffness, const HourglassVectors<T>& q) {
  const HourglassVectors<T> growth = hourglass_forces(axes, stiffness, q);
  T work(0.0);
  for (int a = 0; a < hourglass_modes; ++a) {
    const Vector3<T> half_way = force.mode[a] + growth.mode[a];
    force.mode[a] = half_way + growth.mode[a];
    work += 2.0 * dot(half_way, q.mode[a]);
  }
  return work;
}

/// Largest coefficient with which hourglass forces grow in a brick that flows. On top of a uniform flow no
/// stress grows along that flow, and the return to the yield surface (shrink_hourglass) does not know: with
/// more, bricks that are torn resist by a third too much. With nothing along the flow, as the consistent
/// tangent has it, layers of bricks fold onto each other at the foot of a rod that hits a wall.
inline constexpr double hourglass_stiffness_in_flow = 0.01;

/// Share of the stiffness of hourglass motion that is left in a brick that flows.
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

/// Forces shrink to a share of what they are. \return their work on the displacement of the step, of which
/// half is q, that they then miss.
template <class T>
BRIO_INLINE T shrink_hourglass(HourglassVectors<T>& force, T share, const HourglassVectors<T>& q) {
  const T all = dot(force, q);
  for (Vector3<T>& mode : force.mode) mode = share * mode;
  return (1.0 - share) * all;
}

/// Viscous forces, added to `q`. \return their power.
template <class T>
BRIO_INLINE T resist_hourglass(const HourglassVectors<T>& rate, T resistance, HourglassVectors<T>& q) {
  for (int a = 0; a < hourglass_modes; ++a) q.mode[a] = q.mode[a] + resistance * rate.mode[a];
  return resistance * dot(rate, rate);
}

/// Corner forces of a stress on the mean gradient and of generalized hourglass forces.
template <class T>
BRIO_INLINE void nodal_forces(const HexahedronModes<T>& x, const MeanGradient<T>& b,
                              const SymmetricTensor<T>& stress, const HourglassVectors<T>& q,
                              T scaled_inverse_volume, NodalForces<T, 8>& forces) {
  const SymmetricTensor<T> t = T(gradient_scale) * stress;
  const Vector3<T> rows[3] = {{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}};
  const auto component = [](const Vector3<T>& a, int i) { return i == 0 ? a.x : i == 1 ? a.y : a.z; };
  for (int i = 0; i < 3; ++i) {
    Vector3<T> drag = component(q.mode[0], i) * x.hourglass(0);
    for (int a = 1; a < hourglass_modes; ++a) drag = drag + component(q.mode[a], i) * x.hourglass(a);
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
