#pragma once
/// Rotations as quaternions, on lanes.

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
};
}  // namespace brio
