#pragma once
/// Orientation of four points with the exact sign: floating-point arithmetic where its error bound decides,
/// expansion arithmetic elsewhere (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast
/// robust geometric predicates").

#include "src/base/tensor.hpp"

namespace brio {

/// Bound of the rounding error of the determinant of three differences, over the permanent of their absolute
/// values (Shewchuk's bound A of orient3d, 7 + 56 units in 2^-53, rounded up).
inline constexpr double orientation_error = 8 * 0x1p-53;

/// Sign of the determinant (b - a, c - a, d - a), six times the volume of the tetrahedron: 1, 0 or -1, as in
/// exact arithmetic. \pre coordinates are 0 or between 1e-60 and 1e60 in size: no product leaves the range
int orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d);

/// The same without trying floating-point arithmetic first.
int exact_orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d);

}  // namespace brio
