#pragma once
/// Small vectors and tensors on a number-like `T` (see lanes.hpp). Symmetric tensors are stored in VTK's
/// order.

#include <array>

#include "src/base/lanes.hpp"

namespace brio {

/// As decks, results and balances hold a vector.
using Vector = std::array<double, 3>;

template <class T>
struct Vector3 {
  T x, y, z;

  friend BRIO_INLINE Vector3 operator+(const Vector3& a, const Vector3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend BRIO_INLINE Vector3 operator-(const Vector3& a, const Vector3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend BRIO_INLINE Vector3 operator*(T s, const Vector3& a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <class T>
BRIO_INLINE T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
BRIO_INLINE Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// xx yy zz xy yz xz; shear entries are tensor components, not engineering strains.
template <class T>
struct SymmetricTensor {
  T xx, yy, zz, xy, yz, xz;

  friend BRIO_INLINE SymmetricTensor operator+(const SymmetricTensor& a, const SymmetricTensor& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.xz + b.xz};
  }
  friend BRIO_INLINE SymmetricTensor operator-(const SymmetricTensor& a, const SymmetricTensor& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.yz - b.yz, a.xz - b.xz};
  }
  friend BRIO_INLINE SymmetricTensor operator*(T s, const SymmetricTensor& a) {
    return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.yz, s * a.xz};
  }
};

template <class T>
BRIO_INLINE T trace(const SymmetricTensor<T>& a) {
  return a.xx + a.yy + a.zz;
}
/// a : b
template <class T>
BRIO_INLINE T contract(const SymmetricTensor<T>& a, const SymmetricTensor<T>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.xy * b.xy + a.yz * b.yz + a.xz * b.xz);
}
template <class T>
BRIO_INLINE SymmetricTensor<T> deviator(const SymmetricTensor<T>& a) {
  const T mean = trace(a) * (1.0 / 3.0);
  return {a.xx - mean, a.yy - mean, a.zz - mean, a.xy, a.yz, a.xz};
}
template <class T>
BRIO_INLINE SymmetricTensor<T> isotropic(T value) {
  return {value, value, value, T(0.0), T(0.0), T(0.0)};
}

template <class T>
BRIO_INLINE Vector3<T> operator*(const SymmetricTensor<T>& a, const Vector3<T>& b) {
  return {a.xx * b.x + a.xy * b.y + a.xz * b.z, a.xy * b.x + a.yy * b.y + a.yz * b.z,
          a.xz * b.x + a.yz * b.y + a.zz * b.z};
}

/// Row-major 3x3 tensor: m[i][j].
template <class T>
struct Tensor {
  T m[3][3];

  BRIO_INLINE T& operator()(int i, int j) { return m[i][j]; }
  BRIO_INLINE const T& operator()(int i, int j) const { return m[i][j]; }
};

template <class T>
BRIO_INLINE Tensor<T> operator*(const Tensor<T>& a, const Tensor<T>& b) {
  Tensor<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
  return c;
}
template <class T>
BRIO_INLINE Tensor<T> operator*(T s, const Tensor<T>& a) {
  Tensor<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = s * a.m[i][j];
  return c;
}
template <class T>
BRIO_INLINE Tensor<T> full(const SymmetricTensor<T>& s) {
  return {{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
}
template <class T>
BRIO_INLINE Tensor<T> transposed(const Tensor<T>& a) {
  return {{{a.m[0][0], a.m[1][0], a.m[2][0]},
           {a.m[0][1], a.m[1][1], a.m[2][1]},
           {a.m[0][2], a.m[1][2], a.m[2][2]}}};
}
template <class T>
BRIO_INLINE Tensor<T> identity() {
  Tensor<T> one;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) one.m[i][j] = T(i == j ? 1.0 : 0.0);
  return one;
}
template <class T>
BRIO_INLINE T trace(const Tensor<T>& a) {
  return a.m[0][0] + a.m[1][1] + a.m[2][2];
}
template <class T>
BRIO_INLINE SymmetricTensor<T> symmetric_part(const Tensor<T>& a) {
  return {a.m[0][0],
          a.m[1][1],
          a.m[2][2],
          0.5 * (a.m[0][1] + a.m[1][0]),
          0.5 * (a.m[1][2] + a.m[2][1]),
          0.5 * (a.m[0][2] + a.m[2][0])};
}

}  // namespace brio
