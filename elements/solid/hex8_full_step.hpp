#pragma once
/// One time step of the fully integrated hexahedron around the updates of its integration points: the same
/// code for all laws: what is done once a step is compiled once and called, what is done at each point
/// inlined.
///
/// As in hex8_step.hpp, gradients are taken once, on the configuration at the end of the step, and the
/// middle follows exactly for affine motion. Point gradients need no nodal shape functions: with the pattern
/// sums of a field f,
///
///     8 df/dxi = f_xi + zeta f_zeta*xi + eta f_xi*eta + eta zeta f_xi*eta*zeta        (and cyclic)

#include <cmath>

#include "elements/solid/hex8_full.hpp"
#include "elements/solid/mean_gradient.hpp"
#include "elements/solid/solid.hpp"

namespace brio {

/// 8 df/dxi_k at a point of the brick, k = 0, 1, 2.
template <class T>
struct ReferenceGradient {
  Vector3<T> along[3];
};
template <class T>
BRIO_INLINE ReferenceGradient<T> reference_gradient(const HexahedronModes<T>& f, const double xi[3]) {
  const auto at = [&](int k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    return f.sum[k] + T(xi[last]) * f.sum[linear_modes + next] + T(xi[next]) * f.sum[linear_modes + last] +
           T(xi[next] * xi[last]) * f.sum[gradient_modes];
  };
  return {{at(0), at(1), at(2)}};
}
/// The transpose: adds to the sums of nodal forces what a flux t_k does along dN/dxi_k.
template <class T>
BRIO_INLINE void add_flux(const ReferenceGradient<T>& t, const double xi[3], HexahedronModes<T>& f) {
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    f.sum[k] = f.sum[k] + t.along[k];
    f.sum[linear_modes + next] = f.sum[linear_modes + next] + T(xi[last]) * t.along[k];
    f.sum[linear_modes + last] = f.sum[linear_modes + last] + T(xi[next]) * t.along[k];
    f.sum[gradient_modes] = f.sum[gradient_modes] + T(xi[next] * xi[last]) * t.along[k];
  }
}

inline constexpr int hexahedron_points = 8;
inline constexpr double gauss_coordinate = 0.57735026918962576451;  // 1/sqrt(3)
inline constexpr double point_position[hexahedron_points][3] = {
    {-gauss_coordinate, -gauss_coordinate, -gauss_coordinate},
    {gauss_coordinate, -gauss_coordinate, -gauss_coordinate},
    {gauss_coordinate, gauss_coordinate, -gauss_coordinate},
    {-gauss_coordinate, gauss_coordinate, -gauss_coordinate},
    {-gauss_coordinate, -gauss_coordinate, gauss_coordinate},
    {gauss_coordinate, -gauss_coordinate, gauss_coordinate},
    {gauss_coordinate, gauss_coordinate, gauss_coordinate},
    {-gauss_coordinate, gauss_coordinate, gauss_coordinate}};

/// Cofactors of the Jacobian at a point: dxi_k/dx = cofactor_k * 8 / determinant, volume = determinant / 512.
template <class T>
struct PointGeometry {
  Vector3<T> cofactor[3];
  T determinant;
};
template <class T>
BRIO_INLINE PointGeometry<T> point_geometry(const HexahedronModes<T>& x, const double xi[3]) {
  const ReferenceGradient<T> j = reference_gradient(x, xi);
  PointGeometry<T> p{
      {cross(j.along[1], j.along[2]), cross(j.along[2], j.along[0]), cross(j.along[0], j.along[1])}, T(0.0)};
  p.determinant = dot(j.along[0], p.cofactor[0]);
  return p;
}
inline constexpr double point_volume = 1.0 / 512.0;

/// State of an element besides that of its integration points.
template <class T>
struct Hex8FullState {
  T mass;
  T internal_energy;
  T viscous_pressure;  ///< of the last step
};

/// What the parts of a step hand on.
template <class T>
struct Hex8FullStep {
  HexahedronModes<T> x, v;
  MeanGradient<T> b;
  T scaled_inverse_volume;
  T dilatation_rate;      ///< of the end
  T middle_rate;          ///< of the middle
  T half_dilatation;      ///< dt/2 times that
  T middle_volume_ratio;  ///< to that of the end
  MaskOf<T> is_valid;
  // Sums over the points.
  HexahedronModes<T> f{};  ///< forces, without those of the mean stress
  T internal_energy{0.0};
  T pressure_force{0.0};                                ///< mean stress times volume
  T gradient_square{0.0};                               ///< over the corners as well: volume |B|^2
  ElasticModuli<T> moduli{T(-HUGE_VAL), T(-HUGE_VAL)};  ///< the largest
};

/// The step of an integration point.
template <class T>
struct Hex8FullPoint {
  PointGeometry<T> geometry;
  T inverse;  ///< of the determinant
  T volume, middle_volume;
  MaterialAxes<T> axes;
};

// Of a point with next to no volume left, as a share of that of the mean point, the strain of one step is
// more than can be followed: N beyond this, a strain of 1.
inline constexpr double least_volume_share = 1e-9, most_point_step = 0.5;

/// Zero elsewhere.
template <class T>
BRIO_INLINE void keep(const MaskOf<T>& where_kept, Tensor<T>& a) {
  for (auto& row : a.m)
    for (T& component : row) component = where(where_kept, component, T(0.0));
}

/// sum_k df/dxi_k (x) dxi_k/dx; both carry a factor that `inverse` = 1/determinant takes out.
template <class T>
BRIO_INLINE Tensor<T> point_gradient(const ReferenceGradient<T>& f, const PointGeometry<T>& geometry,
                                     T inverse) {
  Vector3<T> row[3];
  const auto& c = geometry.cofactor;
  row[0] = inverse * (f.along[0].x * c[0] + f.along[1].x * c[1] + f.along[2].x * c[2]);
  row[1] = inverse * (f.along[0].y * c[0] + f.along[1].y * c[1] + f.along[2].y * c[2]);
  row[2] = inverse * (f.along[0].z * c[0] + f.along[1].z * c[1] + f.along[2].z * c[2]);
  return {{{row[0].x, row[0].y, row[0].z}, {row[1].x, row[1].y, row[1].z}, {row[2].x, row[2].y, row[2].z}}};
}

/// volume sigma dxi_k/dx / 8: stress as flux along dN/dxi_k.
template <class T>
BRIO_INLINE ReferenceGradient<T> flux(const SymmetricTensor<T>& stress, const PointGeometry<T>& geometry) {
  const SymmetricTensor<T> s = T(point_volume) * stress;
  ReferenceGradient<T> t;
  for (int k = 0; k < 3; ++k) {
    const Vector3<T>& c = geometry.cofactor[k];
    t.along[k] = {s.xx * c.x + s.xy * c.y + s.xz * c.z, s.xy * c.x + s.yy * c.y + s.yz * c.z,
                  s.xz * c.x + s.yz * c.y + s.zz * c.z};
  }
  return t;
}

/// volume sum_I |B_I|^2 of a point, times its determinant: the shape functions give
/// sum_I dN_I/dxi_k dN_I/dxi_l = (1 + g^2)^2/8 on the diagonal and xi_k xi_l (1 + g^2)/8 beside it, g^2 =
/// 1/3.
template <class T>
BRIO_INLINE T weighted_square(const PointGeometry<T>& geometry, const double xi[3]) {
  const auto& c = geometry.cofactor;
  const T diagonal = dot(c[0], c[0]) + dot(c[1], c[1]) + dot(c[2], c[2]);
  const T beside = T(xi[0] * xi[1]) * dot(c[0], c[1]) + T(xi[1] * xi[2]) * dot(c[1], c[2]) +
                   T(xi[2] * xi[0]) * dot(c[2], c[0]);
  return (64.0 * point_volume / 8.0) * ((16.0 / 9.0) * diagonal + (8.0 / 3.0) * beside);
}

template <class T>
BRIO_INLINE void corner_forces(const HexahedronModes<T>& f, NodalForces<T, 8>& forces) {
  T s[3][hexahedron_modes];
  for (int m = 0; m < hexahedron_modes; ++m) {
    s[0][m] = f.sum[m].x;
    s[1][m] = f.sum[m].y;
    s[2][m] = f.sum[m].z;
  }
  for (int i = 0; i < 3; ++i) corner_values(s[i], forces.force[i]);
}

/// What the strains that vary over the element add to the frequency of the uniform ones. In a
/// parallelepiped both are orthogonal and the varying ones have at most 2/3 of 2 mu g, so they add nothing;
/// there the sum over points and corners of volume |B|^2 is 16/9 V tr G. What it has more is due to
/// distortion; the tests compare the factor with assembled stiffness matrices.
template <class T>
BRIO_INLINE T distortion_excess(const ElasticModuli<T>& moduli, T trace_g, T gradient_square, T volume,
                                T inverse_mass) {
  constexpr double factor = 1.5;
  const T excess = max(gradient_square - (16.0 / 9.0) * volume * trace_g, T(0.0));
  return (8.0 * 2.0 * factor) * inverse_mass * moduli.shear * excess;
}

/// First part: the motion.
template <class T>
BRIO_CALLED void begin_step(const NodalMotion<T, 8>& motion, T step, Hex8FullStep<T>& s,
                            Increment<T>& increment) {
  s.x = modes(motion.position);
  s.v = modes(motion.velocity);
  s.b = mean_gradient(s.x);
  s.is_valid = s.b.volume > T(0.0);
  s.scaled_inverse_volume = gradient_scale / where(s.is_valid, s.b.volume, T(1.0));
  const Tensor<T> l = s.scaled_inverse_volume * scaled_gradient_of(s.v, s.b);
  s.dilatation_rate = trace(l);
  const T half_step = 0.5 * step;
  T determinant;
  const Tensor<T> n = centered(half_step * l, determinant);
  s.half_dilatation = trace(n);
  s.middle_rate = middle_dilatation_rate(n, half_step, s.dilatation_rate);
  s.middle_volume_ratio = where(determinant > T(0.0), determinant, T(1.0));
  increment.strain_rate_squared = strain_rate_squared(l);
}

/// Before the update of a point: its motion, followed by stress or material axes.
template <class T, ObjectiveRate rate>
BRIO_INLINE void follow_motion(const double xi[3], T step, SymmetricTensor<T>& stress,
                               RotationState<T, rate>& rotation, Hex8FullStep<T>& s, Hex8FullPoint<T>& p) {
  p.geometry = point_geometry(s.x, xi);
  const T least_determinant =
      (least_volume_share / (hexahedron_points * point_volume)) * max(s.b.volume, T(0.0));
  const MaskOf<T> has_volume = p.geometry.determinant > least_determinant;
  p.inverse = 1.0 / where(has_volume, p.geometry.determinant, T(1.0));
  p.volume = point_volume * where(has_volume, p.geometry.determinant, T(1.0));
  Tensor<T> l = point_gradient(reference_gradient(s.v, xi), p.geometry, p.inverse);
  const T correction = (1.0 / 3.0) * (s.dilatation_rate - trace(l));
  for (int i = 0; i < 3; ++i) l.m[i][i] += correction;
  T determinant;
  Tensor<T> n = centered(0.5 * step * l, determinant);
  p.middle_volume = p.volume * where(determinant > T(0.0), determinant, T(1.0));
  const MaskOf<T> is_followed =
      has_volume & (determinant > T(0.0)) & (contract(n, n) < T(most_point_step * most_point_step));
  s.is_valid = s.is_valid & is_followed;
  if (!all(is_followed)) [[unlikely]]
    keep(is_followed, n);
  p.axes = follow(n, stress, rotation);
}

/// After it. \param work per volume of the middle of the step
template <ObjectiveRate rate, class T>
BRIO_INLINE void add_point(const double xi[3], T work, const SymmetricTensor<T>& stress_on_axes,
                           const ElasticModuli<T>& moduli, const Hex8FullPoint<T>& p, Hex8FullStep<T>& s) {
  s.internal_energy += p.middle_volume * work;
  const SymmetricTensor<T> stress = fixed_stress<rate>(stress_on_axes, p.axes);
  const T mean_stress = trace(stress) * (1.0 / 3.0);
  s.pressure_force += p.volume * mean_stress;
  add_flux(flux(stress - isotropic(mean_stress), p.geometry), xi, s.f);
  s.gradient_square += p.inverse * weighted_square(p.geometry, xi);
  s.moduli = {max(s.moduli.first_lame, moduli.first_lame), max(s.moduli.shear, moduli.shear)};
}

/// Last part: bulk viscosity, stable step, nodal forces.
template <class T>
BRIO_CALLED void finish_step(const Hex8Full& element, Hex8FullState<T>& state, Hex8FullStep<T>& s,
                             Increment<T>& increment, NodalForces<T, 8>& forces) {
  increment.internal_energy = s.internal_energy;
  increment.hourglass_energy = T(0.0);
  state.internal_energy += s.internal_energy;
  const SymmetricTensor<T> g = gradient_product(s.b, s.scaled_inverse_volume);
  const T trace_g = trace(g);
  const T volume = where(s.is_valid, s.b.volume, T(1.0));
  const T inverse_mass = 1.0 / state.mass;
  const SolidSpectrum<T> spectrum = solid_spectrum(s.moduli, g, volume * inverse_mass);
  const BulkViscosity<T> viscosity =
      bulk_viscosity(element.linear_bulk_viscosity, element.quadratic_bulk_viscosity, s.middle_rate, trace_g,
                     state.mass * (s.scaled_inverse_volume / gradient_scale), sqrt(spectrum.reference));
  increment.viscous_energy =
      -(state.viscous_pressure + viscosity.pressure) * s.half_dilatation * (volume * s.middle_volume_ratio);
  state.viscous_pressure = viscosity.pressure;

  const T mean_pressure_force = (s.pressure_force - volume * viscosity.pressure) * s.scaled_inverse_volume;
  for (int m = 0; m < gradient_modes; ++m) s.f.sum[m] = s.f.sum[m] + mean_pressure_force * s.b.beta[m];
  corner_forces(s.f, forces);
  increment.frequency_squared =
      spectrum.uniform + distortion_excess(s.moduli, trace_g, s.gradient_square, volume, inverse_mass);
  increment.stable_step =
      where(s.is_valid, damped_stable_step(increment.frequency_squared, viscosity.damping), T(-1.0));
}

}  // namespace brio
