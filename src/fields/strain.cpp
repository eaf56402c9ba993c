#include "src/fields/strain.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "contact/geometry/eigen_conversions.hpp"

namespace brio {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// Signs of the natural coordinates of the corners of a hexahedron; the first four are those of a shell.
constexpr double corner_sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

Vector3d tangent(std::span<const Vector3d> corners, std::size_t axis) {
  Vector3d sum{};
  for (std::size_t k = 0; k < corners.size(); ++k) sum += corner_sign[k][axis] * corners[k];
  return sum;
}

Tensor<double> jacobian(std::span<const Vector3d> corners) {
  Tensor<double> columns;
  for (std::size_t axis = 0; axis < 3; ++axis) columns.set_column(axis, tangent(corners, axis));
  return columns;
}

Tensor<double> frame_of_shell(std::span<const Vector3d> corners, double normal_length) {
  Tensor<double> columns;
  columns.set_column(0, tangent(corners, 0));
  columns.set_column(1, tangent(corners, 1));
  columns.set_column(2, normal_length * normalized(cross(columns.column(0), columns.column(1))));
  return columns;
}

/// Of a velocity gradient on the directions that are left by a projection.
SymmetricTensor<double> symmetric_within(const Tensor<double>& projection, const Tensor<double>& gradient) {
  for (int row = 0; row < 3; ++row)
    if (!is_finite(gradient.row(row)))
      return {undefined, undefined, undefined, undefined, undefined, undefined};
  return symmetric_part(projection * (0.5 * (gradient + transposed(gradient))) * projection);
}

}  // namespace

SymmetricTensor<double> logarithmic_strain(const Tensor<double>& deformation_gradient) {
  const PrincipalAxes principal = principal_axes(deformation_gradient * transposed(deformation_gradient));
  Tensor<double> strain{};
  for (int k = 0; k < 3; ++k) {
    const double square = principal.value[k];
    const Vector3d direction = principal.axis.column(k);
    strain += (square > 0 ? 0.5 * std::log(square) : undefined) * outer_product(direction, direction);
  }
  return symmetric_part(strain);
}

Tensor<double> deformation_of_hexahedron(std::span<const Vector3d> before, std::span<const Vector3d> now) {
  return jacobian(now) * inverse(jacobian(before));
}

Tensor<double> deformation_of_shell(std::span<const Vector3d> before, std::span<const Vector3d> now,
                                    double thickness_stretch) {
  return frame_of_shell(now, thickness_stretch) * inverse(frame_of_shell(before, 1));
}

SymmetricTensor<double> strain_rate_of_hexahedron(std::span<const Vector3d> now,
                                                  std::span<const Vector3d> velocity) {
  return symmetric_within(identity<double>(), jacobian(velocity) * inverse(jacobian(now)));
}

SymmetricTensor<double> strain_rate_of_shell(std::span<const Vector3d> now,
                                             std::span<const Vector3d> velocity) {
  const Tensor<double> frame = frame_of_shell(now, 1);
  Tensor<double> rates{};
  for (std::size_t axis = 0; axis < 2; ++axis) rates.set_column(axis, tangent(velocity, axis));
  const Vector3d normal = frame.column(2);
  return symmetric_within(identity<double>() - outer_product(normal, normal), rates * inverse(frame));
}

}  // namespace brio
