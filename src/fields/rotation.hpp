#pragma once
/// Rotations as vectors, and as a field of points.

#include "elements/base/quaternion.hpp"
#include "src/base/tensor.hpp"
#include "src/fields/point_variable.hpp"

namespace brio {

/// Axis times angle, which is at most pi.
Vector3d rotation_vector(const Quaternion<double>& rotation);

/// Of scenes with shells or beams whose deck names it, `output.fields.variables`.
const PointVariable& rotation_variable();

}  // namespace brio
