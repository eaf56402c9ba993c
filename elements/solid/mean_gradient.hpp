#pragma once
/// Mean gradient and exact volume of the eight-node hexahedron (Flanagan & Belytschko 1981), in modal form.
///
/// A nodal field is replaced by its sums against the sign patterns of the corners,
///
///     xi  eta  zeta  eta*zeta  zeta*xi  xi*eta  xi*eta*zeta        (corner order of VTK; the constant is
///     dropped)
///
/// In these sums the volume of the trilinear hexahedron has four triple products and the last pattern drops
/// out, so its gradient costs twelve cross products. The last four patterns are the hourglass base vectors:
/// projections on them cost nothing more. With V = volume, b_iI = dV/dx_iI = V B_iI and f_m the sum of
/// pattern m over a nodal field f,
///
///     b_I = sum_m pattern_m(I) beta_m / 64,     V = x_m . beta_m / (64 * 3),     V sum_I f_I B_I = sum_m f_m
///     beta_m / 64

#include "src/base/tensor.hpp"

namespace brio {

inline constexpr int linear_modes = 3;
inline constexpr int gradient_modes = 6;
inline constexpr int hexahedron_modes = 7;
inline constexpr int hourglass_modes = 4;

/// Sums of a nodal vector field against the corner patterns, [pattern].
template <class T>
struct HexahedronModes {
  Vector3<T> sum[hexahedron_modes];
};

/// Differences are formed first, so that nothing is lost far from the origin.
/// \param f values at the eight corners; \param s sums against the seven patterns.
template <class T>
BRIO_INLINE void pattern_sums(const T f[8], T s[hexahedron_modes]) {
  const T low_01 = f[1] - f[0], low_32 = f[2] - f[3], low_03 = f[3] - f[0];
  const T high_45 = f[5] - f[4], high_76 = f[6] - f[7], high_47 = f[7] - f[4];
  const T low_xi = low_32 + low_01, low_xi_eta = low_32 - low_01;
  const T high_xi = high_76 + high_45, high_xi_eta = high_76 - high_45;
  const T low_eta = 2.0 * low_03 + low_xi_eta;
  const T high_eta = 2.0 * high_47 + high_xi_eta;
  s[0] = high_xi + low_xi;
  s[1] = high_eta + low_eta;
  s[4] = high_xi - low_xi;
  s[2] = 4.0 * (f[4] - f[0]) + (s[4] + 2.0 * (high_47 - low_03));
  s[3] = high_eta - low_eta;
  s[5] = high_xi_eta + low_xi_eta;
  s[6] = high_xi_eta - low_xi_eta;
}

/// The transpose: corner values of a combination of the patterns.
template <class T>
BRIO_INLINE void corner_values(const T s[hexahedron_modes], T f[8]) {
  const T high_xi = s[0] + s[4], low_xi = s[0] - s[4];
  const T high_eta = s[1] + s[3], low_eta = s[1] - s[3];
  const T high_xi_eta = s[5] + s[6], low_xi_eta = s[5] - s[6];
  const T a = low_eta + low_xi_eta, b = low_eta - low_xi_eta;  // times xi = +1 and xi = -1
  const T c = high_eta + high_xi_eta, d = high_eta - high_xi_eta;
  const T low_plus = low_xi - s[2], low_minus = -(low_xi + s[2]);
  const T high_plus = high_xi + s[2], high_minus = s[2] - high_xi;
  f[0] = low_minus - b;
  f[1] = low_plus - a;
  f[2] = low_plus + a;
  f[3] = low_minus + b;
  f[4] = high_minus - d;
  f[5] = high_plus - c;
  f[6] = high_plus + c;
  f[7] = high_minus + d;
}

template <class T>
BRIO_INLINE HexahedronModes<T> modes(const T field[3][8]) {
  T x[hexahedron_modes], y[hexahedron_modes], z[hexahedron_modes];
  pattern_sums(field[0], x);
  pattern_sums(field[1], y);
  pattern_sums(field[2], z);
  HexahedronModes<T> result;
  for (int m = 0; m < hexahedron_modes; ++m) result.sum[m] = {x[m], y[m], z[m]};
  return result;
}

/// beta of the file comment, and the volume.
template <class T>
struct MeanGradient {
  Vector3<T> beta[gradient_modes];
  T volume;
};

/// The factor between beta and the derivative of the volume.
inline constexpr double gradient_scale = 1.0 / 64.0;

template <class T>
BRIO_INLINE MeanGradient<T> mean_gradient(const HexahedronModes<T>& x) {
  const Vector3<T>* linear = x.sum;
  const Vector3<T>* bilinear = x.sum + linear_modes;
  Vector3<T> third[3];
  for (int k = 0; k < 3; ++k) third[k] = T(1.0 / 3.0) * bilinear[k];
  MeanGradient<T> gradient;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    gradient.beta[k] = cross(linear[next], linear[last]) + cross(third[last], bilinear[next]);
    gradient.beta[linear_modes + k] = cross(linear[last], third[next]) + cross(third[last], linear[next]);
  }
  T sum = x.sum[0].x * gradient.beta[0].x;
  for (int m = 1; m < gradient_modes; ++m) sum += x.sum[m].x * gradient.beta[m].x;
  gradient.volume = gradient_scale * sum;
  return gradient;
}

/// 64 V sum_I f_I (x) B_I: the mean gradient df_i/dx_j of a nodal vector field, times 64 V.
template <class T>
BRIO_INLINE Tensor<T> scaled_gradient_of(const HexahedronModes<T>& f, const MeanGradient<T>& b) {
  Vector3<T> row[3];
  row[0] = f.sum[0].x * b.beta[0];
  row[1] = f.sum[0].y * b.beta[0];
  row[2] = f.sum[0].z * b.beta[0];
  for (int m = 1; m < gradient_modes; ++m) {
    row[0] = row[0] + f.sum[m].x * b.beta[m];
    row[1] = row[1] + f.sum[m].y * b.beta[m];
    row[2] = row[2] + f.sum[m].z * b.beta[m];
  }
  return {{{row[0].x, row[0].y, row[0].z}, {row[1].x, row[1].y, row[1].z}, {row[2].x, row[2].y, row[2].z}}};
}

/// G_ij = sum_I B_iI B_jI, 1/length^2.
template <class T>
BRIO_INLINE SymmetricTensor<T> gradient_product(const MeanGradient<T>& b, T scaled_inverse_volume) {
  SymmetricTensor<T> g = isotropic(T(0.0));
  for (const Vector3<T>& a : b.beta) {
    g.xx += a.x * a.x;
    g.yy += a.y * a.y;
    g.zz += a.z * a.z;
    g.xy += a.x * a.y;
    g.yz += a.y * a.z;
    g.xz += a.x * a.z;
  }
  return (8.0 * square(scaled_inverse_volume)) * g;
}

}  // namespace brio
