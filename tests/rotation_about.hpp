#pragma once
/// Rotation matrices of tests.

#include "elements/base/quaternion.hpp"

namespace brio::test {

/// By an angle in radian, about an axis of any length.
inline Tensor<double> rotation_about(double angle, const Vector3d& axis) {
  return rotation_matrix(rotation_by(angle * normalized(axis)));
}

}  // namespace brio::test
