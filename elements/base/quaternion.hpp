#pragma once
/// Rotations as quaternions, on lanes.

#include <cmath>

#include "src/base/tensor.hpp"

namespace brio {

/// Rotation by unit quaternion: scalar and vector part.
template <class T>
struct Quaternion {
  T w, x, y, z;

  friend BRIO_INLINE Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z, a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x};
  }
  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};
inline constexpr Quaternion<double> no_rotation{1, 0, 0, 0};

template <class T>
BRIO_INLINE Vector3<T> vector_part(const Quaternion<T>& q) {
  return {q.x, q.y, q.z};
}
template <class T>
BRIO_INLINE T squared_length(const Quaternion<T>& q) {
  return q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
}
template <class T>
BRIO_INLINE Quaternion<T> scaled(const T& scale, const Quaternion<T>& q) {
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}
template <class T>
BRIO_INLINE Quaternion<T> conjugate(const Quaternion<T>& q) {
  return {q.w, -q.x, -q.y, -q.z};
}
template <class T>
BRIO_INLINE Vector3<T> rotated(const Quaternion<T>& q, const Vector3<T>& d) {
  const Vector3<T> v = vector_part(q);
  const Vector3<T> twice = T(2.0) * cross(v, d);
  return d + q.w * twice + cross(v, twice);
}

/// Rotation matrix of a quaternion of any length. \param twice_inverse_square 2 / |q|^2.
template <class T>
BRIO_INLINE Tensor<T> rotation_matrix(const Quaternion<T>& q, T twice_inverse_square) {
  const T sx = twice_inverse_square * q.x, sy = twice_inverse_square * q.y, sz = twice_inverse_square * q.z;
  const T xx = sx * q.x, yy = sy * q.y, zz = sz * q.z, xy = sx * q.y, yz = sy * q.z, xz = sx * q.z;
  const T wx = sx * q.w, wy = sy * q.w, wz = sz * q.w;
  const T one(1.0);
  return {{{one - (yy + zz), xy - wz, xz + wy},
           {xy + wz, one - (xx + zz), yz - wx},
           {xz - wy, yz + wx, one - (xx + yy)}}};
}

inline Tensor<double> rotation_matrix(const Quaternion<double>& unit) { return rotation_matrix(unit, 2.0); }
inline Quaternion<double> normalized(const Quaternion<double>& q) {
  const double size = std::sqrt(squared_length(q));
  return {q.w / size, q.x / size, q.y / size, q.z / size};
}

/// By the angle |v| about v.
inline Quaternion<double> rotation_by(const Vector3d& v) {
  const double angle = norm(v);
  if (angle == 0) return no_rotation;
  const double share = std::sin(0.5 * angle) / angle;
  return normalized(Quaternion<double>{std::cos(0.5 * angle), share * v.x, share * v.y, share * v.z});
}

}  // namespace brio
