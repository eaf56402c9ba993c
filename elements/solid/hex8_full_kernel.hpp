#pragma once
/// Eight-node hexahedron with 2x2x2 integration points and the dilatation of the whole element at each of
/// them (B-bar: selective reduced integration in the form of Hughes 1980): no hourglass modes, no volumetric
/// locking.
///
/// As in hex8_kernel.hpp, gradients are taken once, on the configuration at the end of the step, and the
/// middle follows exactly for affine motion. Point gradients need no nodal shape functions: with the pattern
/// sums of a field f,
///
///     8 df/dxi = f_xi + zeta f_zeta*xi + eta f_xi*eta + eta zeta f_xi*eta*zeta        (and cyclic)

#include "elements/solid/hex8_full.hpp"
#include "elements/solid/mean_gradient.hpp"
#include "src/base/fetch_ahead.hpp"

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

template <ObjectiveRate rate>
struct Hex8FullKernel : Hex8Full {
  using Settings = Hex8Full;
  static constexpr KernelTraits kernel_traits{
      .uses_differences = true, .fetches_points_ahead = true, .tangent = true, .completes_samples = true};
  static constexpr int most_points = hexahedron_points;
  static constexpr int points() { return hexahedron_points; }
  static double point_size(double volume) { return std::cbrt(volume / hexahedron_points); }
  template <class Law>
  static constexpr bool accepts = RateLaw<Law> || (rate == ObjectiveRate::green_naghdi && StretchLaw<Law>);

  template <class T, class Law>
  struct Header {
    T mass;
    T internal_energy;
    T viscous_pressure;  ///< of the last step
  };
  template <class T, class Law>
  using Point = SolidPoint<T, Law, rate>;

  template <class T, class Law>
  NodalMass<T> initialize(const NodalMotion<T, 8>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>* point) const {
    const HexahedronModes<T> x = modes(motion.position);
    header.mass = T(law.density) * mean_gradient(x).volume;
    T mass = header.mass * 0.125;
    for (int p = 0; p < hexahedron_points; ++p) {
      start(point[p]);
      mass = where(point_geometry(x, point_position[p]).determinant > T(0.0), mass, T(0.0));
    }
    return {mass, T(0.0)};
  }

  /// The same without damping forces.
  Hex8FullKernel undamped() const {
    Hex8FullKernel kernel = *this;
    kernel.linear_bulk_viscosity = 0;
    kernel.quadratic_bulk_viscosity = 0;
    return kernel;
  }
  /// State with the present shape and without stress. \param header, point out, zero before
  template <class T, class Law, class Other>
  void start_unstressed(const Header<T, Law>& now, Header<T, Other>& header, Point<T, Other>* point) const {
    header.mass = now.mass;
    for (int p = 0; p < hexahedron_points; ++p) start(point[p]);
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const NodalMotion<T, 8>& motion, T step, const Law& law,
                                 Header<T, Law>& header, Point<T, Law>* point,
                                 NodalForces<T, 8>& forces) const {
    const HexahedronModes<T> x = modes(motion.position);
    const HexahedronModes<T> v = modes(motion.velocity);
    const MeanGradient<T> b = mean_gradient(x);
    const T half_step = 0.5 * step;
    MaskOf<T> is_valid = b.volume > T(0.0);
    const T scaled_inverse_volume = gradient_scale / where(is_valid, b.volume, T(1.0));
    const Tensor<T> scaled_l = scaled_gradient_of(v, b);
    const T dilatation_rate = scaled_inverse_volume * trace(scaled_l);

    HexahedronModes<T> f{};
    Increment<T> increment{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    ElasticModuli<T> moduli = law.moduli(point[0].history);
    const T least_determinant =
        (least_volume_share / (hexahedron_points * point_volume)) * max(b.volume, T(0.0));
    T pressure_force(0.0);   // sum over the points of mean stress times volume
    T gradient_square(0.0);  // sum over the points and corners of volume |B|^2
    constexpr std::size_t pack_bytes = sizeof(Header<T, Law>) + hexahedron_points * sizeof(Point<T, Law>);
#pragma GCC unroll 1
    for (int p = 0; p < hexahedron_points; ++p) {
      const double* xi = point_position[p];
      const PointGeometry<T> geometry = point_geometry(x, xi);
      const MaskOf<T> has_volume = geometry.determinant > least_determinant;
      const T inverse = 1.0 / where(has_volume, geometry.determinant, T(1.0));
      const T volume = point_volume * where(has_volume, geometry.determinant, T(1.0));
      Tensor<T> l = point_gradient(reference_gradient(v, xi), geometry, inverse);
      const T correction = (1.0 / 3.0) * (dilatation_rate - trace(l));
      for (int i = 0; i < 3; ++i) l.m[i][i] += correction;
      T determinant;
      Tensor<T> n = centered(half_step * l, determinant);
      const MaskOf<T> is_followed =
          has_volume & (determinant > T(0.0)) & (square(n) < T(most_step * most_step));
      is_valid = is_valid & is_followed;
      if (!all(is_followed)) [[unlikely]]
        keep(is_followed, n);
      MaterialAxes<T> axes;
      const T work = update(law, n, point[p], axes).work;
      increment.internal_energy += volume * where(determinant > T(0.0), determinant, T(1.0)) * work;
      fetch_ahead(reinterpret_cast<std::uintptr_t>(point + p) + pack_bytes, sizeof(Point<T, Law>));
      const SymmetricTensor<T> stress = fixed_stress(point[p], axes);
      const T mean_stress = trace(stress) * (1.0 / 3.0);
      pressure_force += volume * mean_stress;
      add_flux(flux(stress - isotropic(mean_stress), geometry), xi, f);
      gradient_square += inverse * weighted_square(geometry, xi);
      const ElasticModuli<T> here = law.moduli(point[p].history);
      moduli = {max(moduli.first_lame, here.first_lame), max(moduli.shear, here.shear)};
    }
    header.internal_energy += increment.internal_energy;

    const SymmetricTensor<T> g = gradient_product(b, scaled_inverse_volume);
    const T trace_g = trace(g);
    const T volume = where(is_valid, b.volume, T(1.0));
    const T inverse_mass = 1.0 / header.mass;
    const SolidSpectrum<T> spectrum = solid_spectrum(moduli, g, volume * inverse_mass);
    T determinant;
    const Tensor<T> n = centered((half_step * scaled_inverse_volume) * scaled_l, determinant);
    const BulkViscosity<T> viscosity =
        bulk_viscosity(linear_bulk_viscosity, quadratic_bulk_viscosity,
                       middle_dilatation_rate(n, half_step, dilatation_rate), trace_g,
                       header.mass * (scaled_inverse_volume / gradient_scale), sqrt(spectrum.reference));
    increment.viscous_energy = -(header.viscous_pressure + viscosity.pressure) * trace(n) *
                               (volume * where(determinant > T(0.0), determinant, T(1.0)));
    header.viscous_pressure = viscosity.pressure;

    const T mean_pressure_force = (pressure_force - volume * viscosity.pressure) * scaled_inverse_volume;
    for (int m = 0; m < gradient_modes; ++m) f.sum[m] = f.sum[m] + mean_pressure_force * b.beta[m];
    corner_forces(f, forces);
    increment.strain_rate_squared = strain_rate_squared(scaled_l, scaled_inverse_volume);
    increment.frequency_squared =
        spectrum.uniform + distortion_excess(moduli, trace_g, gradient_square, volume, inverse_mass);
    increment.stable_step =
        where(is_valid, damped_stable_step(increment.frequency_squared, viscosity.damping), T(-1.0));
    return increment;
  }

  template <class Law>
  ElementSample sample(const NodalMotion<double, 8>&, const Law&, const Header<double, Law>& header,
                       const Point<double, Law>* point) const {
    ElementSample result{.internal_energy = header.internal_energy};
    result.stress = isotropic(0.0);
    for (int p = 0; p < hexahedron_points; ++p)
      result.stress = result.stress + (1.0 / hexahedron_points) * fixed_stress(point[p]);
    return result;
  }
  template <class Law>
  void complete(const NodalMotion<double, 8>& motion, const Header<double, Law>&, const Point<double, Law>*,
                ElementSample& sample) const {
    sample.volume = mean_gradient(modes(motion.position)).volume;
  }

 private:
  // Of a point with next to no volume left, as a share of that of the mean point, the strain of one step is
  // more than can be followed: N beyond this, a strain of 1.
  static constexpr double least_volume_share = 1e-9, most_step = 0.5;

  template <class T>
  static BRIO_INLINE T square(const Tensor<T>& a) {
    T sum(0.0);
    for (const auto& row : a.m)
      for (const T& component : row) sum += component * component;
    return sum;
  }
  /// Zero elsewhere.
  template <class T>
  static BRIO_INLINE void keep(const MaskOf<T>& where_kept, Tensor<T>& a) {
    for (auto& row : a.m)
      for (T& component : row) component = where(where_kept, component, T(0.0));
  }

  /// sum_k df/dxi_k (x) dxi_k/dx; both carry a factor that `inverse` = 1/determinant takes out.
  template <class T>
  static BRIO_INLINE Tensor<T> point_gradient(const ReferenceGradient<T>& f, const PointGeometry<T>& geometry,
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
  static BRIO_INLINE ReferenceGradient<T> flux(const SymmetricTensor<T>& stress,
                                               const PointGeometry<T>& geometry) {
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
  static BRIO_INLINE T weighted_square(const PointGeometry<T>& geometry, const double xi[3]) {
    const auto& c = geometry.cofactor;
    const T diagonal = dot(c[0], c[0]) + dot(c[1], c[1]) + dot(c[2], c[2]);
    const T beside = T(xi[0] * xi[1]) * dot(c[0], c[1]) + T(xi[1] * xi[2]) * dot(c[1], c[2]) +
                     T(xi[2] * xi[0]) * dot(c[2], c[0]);
    return (64.0 * point_volume / 8.0) * ((16.0 / 9.0) * diagonal + (8.0 / 3.0) * beside);
  }

  template <class T>
  static BRIO_INLINE void corner_forces(const HexahedronModes<T>& f, NodalForces<T, 8>& forces) {
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
  static BRIO_INLINE T distortion_excess(const ElasticModuli<T>& moduli, T trace_g, T gradient_square,
                                         T volume, T inverse_mass) {
    constexpr double factor = 1.5;
    const T excess = max(gradient_square - (16.0 / 9.0) * volume * trace_g, T(0.0));
    return (8.0 * 2.0 * factor) * inverse_mass * moduli.shear * excess;
  }
};

}  // namespace brio
