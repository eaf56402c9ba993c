#pragma once
/// Rotations as vectors, and as a field of points.

#include <Eigen/Geometry>

#include "src/fields/point_variable.hpp"

namespace brio {

/// Axis times angle, which is at most pi.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation);

/// Of scenes with shells or beams whose deck names it, `output.fields.variables`.
const PointVariable& rotation_variable();

}  // namespace brio
