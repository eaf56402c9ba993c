#pragma once
/// Between Eigen's vectors and those of the kernels.

#include <Eigen/Dense>

#include "src/base/tensor.hpp"

namespace brio {

inline Vector3<double> components(const Eigen::Vector3d& a) { return {a[0], a[1], a[2]}; }
inline Eigen::Vector3d eigen(const Vector3<double>& a) { return {a.x, a.y, a.z}; }

}  // namespace brio
