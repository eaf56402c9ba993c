#pragma once
/// Small vectors and tensors on a number-like `T` (see lanes.hpp). Symmetric tensors are stored in VTK's
/// order.

#include <algorithm>
#include <cmath>
#include <concepts>

#include "src/base/lanes.hpp"

namespace brio {

template <class T>
struct Vector3 {
  T x, y, z;
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  BRIO_INLINE T& operator[](std::integral auto i) { return reinterpret_cast<T*>(this)[i]; }
  BRIO_INLINE const T& operator[](std::integral auto i) const { return reinterpret_cast<const T*>(this)[i]; }
  BRIO_INLINE T* data() { return &x; }
  BRIO_INLINE const T* data() const { return &x; }
  BRIO_INLINE T* begin() { return data(); }
  BRIO_INLINE T* end() { return data() + 3; }
  BRIO_INLINE const T* begin() const { return data(); }
  BRIO_INLINE const T* end() const { return data() + 3; }
  static constexpr std::size_t size() { return 3; }

  friend BRIO_INLINE Vector3 operator+(const Vector3& a, const Vector3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend BRIO_INLINE Vector3 operator-(const Vector3& a, const Vector3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend BRIO_INLINE Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
  friend BRIO_INLINE Vector3 operator*(T s, const Vector3& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend BRIO_INLINE Vector3 operator*(const Vector3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend BRIO_INLINE Vector3 operator/(const Vector3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  BRIO_INLINE Vector3& operator+=(const Vector3& a) { return *this = *this + a; }
  BRIO_INLINE Vector3& operator-=(const Vector3& a) { return *this = *this - a; }
  BRIO_INLINE Vector3& operator*=(T s) { return *this = *this * s; }
  BRIO_INLINE Vector3& operator/=(T s) { return *this = *this / s; }
  friend bool operator==(const Vector3&, const Vector3&) = default;
};
using Vector3d = Vector3<double>;
static_assert(sizeof(Vector3d) == 3 * sizeof(double));

BRIO_INLINE Vector3d vector_at(const double* first) { return {first[0], first[1], first[2]}; }

template <class T>
BRIO_INLINE T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
BRIO_INLINE Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
BRIO_INLINE T squared_norm(const Vector3<T>& a) {
  return dot(a, a);
}
inline double norm(const Vector3d& a) { return std::sqrt(squared_norm(a)); }
/// Of unit length; zero stays zero.
inline Vector3d normalized(const Vector3d& a) {
  const double squared = squared_norm(a);
  return squared > 0 ? a / std::sqrt(squared) : a;
}
constexpr bool is_zero(const Vector3d& a) { return a.x == 0 && a.y == 0 && a.z == 0; }
/// At right angles to a unit vector.
inline Vector3d unit_at_right_angles(const Vector3d& a) {
  return normalized(std::abs(a.x) < std::abs(a.z) ? cross({1, 0, 0}, a) : cross({0, 0, 1}, a));
}
inline bool is_finite(const Vector3d& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
inline Vector3d absolute(const Vector3d& a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }
inline Vector3d minimum(const Vector3d& a, const Vector3d& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vector3d maximum(const Vector3d& a, const Vector3d& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
inline Vector3d componentwise_product(const Vector3d& a, const Vector3d& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline double largest_component(const Vector3d& a) { return std::max(std::max(a.x, a.y), a.z); }
inline double maximum_norm(const Vector3d& a) { return largest_component(absolute(a)); }

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

  BRIO_INLINE T& operator()(std::integral auto i, std::integral auto j) { return m[i][j]; }
  BRIO_INLINE const T& operator()(std::integral auto i, std::integral auto j) const { return m[i][j]; }
  // Constant, so that nothing is assigned to a copy.
  BRIO_INLINE const Vector3<T> row(std::integral auto i) const { return {m[i][0], m[i][1], m[i][2]}; }
  BRIO_INLINE const Vector3<T> column(std::integral auto j) const { return {m[0][j], m[1][j], m[2][j]}; }
  BRIO_INLINE void set_row(std::integral auto i, const Vector3<T>& a) {
    for (int j = 0; j < 3; ++j) m[i][j] = a[j];
  }
  BRIO_INLINE void set_column(std::integral auto j, const Vector3<T>& a) {
    for (int i = 0; i < 3; ++i) m[i][j] = a[i];
  }
  friend bool operator==(const Tensor&, const Tensor&) = default;
};

template <class T>
BRIO_INLINE Tensor<T> operator+(const Tensor<T>& a, const Tensor<T>& b) {
  Tensor<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][j] + b.m[i][j];
  return c;
}
template <class T>
BRIO_INLINE Tensor<T> operator-(const Tensor<T>& a, const Tensor<T>& b) {
  Tensor<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][j] - b.m[i][j];
  return c;
}
template <class T>
BRIO_INLINE Tensor<T>& operator+=(Tensor<T>& a, const Tensor<T>& b) {
  return a = a + b;
}
template <class T>
BRIO_INLINE Vector3<T> operator*(const Tensor<T>& a, const Vector3<T>& b) {
  return {dot(a.row(0), b), dot(a.row(1), b), dot(a.row(2), b)};
}
/// The transpose of a tensor times a vector.
template <class T>
BRIO_INLINE Vector3<T> transposed_times(const Tensor<T>& a, const Vector3<T>& b) {
  return {dot(a.column(0), b), dot(a.column(1), b), dot(a.column(2), b)};
}
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
/// a : b
template <class T>
BRIO_INLINE T contract(const Tensor<T>& a, const Tensor<T>& b) {
  T sum = a.m[0][0] * b.m[0][0];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i + j > 0) sum += a.m[i][j] * b.m[i][j];
  return sum;
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
/// a b^T
inline Tensor<double> outer_product(const Vector3d& a, const Vector3d& b) {
  return {{{a.x * b.x, a.x * b.y, a.x * b.z},
           {a.y * b.x, a.y * b.y, a.y * b.z},
           {a.z * b.x, a.z * b.y, a.z * b.z}}};
}
/// What times b is the cross product of a and b.
inline Tensor<double> cross_matrix(const Vector3d& a) {
  return {{{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}}};
}
inline Tensor<double> diagonal(const Vector3d& a) { return {{{a.x, 0, 0}, {0, a.y, 0}, {0, 0, a.z}}}; }
inline double squared_norm(const Tensor<double>& a) {
  return squared_norm(a.row(0)) + squared_norm(a.row(1)) + squared_norm(a.row(2));
}
/// Of Frobenius.
inline double norm(const Tensor<double>& a) { return std::sqrt(squared_norm(a)); }
inline double determinant(const Tensor<double>& a) { return dot(a.row(0), cross(a.row(1), a.row(2))); }
/// Not of a singular tensor.
inline Tensor<double> inverse(const Tensor<double>& a) {
  const double factor = 1 / determinant(a);
  Tensor<double> result;
  result.set_column(0, factor * cross(a.row(1), a.row(2)));
  result.set_column(1, factor * cross(a.row(2), a.row(0)));
  result.set_column(2, factor * cross(a.row(0), a.row(1)));
  return result;
}
/// Moments of inertia of a unit mass at an arm.
inline Tensor<double> inertia_of_point(const Vector3d& arm) {
  return squared_norm(arm) * identity<double>() - outer_product(arm, arm);
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
