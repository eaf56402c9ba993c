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

SymmetricTensor<double> components(const Matrix3d& a) {
  return {a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(1, 2), a(0, 2)};
}

/// Of a velocity gradient on the directions that are left by a projection.
SymmetricTensor<double> symmetric_within(const Matrix3d& projection, const Matrix3d& gradient) {
  if (!gradient.allFinite()) return components(Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  return components(projection * (0.5 * (gradient + gradient.transpose())) * projection);
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
  return components(strain);
}

Matrix3d deformation_of_hexahedron(std::span<const Vector3d> before, std::span<const Vector3d> now) {
  return jacobian(now) * jacobian(before).inverse();
}

Matrix3d deformation_of_shell(std::span<const Vector3d> before, std::span<const Vector3d> now,
                              double thickness_stretch) {
  return frame_of_shell(now, thickness_stretch) * frame_of_shell(before, 1).inverse();
}

SymmetricTensor<double> strain_rate_of_hexahedron(std::span<const Vector3d> now,
                                                  std::span<const Vector3d> velocity) {
  return symmetric_within(Matrix3d::Identity(), jacobian(velocity) * jacobian(now).inverse());
}

SymmetricTensor<double> strain_rate_of_shell(std::span<const Vector3d> now,
                                             std::span<const Vector3d> velocity) {
  const Matrix3d frame = frame_of_shell(now, 1);
  Matrix3d rates = Matrix3d::Zero();
  for (std::size_t axis = 0; axis < 2; ++axis)
    rates.col(static_cast<Eigen::Index>(axis)) = tangent(velocity, axis);
  const Vector3d normal = frame.col(2);
  return symmetric_within(Matrix3d::Identity() - normal * normal.transpose(), rates * frame.inverse());
}

}  // namespace brio
