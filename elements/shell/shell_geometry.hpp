#pragma once
/// Shape of a four-node shell at one instant, seen from its centre.
///
/// The diagonals d1 = x3 - x1 and d2 = x4 - x2 (nodes counted from 1) span the plane of the element; their
/// dual basis b1, b2 gives the mean gradient of any nodal field f as b1 (f3 - f1) + b2 (f4 - f2), which is
/// the one-point gradient of Belytschko, Lin & Tsay (1984). A linear field is met exactly.
///
/// Axes. Stress lives on axes e1, e2 that follow the material: the mean deformation gradient F maps the
/// reference diagonals to the present ones, and e1, e2 is the rotation of its polar decomposition. So the
/// axes do not depend on the numbering of nodes nor on a side or diagonal that shear would turn, there is
/// nothing to integrate in time, and the rate is that of Green and Naghdi in the plane. (The original axes
/// lie along side 1-2 and turn with it when the element is sheared.)

#include "elements/base/motion.hpp"

namespace brio {

template <class T>
BRIO_INLINE Vector3<T> column(const T (&field)[3][4], int node) {
  return {field[0][node], field[1][node], field[2][node]};
}

/// Nodal field as its differences along the diagonals and its hourglass part f1 - f2 + f3 - f4.
template <class T>
struct DiagonalParts {
  Vector3<T> difference[2];
  Vector3<T> alternating;
};
template <class T>
BRIO_INLINE DiagonalParts<T> diagonal_parts(const T (&field)[3][4]) {
  const Vector3<T> f0 = column(field, 0);
  const Vector3<T> f1 = column(field, 1);
  const Vector3<T> f2 = column(field, 2);
  const Vector3<T> f3 = column(field, 3);
  return {{f2 - f0, f3 - f1}, (f0 + f2) - (f1 + f3)};
}

/// Dual basis of the reference diagonals on the initial axes, [diagonal][axis].
template <class T>
struct ReferenceShape {
  T dual[2][2];
};

template <class T>
struct ShellGeometry {
  Vector3<T> axis[2];
  Vector3<T> normal;
  MaskOf<T> is_valid;  ///< has an area; where it has none the numbers are harmless and mean nothing
  T area;
  T inverse_area;
  T diagonal[2][2];  ///< [diagonal][axis], length
  T dual[2][2];      ///< [diagonal][axis], 1/length: gradient of what varies along one diagonal alone
  T skew[2];         ///< hourglass vector x1 - x2 + x3 - x4 in the plane, as multiples of the diagonals; 0:
                     ///< parallelogram
  T warp;            ///< the same vector along the normal; 0 for a flat element
  T stretch[3];      ///< U of the mean deformation gradient: 11, 22, 12
  T inverse_trace;   ///< 1 / tr U
};

/// Square of a length, or of an area, that counts as none.
template <class T>
inline constexpr double vanishing = sizeof(RealOf<T>) == 8 ? 1e-200 : 1e-30;

template <class T>
BRIO_INLINE void set_plane(ShellGeometry<T>& g, const DiagonalParts<T>& x) {
  for (int k = 0; k < 2; ++k)
    for (int a = 0; a < 2; ++a) g.diagonal[k][a] = dot(x.difference[k], g.axis[a]);
  const T inverse_double_area = 0.5 * g.inverse_area;
  g.dual[0][0] = g.diagonal[1][1] * inverse_double_area;
  g.dual[0][1] = -(g.diagonal[1][0] * inverse_double_area);
  g.dual[1][0] = -(g.diagonal[0][1] * inverse_double_area);
  g.dual[1][1] = g.diagonal[0][0] * inverse_double_area;
  const T along[2] = {dot(x.alternating, g.axis[0]), dot(x.alternating, g.axis[1])};
  for (int k = 0; k < 2; ++k) g.skew[k] = g.dual[k][0] * along[0] + g.dual[k][1] * along[1];
  g.warp = dot(x.alternating, g.normal);
}

template <class T>
BRIO_INLINE void set_normal(ShellGeometry<T>& g, const DiagonalParts<T>& x) {
  const Vector3<T> n = cross(x.difference[0], x.difference[1]);
  const T squared = dot(n, n);
  g.is_valid = squared > T(16 * vanishing<T>);
  const T double_area = sqrt(where(g.is_valid, squared, 1.0));
  const T inverse = 1.0 / double_area;
  g.normal = inverse * n;
  g.area = 0.5 * double_area;
  g.inverse_area = 2.0 * inverse;
}

/// Geometry on material axes.
template <class T>
BRIO_INLINE ShellGeometry<T> shell_geometry(const T (&position)[3][4], const ReferenceShape<T>& reference) {
  const DiagonalParts<T> x = diagonal_parts(position);
  ShellGeometry<T> g;
  set_normal(g, x);
  // Images of the initial axes under F; their mean direction is that of the rotation: R ~ F + cof F.
  const Vector3<T> image[2] = {
      reference.dual[0][0] * x.difference[0] + reference.dual[1][0] * x.difference[1],
      reference.dual[0][1] * x.difference[0] + reference.dual[1][1] * x.difference[1]};
  const Vector3<T> mean = image[0] + cross(image[1], g.normal);
  g.inverse_trace = 1.0 / sqrt(max(dot(mean, mean), vanishing<T>));
  g.axis[0] = g.inverse_trace * mean;
  g.axis[1] = cross(g.normal, g.axis[0]);
  g.stretch[0] = dot(image[0], g.axis[0]);
  g.stretch[1] = dot(image[1], g.axis[1]);
  g.stretch[2] = dot(image[0], g.axis[1]);
  set_plane(g, x);
  return g;
}

/// Geometry of the undeformed element; its axes bisect the diagonals, so that renumbering the nodes in a
/// circle turns them by right angles and changes nothing in an isotropic law.
template <class T>
BRIO_INLINE ShellGeometry<T> initial_shell_geometry(const T (&position)[3][4]) {
  const DiagonalParts<T> x = diagonal_parts(position);
  ShellGeometry<T> g;
  set_normal(g, x);
  const T first = 1.0 / sqrt(max(dot(x.difference[0], x.difference[0]), vanishing<T>));
  const T second = 1.0 / sqrt(max(dot(x.difference[1], x.difference[1]), vanishing<T>));
  const Vector3<T> between = first * x.difference[0] - second * x.difference[1];
  g.axis[0] = (1.0 / sqrt(max(dot(between, between), vanishing<T>))) * between;
  g.axis[1] = cross(g.normal, g.axis[0]);
  g.stretch[0] = g.stretch[1] = T(1.0);
  g.stretch[2] = T(0.0);
  g.inverse_trace = T(0.5);
  set_plane(g, x);
  return g;
}

template <class T>
BRIO_INLINE ReferenceShape<T> reference_shape(const ShellGeometry<T>& g) {
  return {{{g.dual[0][0], g.dual[0][1]}, {g.dual[1][0], g.dual[1][1]}}};
}

/// Quantity that is positive in a convex element, not negative in one with a repeated node, negative in
/// others: the smallest of the four corner triangles over the area. Corner areas are halves (1 +- skew) of
/// the plane's area.
template <class T>
BRIO_INLINE T smallest_corner(const ShellGeometry<T>& g) {
  return 0.5 * (1.0 - max(abs(g.skew[0]), abs(g.skew[1])));
}

/// Share of a diagonal that lies in the deflection's hourglass vector under curvature along it.
template <class T>
BRIO_INLINE T bow_share(const ShellGeometry<T>& g, int diagonal) {
  return (diagonal == 0 ? 0.25 : -0.25) * (1.0 - square(g.skew[diagonal]));
}

/// Second derivatives of the middle surface's height over the plane, at the centre: 11, 22, 12 (1/length).
/// The height is warp/4 xi eta in the element's own coordinates.
template <class T>
BRIO_INLINE void surface_twist(const ShellGeometry<T>& g, T (&z)[3]) {
  const T twice = 2.0 * g.warp;
  z[0] = twice * (square(g.dual[0][0]) - square(g.dual[1][0]));
  z[1] = twice * (square(g.dual[0][1]) - square(g.dual[1][1]));
  z[2] = twice * (g.dual[0][0] * g.dual[0][1] - g.dual[1][0] * g.dual[1][1]);
}

}  // namespace brio
