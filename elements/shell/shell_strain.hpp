#pragma once
/// Strain rates of a four-node shell over a step, and the nodal forces that belong to them.
///
/// Velocities are those of the middle of the step, positions those of its end. With the mean velocity
/// gradient L (its columns L1, L2 along the axes e1, e2) the axes stood at h_a = e_a - dt/2 L_a in the middle
/// of the step, with the normal n = h1 x h2 and, in the plane, m_a = n x h_a. Measured there,
///
///     membrane   E_ab = sym h_a . L_b            curvature  K_ab = sym m_a . W_b      (W: gradient of
///     angular velocity) shear      g_a  = n . L_a + w . m_a        (w: mean angular velocity)
///
/// all vanish to rounding for a rigid motion of any size, since a finite rotation moves points by
/// dt Omega x (middle position) for one vector Omega. At dt = 0 they are the velocity strains of Belytschko,
/// Lin & Tsay (1984). The generalized hourglass rates are measured in the same way.
///
/// Two terms are added to theirs so that constant curvature passes the patch test in every quadrilateral;
/// both vanish with the gradient of rotation:
///  * the shear along a diagonal takes the rotation in the middle of that diagonal, not the mean of the
///  nodes;
///  * the hourglass part of the deflection excludes that of constant curvature (a quadratic
///  deflection has
///    one), so that hourglass control does not resist twist.

#include "elements/shell/shell_geometry.hpp"

namespace brio {

/// Strain rates on the axes; also used for the conjugate forces, per area (membrane, curvature, shear) or in
/// total (hourglass, drilling).
template <class T>
struct ShellRates {
  T membrane[3];            ///< 11, 22, 12 (tensor component)
  T curvature[3];           ///< 11, 22, 12
  T shear[2];               ///< engineering shear 13, 23
  T hourglass[3];           ///< of velocity: along e1, e2, normal
  T rotation[2];            ///< of angular velocity, along m1 ~ e2 and m2 ~ -e1
  T drilling;               ///< mean of the nodes' spins about the normal, less that of the material
  T squared_area_at_start;  ///< of the step, over that at its end; of rates alone
};

/// D:D in the plane, of the middle and what bending adds at a surface.
template <class T>
BRIO_INLINE T strain_rate_squared(const ShellRates<T>& rates, T thickness) {
  const auto squared = [](const T(&d)[3]) { return square(d[0]) + square(d[1]) + 2.0 * square(d[2]); };
  return squared(rates.membrane) + square(0.5 * thickness) * squared(rates.curvature);
}

template <class T>
BRIO_INLINE T along_diagonal(const T (&diagonal)[2], const T (&tensor)[3]) {
  return square(diagonal[0]) * tensor[0] + square(diagonal[1]) * tensor[1] +
         2.0 * (diagonal[0] * diagonal[1] * tensor[2]);
}

template <class T>
BRIO_INLINE Vector3<T> in_plane(const Vector3<T> (&axis)[2], T first, T second) {
  return first * axis[0] + second * axis[1];
}

/// Coupling of curvature with membrane strain in a twisted element (after Belytschko, Wong & Chiang 1992).
/// From the degenerated shell K_ab = sym(h_a . d(w x p)/db + p_a . L_b), with the director's gradient p_a =
/// -Z_ab e_b; what a nodal spin about the nodal normal gives to it is nothing, so the free drilling rotation
/// does not leak in. \param spin difference of the material's and the nodes' mean spin about the normal.
template <class T>
BRIO_INLINE void add_twist_coupling(const ShellGeometry<T>& g, const T& spin, ShellRates<T>& rates) {
  T z[3];
  surface_twist(g, z);
  const T(&e)[3] = rates.membrane;
  rates.curvature[0] -= z[0] * e[0] + z[2] * e[2] + spin * z[2];
  rates.curvature[1] -= z[1] * e[1] + z[2] * e[2] - spin * z[2];
  rates.curvature[2] -= 0.5 * (z[2] * (e[0] + e[1]) + e[2] * (z[0] + z[1]) - spin * (z[0] - z[1]));
}

/// Turn rates from the middle position's skewed axes h_a to unit axes that follow the material (to second
/// order in the step): X becomes M^T X M with M = 1 + dt/2 E and the small turn between the mean spin of the
/// step and that of the polar decomposition.
template <class T>
BRIO_INLINE void refer_to_middle(const ShellGeometry<T>& g, T half_step, ShellRates<T>& rates) {
  const T e0 = half_step * rates.membrane[0];
  const T e1 = half_step * rates.membrane[1];
  const T e2 = half_step * rates.membrane[2];
  const T turn = g.inverse_trace * (g.stretch[2] * (e0 - e1) - e2 * (g.stretch[0] - g.stretch[1]));
  const T m00 = 1.0 + e0;
  const T m11 = 1.0 + e1;
  const T m01 = e2 - turn;
  const T m10 = e2 + turn;
  const auto congruence = [&](T(&x)[3]) {
    const T y00 = x[0] * m00 + x[2] * m10;
    const T y01 = x[0] * m01 + x[2] * m11;
    const T y10 = x[2] * m00 + x[1] * m10;
    const T y11 = x[2] * m01 + x[1] * m11;
    x[0] = m00 * y00 + m10 * y10;
    x[1] = m01 * y01 + m11 * y11;
    x[2] = m00 * y01 + m10 * y11;
  };
  congruence(rates.membrane);
  congruence(rates.curvature);
  const T first = rates.shear[0];
  rates.shear[0] = m00 * first + m10 * rates.shear[1];
  rates.shear[1] = m01 * first + m11 * rates.shear[1];
}

template <class T>
BRIO_INLINE ShellRates<T> shell_rates(const RotatingNodalMotion<T, 4>& motion, const ShellGeometry<T>& g,
                                      T step, bool warping_projection) {
  const T half_step = 0.5 * step;
  const DiagonalParts<T> v = diagonal_parts(motion.velocity);
  const DiagonalParts<T> w = diagonal_parts(motion.angular_velocity);
  Vector3<T> mean_spin{T(0.0), T(0.0), T(0.0)};
  for (int node = 0; node < 4; ++node) mean_spin = mean_spin + column(motion.angular_velocity, node);
  mean_spin = T(0.25) * mean_spin;

  Vector3<T> velocity_gradient[2], spin_gradient[2], h[2], m[2];
  for (int a = 0; a < 2; ++a) {
    velocity_gradient[a] = g.dual[0][a] * v.difference[0] + g.dual[1][a] * v.difference[1];
    spin_gradient[a] = g.dual[0][a] * w.difference[0] + g.dual[1][a] * w.difference[1];
    h[a] = g.axis[a] - half_step * velocity_gradient[a];
  }
  ShellRates<T> rates;
  const T across[2] = {dot(h[0], velocity_gradient[1]), dot(h[1], velocity_gradient[0])};
  rates.membrane[0] = dot(h[0], velocity_gradient[0]);
  rates.membrane[1] = dot(h[1], velocity_gradient[1]);
  rates.membrane[2] = 0.5 * (across[0] + across[1]);

  // h1 x h2 is shorter than a unit vector by half a step's stretch.
  const Vector3<T> normal = (1.0 + half_step * (rates.membrane[0] + rates.membrane[1])) * cross(h[0], h[1]);
  for (int a = 0; a < 2; ++a) m[a] = cross(normal, h[a]);

  T bend[2][2];
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) bend[a][b] = dot(m[a], spin_gradient[b]);
  rates.curvature[0] = bend[0][0];
  rates.curvature[1] = bend[1][1];
  rates.curvature[2] = 0.5 * (bend[0][1] + bend[1][0]);

  // Rotation in the middle of a diagonal less the mean of the nodes: +- the gradient times this vector.
  T offset[2], turn[2];
  for (int a = 0; a < 2; ++a)
    offset[a] = 0.25 * (g.skew[0] * g.diagonal[0][a] + g.skew[1] * g.diagonal[1][a]);
  for (int a = 0; a < 2; ++a) turn[a] = bend[a][0] * offset[0] + bend[a][1] * offset[1];
  const T first = g.diagonal[0][0] * turn[0] + g.diagonal[0][1] * turn[1];
  const T second = g.diagonal[1][0] * turn[0] + g.diagonal[1][1] * turn[1];
  for (int a = 0; a < 2; ++a)
    rates.shear[a] = dot(normal, velocity_gradient[a]) + dot(mean_spin, m[a]) +
                     (g.dual[0][a] * first - g.dual[1][a] * second);

  const Vector3<T> hourglass = v.alternating - (g.skew[0] * v.difference[0] + g.skew[1] * v.difference[1]);
  const Vector3<T> middle_warp = g.warp * g.normal - half_step * hourglass;
  for (int a = 0; a < 2; ++a)
    rates.hourglass[a] = dot(hourglass, h[a]) + dot(middle_warp, velocity_gradient[a]);
  rates.hourglass[2] =
      dot(hourglass, normal) + (bow_share(g, 0) * along_diagonal(g.diagonal[0], rates.curvature) +
                                bow_share(g, 1) * along_diagonal(g.diagonal[1], rates.curvature));
  const Vector3<T> twist = w.alternating - (g.skew[0] * w.difference[0] + g.skew[1] * w.difference[1]);
  for (int a = 0; a < 2; ++a) rates.rotation[a] = dot(twist, m[a]);

  const T spin = 0.5 * (across[1] - across[0]);
  rates.drilling = dot(mean_spin, normal) - spin;
  if (warping_projection) add_twist_coupling(g, -rates.drilling, rates);
  // By the metric of where the axes of the end stood at the start, e_a - dt L_a.
  const T twice = 2.0 * step;
  rates.squared_area_at_start = (1.0 - twice * rates.membrane[0]) * (1.0 - twice * rates.membrane[1]) -
                                square(twice * rates.membrane[2]);
  refer_to_middle(g, half_step, rates);
  return rates;
}

/// What membrane forces and the normal's moment become by the coupling of `add_twist_coupling`.
/// \return moment about the normal per area, against the nodes' mean spin.
template <class T>
BRIO_INLINE T take_twist_coupling(const ShellGeometry<T>& g, ShellRates<T>& force) {
  T z[3];
  surface_twist(g, z);
  const T(&m)[3] = force.curvature;
  force.membrane[0] -= z[0] * m[0] + z[2] * m[2];
  force.membrane[1] -= z[1] * m[1] + z[2] * m[2];
  force.membrane[2] -= 0.5 * (z[2] * (m[0] + m[1]) + m[2] * (z[0] + z[1]));
  return z[2] * (m[1] - m[0]) + (z[0] - z[1]) * m[2];
}

/// Spread the parts of a field's dual over the nodes: the transpose of `diagonal_parts`.
template <class T>
BRIO_INLINE void spread(const Vector3<T>& first, const Vector3<T>& second, const Vector3<T>& alternating,
                        const Vector3<T>& uniform, T (&field)[3][4]) {
  const Vector3<T> node[4] = {(uniform + alternating) - first, (uniform - alternating) - second,
                              (uniform + alternating) + first, (uniform - alternating) + second};
  for (int n = 0; n < 4; ++n) {
    field[0][n] = node[n].x;
    field[1][n] = node[n].y;
    field[2][n] = node[n].z;
  }
}

/// Nodal forces and moments of `force`, whose power on the rates of an instant (step 0) is theirs on the
/// nodes.
template <class T>
BRIO_INLINE void shell_forces(const ShellGeometry<T>& g, ShellRates<T> force, bool warping_projection,
                              RotatingNodalForces<T, 4>& nodal) {
  T about_normal = warping_projection ? take_twist_coupling(g, force) : T(0.0);
  about_normal -= g.inverse_area * force.drilling;
  const Vector3<T> turned[2] = {g.axis[1], T(-1.0) * g.axis[0]};  // m1, m2

  const Vector3<T> hourglass =
      in_plane(g.axis, force.hourglass[0], force.hourglass[1]) + force.hourglass[2] * g.normal;
  const T out[2] = {g.area * force.shear[0] + g.warp * force.hourglass[0],
                    g.area * force.shear[1] + g.warp * force.hourglass[1]};
  const T half_spin = 0.5 * about_normal;
  const Vector3<T> traction[2] = {
      in_plane(g.axis, g.area * force.membrane[0], g.area * (force.membrane[2] + half_spin)) +
          out[0] * g.normal,
      in_plane(g.axis, g.area * (force.membrane[2] - half_spin), g.area * force.membrane[1]) +
          out[1] * g.normal};
  Vector3<T> along[2];
  for (int k = 0; k < 2; ++k)
    along[k] = (g.dual[k][0] * traction[0] + g.dual[k][1] * traction[1]) - g.skew[k] * hourglass;
  const Vector3<T> none{T(0.0), T(0.0), T(0.0)};
  spread(along[0], along[1], hourglass, none, nodal.force);

  // Moments against bend[a][b], times the area.
  T bend[2][2];
  T diagonal_shear[2], offset[2];
  for (int k = 0; k < 2; ++k)
    diagonal_shear[k] = g.area * (g.dual[k][0] * force.shear[0] + g.dual[k][1] * force.shear[1]);
  for (int a = 0; a < 2; ++a)
    offset[a] = 0.25 * (g.skew[0] * g.diagonal[0][a] + g.skew[1] * g.diagonal[1][a]);
  const T bow[2] = {force.hourglass[2] * bow_share(g, 0), force.hourglass[2] * bow_share(g, 1)};
  for (int a = 0; a < 2; ++a) {
    const T pull = diagonal_shear[0] * g.diagonal[0][a] - diagonal_shear[1] * g.diagonal[1][a];
    for (int b = 0; b < 2; ++b)
      bend[a][b] =
          g.area * force.curvature[a == b ? a : 2] + pull * offset[b] +
          (bow[0] * (g.diagonal[0][a] * g.diagonal[0][b]) + bow[1] * (g.diagonal[1][a] * g.diagonal[1][b]));
  }
  const Vector3<T> twist = in_plane(turned, force.rotation[0], force.rotation[1]);
  const Vector3<T> couple[2] = {in_plane(turned, bend[0][0], bend[1][0]),
                                in_plane(turned, bend[0][1], bend[1][1])};
  for (int k = 0; k < 2; ++k)
    along[k] = (g.dual[k][0] * couple[0] + g.dual[k][1] * couple[1]) - g.skew[k] * twist;
  const T quarter = 0.25 * g.area;
  const Vector3<T> uniform = in_plane(turned, quarter * force.shear[0], quarter * force.shear[1]) -
                             (quarter * about_normal) * g.normal;
  spread(along[0], along[1], twist, uniform, nodal.moment);
}

}  // namespace brio
