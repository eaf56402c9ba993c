#pragma once
/// Vectors and tensors for what Eigen solves, and back.

#include <Eigen/Dense>

#include "src/base/tensor.hpp"

namespace brio {

inline Eigen::Vector3d to_eigen(const Vector3d& a) { return {a.x, a.y, a.z}; }
inline Eigen::Matrix3d to_eigen(const Tensor<double>& a) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&a.m[0][0]);
}
inline Vector3d to_vector(const Eigen::Vector3d& a) { return {a[0], a[1], a[2]}; }
inline Tensor<double> to_tensor(const Eigen::Matrix3d& a) {
  Tensor<double> result;
  for (int i = 0; i < 3; ++i) result.set_row(i, to_vector(a.row(i)));
  return result;
}

/// Of a symmetric tensor.
struct PrincipalAxes {
  Vector3d value;       ///< ascending
  Tensor<double> axis;  ///< columns: unit vectors
};
inline PrincipalAxes principal_axes(const Tensor<double>& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(to_eigen(symmetric));
  return {to_vector(eigen.eigenvalues()), to_tensor(eigen.eigenvectors())};
}

}  // namespace brio
