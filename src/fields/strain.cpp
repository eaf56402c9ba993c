#include "src/fields/strain.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace brio {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Signs of the natural coordinates of the corners of a hexahedron; the first four are those of a shell.
constexpr double corner_sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

Vector3d tangent(std::span<const Vector3d> corners, std::size_t axis) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) sum += corner_sign[k][axis] * corners[k];
  return sum;
}

Matrix3d jacobian(std::span<const Vector3d> corners) {
  Matrix3d columns;
  for (std::size_t axis = 0; axis < 3; ++axis)
    columns.col(static_cast<Eigen::Index>(axis)) = tangent(corners, axis);
  return columns;
}

Matrix3d frame_of_shell(std::span<const Vector3d> corners, double normal_length) {
  Matrix3d columns;
  columns.col(0) = tangent(corners, 0);
  columns.col(1) = tangent(corners, 1);
  columns.col(2) = normal_length * columns.col(0).cross(columns.col(1)).normalized();
  return columns;
}

}  // namespace

SymmetricTensor<double> logarithmic_strain(const Matrix3d& deformation_gradient) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(deformation_gradient *
                                                      deformation_gradient.transpose());
  Matrix3d strain = Matrix3d::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double square = eigen.eigenvalues()[k];
    const Vector3d direction = eigen.eigenvectors().col(k);
    strain += (square > 0 ? 0.5 * std::log(square) : std::numeric_limits<double>::quiet_NaN()) * direction *
              direction.transpose();
  }
  return {strain(0, 0), strain(1, 1), strain(2, 2), strain(0, 1), strain(1, 2), strain(0, 2)};
}

Matrix3d deformation_of_hexahedron(std::span<const Vector3d> before, std::span<const Vector3d> now) {
  return jacobian(now) * jacobian(before).inverse();
}

Matrix3d deformation_of_shell(std::span<const Vector3d> before, std::span<const Vector3d> now,
                              double thickness_stretch) {
  return frame_of_shell(now, thickness_stretch) * frame_of_shell(before, 1).inverse();
}

}  // namespace brio
