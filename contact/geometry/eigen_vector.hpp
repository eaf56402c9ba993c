#pragma once
/// Between Eigen's vectors and tensors and those of the kernels.

#include <Eigen/Dense>

#include "src/base/tensor.hpp"

namespace brio {

inline Vector3<double> components(const Eigen::Vector3d& a) { return {a[0], a[1], a[2]}; }
inline Vector3<double> components(const double* a) { return {a[0], a[1], a[2]}; }
inline Tensor<double> tensor_components(const Eigen::Matrix3d& a) {
  Tensor<double> t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.m[i][j] = a(i, j);
  return t;
}
inline SymmetricTensor<double> symmetric_components(const Eigen::Matrix3d& a) {
  return {a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(1, 2), a(0, 2)};
}
inline Eigen::Vector3d eigen(const Vector3<double>& a) { return {a.x, a.y, a.z}; }

}  // namespace brio
