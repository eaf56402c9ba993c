#pragma once
/// Principal values of a symmetric tensor and their directions, on lanes, by Jacobi's rotations: equal values
/// need no care, and the directions are unit vectors to round-off whatever the tensor.

#include "src/base/tensor.hpp"

namespace brio {

template <class T>
struct PrincipalAxes {
  Vector3<T> value;
  Tensor<T> direction;  ///< columns: unit vectors, in the order of the values
};
template <class T>
struct PrincipalValue {
  T value;
  Vector3<T> direction;  ///< unit length; any of those that there are where values are equal
};

namespace detail {

/// Turns rows and columns p and q of `a` so that a_pq becomes 0; the columns of `v` turn along.
template <class T>
BRIO_INLINE void rotate_to_zero(Tensor<T>& a, Tensor<T>& v, int p, int q) {
  const int r = 3 - p - q;
  const T twice = 2.0 * a.m[p][q];
  const T difference = a.m[q][q] - a.m[p][p];
  const T root = sqrt(square(difference) + square(twice));
  // The smaller of the two angles: t = tan, |t| <= 1.
  const T base = abs(difference) + root;
  const T size = twice / where(base > T(0.0), base, T(1.0));
  const T t = where(difference < T(0.0), -size, size);
  const T c = 1.0 / sqrt(1.0 + square(t));
  const T s = t * c;
  const T shift = 0.5 * t * twice;
  a.m[p][p] = a.m[p][p] - shift;
  a.m[q][q] = a.m[q][q] + shift;
  a.m[p][q] = a.m[q][p] = T(0.0);
  const T rp = a.m[r][p], rq = a.m[r][q];
  a.m[r][p] = a.m[p][r] = c * rp - s * rq;
  a.m[r][q] = a.m[q][r] = s * rp + c * rq;
  for (int i = 0; i < 3; ++i) {
    const T vp = v.m[i][p], vq = v.m[i][q];
    v.m[i][p] = c * vp - s * vq;
    v.m[i][q] = s * vp + c * vq;
  }
}

template <class T>
BRIO_INLINE T largest_component(const SymmetricTensor<T>& a) {
  const T normal = max(abs(a.xx), max(abs(a.yy), abs(a.zz)));
  return max(normal, max(abs(a.xy), max(abs(a.yz), abs(a.xz))));
}

}  // namespace detail

/// \param a finite
template <class T>
BRIO_INLINE PrincipalAxes<T> principal_axes(const SymmetricTensor<T>& a) {
  constexpr int sweeps =
      5;  // converge as the square from the second on; three suffice for almost all tensors
  const T largest = detail::largest_component(a);
  // Squares must neither overflow nor vanish.
  const T unit = where(largest > T(0.0), largest, T(1.0));
  const SymmetricTensor<T> s = (1.0 / unit) * a;
  Tensor<T> m{{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
  Tensor<T> v = identity<T>();
#pragma GCC unroll 1
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    detail::rotate_to_zero(m, v, 0, 1);
    detail::rotate_to_zero(m, v, 0, 2);
    detail::rotate_to_zero(m, v, 1, 2);
  }
  return {{unit * m.m[0][0], unit * m.m[1][1], unit * m.m[2][2]}, v};
}

/// \param a finite
template <class T>
BRIO_INLINE PrincipalValue<T> largest_principal(const SymmetricTensor<T>& a) {
  const PrincipalAxes<T> axes = principal_axes(a);
  const Tensor<T>& v = axes.direction;
  const T value[3] = {axes.value.x, axes.value.y, axes.value.z};
  PrincipalValue<T> result{value[0], {v.m[0][0], v.m[1][0], v.m[2][0]}};
  for (int k = 1; k < 3; ++k) {
    const auto above = value[k] > result.value;
    result.value = where(above, value[k], result.value);
    result.direction = {where(above, v.m[0][k], result.direction.x),
                        where(above, v.m[1][k], result.direction.y),
                        where(above, v.m[2][k], result.direction.z)};
  }
  return result;
}

/// n . a . n
template <class T>
BRIO_INLINE T along(const SymmetricTensor<T>& a, const Vector3<T>& n) {
  return a.xx * square(n.x) + a.yy * square(n.y) + a.zz * square(n.z) +
         2.0 * (a.xy * n.x * n.y + a.yz * n.y * n.z + a.xz * n.x * n.z);
}

}  // namespace brio
