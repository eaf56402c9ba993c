#pragma once
/// Logarithmic strain of elements, of their middle, from where their nodes were and are, and its rate from
/// their velocities.

#include <span>

#include "src/base/tensor.hpp"

namespace brio {

/// Hencky strain ln V of a deformation gradient F = V R; not a number where F is singular.
SymmetricTensor<double> logarithmic_strain(const Tensor<double>& deformation_gradient);

/// Deformation gradient in the middle of a hexahedron. \param before, now eight corners, x y z
Tensor<double> deformation_of_hexahedron(std::span<const Vector3d> before, std::span<const Vector3d> now);
/// In the middle of the middle surface of a shell of four corners, its normal stretched as its thickness.
Tensor<double> deformation_of_shell(std::span<const Vector3d> before, std::span<const Vector3d> now,
                                    double thickness_stretch);

/// Rate of deformation D in the middle of a hexahedron; not a number where it has no volume.
/// \param now, velocity of eight corners
SymmetricTensor<double> strain_rate_of_hexahedron(std::span<const Vector3d> now,
                                                  std::span<const Vector3d> velocity);
/// In the middle surface of a shell of four corners: nothing along the normal.
SymmetricTensor<double> strain_rate_of_shell(std::span<const Vector3d> now,
                                             std::span<const Vector3d> velocity);

}  // namespace brio
