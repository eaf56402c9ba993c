#pragma once
/// Stable step and rotational inertia of a four-node shell.
///
/// With m/4 and r^2 m/4 at each of its nodes, the highest frequency of the element comes from blocks that do
/// not meet in a flat parallelogram:
///
///     membrane   omega^2 = 4/rho E' g,  E' = E / (1 - nu^2),  g = (s + sqrt(s^2 - 4 (1 - nu^2) / A^2)) / 2
///     (exact),
///                s = sum over nodes of the squared mean gradient = (|d1|^2 + |d2|^2) / (2 A^2)
///     bending    the same times J h^2 / r^2,  J h^2 the second moment of the thickness rule (h^2 / 12)
///     shear      omega^2 <= 4/rho kappa G (g + 1 / (4 r^2))
///     hourglass  4/m times stiffness times |gamma|^2
///
/// What couples them elsewhere (skewness, warp) is bounded by block norms: the largest eigenvalue of a 2x2
/// block matrix of operators is not above that of their norms. The bound holds for any shape; it takes
/// elastic moduli, which plastic flow only lowers, and leaves out what stress itself adds (sigma/E).

#include "elements/shell_geometry.hpp"

namespace brio {

/// Elastic constants of plane stress.
template <class T>
struct PlaneStressModuli {
  T youngs, shear, ratio;
  T stretch;  ///< E / (1 - nu^2)
};
template <class T>
BRIO_INLINE PlaneStressModuli<T> plane_stress_moduli(const ElasticModuli<T>& moduli) {
  const T sum = moduli.first_lame + moduli.shear;
  const T ratio = 0.5 * moduli.first_lame / sum;
  return {2.0 * (moduli.shear * (1.0 + ratio)), moduli.shear, ratio, 2.0 * moduli.shear / (1.0 - ratio)};
}

/// Stiffnesses per generalized rate, for a coefficient of one (Belytschko, Ong, Liu & Kennedy 1984). Theirs
/// for the deflection is kappa G h^3 s / 12, because their hourglass mode contains constant twist and must be
/// soft. Here it does not (shell_strain.hpp), so that the mode can have the transverse shear stiffness of a
/// square, less in slender elements where it would set the step. Measured on the pinched hemisphere of 8 x 8
/// elements, h / R = 1/250: error 41 % with theirs, 2 % so.
template <class T>
struct HourglassStiffness {
  T membrane;  ///< E h A s / 8
  T normal;    ///< kappa G h / (3 A s)
  T rotation;  ///< E h^3 A s / 192
};

/// s: sum over nodes of the squared mean gradient, 1/area; 1 where there is no area.
template <class T>
BRIO_INLINE T gradient_square(const ShellGeometry<T>& g) {
  T sum = square(g.dual[0][0]) + square(g.dual[0][1]);
  sum += square(g.dual[1][0]) + square(g.dual[1][1]);
  return where(g.is_valid, 2.0 * sum, 1.0);
}

template <class T>
BRIO_INLINE HourglassStiffness<T> hourglass_stiffness(const ShellGeometry<T>& g,
                                                      const PlaneStressModuli<T>& moduli, double shear_factor,
                                                      T thickness) {
  const T s = gradient_square(g);
  const T membrane = 0.125 * (moduli.youngs * thickness) * (g.area * s);

  return {membrane, (shear_factor / 3) * (moduli.shear * thickness) / (g.area * s),
          (1.0 / 24) * (membrane * square(thickness))};
}

/// g of the membrane block, 1/area.
template <class T>
BRIO_INLINE T highest_gradient(const ShellGeometry<T>& g, T s, T poissons_ratio) {
  const T spread = square(s) - 4.0 * (1.0 - square(poissons_ratio)) * square(g.inverse_area);
  return 0.5 * (s + sqrt(max(spread, 0.0)));
}

/// Square of the radius of gyration r that nodes get: h^2 / 12, or more where transverse shear would
/// otherwise set the step (Hughes, Cohen & Haroun 1978): r^2 such that the shear block is just as fast as the
/// membrane block. For a square of side a and nu = 0.3 that is a^2 / 12.6.
template <class T>
BRIO_INLINE T gyration_square(const ShellGeometry<T>& g, const PlaneStressModuli<T>& moduli,
                              double shear_factor, T thickness, double second_moment) {
  const T highest = highest_gradient(g, gradient_square(g), moduli.ratio);
  const T excess = max(moduli.stretch / (shear_factor * moduli.shear) - 1.0, 1.0);
  const T own = (second_moment > 1.0 / 12 ? second_moment : 1.0 / 12) * square(thickness);
  return max(own, 0.25 / (highest * excess));
}

/// Largest eigenvalue of [[a, .], [., d + c]] where the rows of the second block reach into the first with
/// norm c: both blocks stand beside each other, joined by sqrt(a c).
template <class T>
BRIO_INLINE T joined(T a, T d, T c) {
  const T sum = a + d + c;
  return 0.5 * (sum + sqrt(square(a - d - c) + 4.0 * (a * c)));
}

/// Upper bound of the element's highest frequency squared.
/// \param inverse_gyration 1 / r^2
template <class T>
BRIO_INLINE T highest_frequency_square(const ShellGeometry<T>& g, const PlaneStressModuli<T>& moduli,
                                       double shear_factor, double second_moment, T mass, T thickness,
                                       T inverse_gyration, double stiffness_coefficient,
                                       bool warping_projection) {
  const T s = gradient_square(g);
  const T highest = highest_gradient(g, s, moduli.ratio);
  const T per_mass = 4.0 / mass;
  const T volume = (g.area * thickness) * per_mass;  // 4 / rho
  const T moment = second_moment * square(thickness);
  const T shear_modulus = shear_factor * moduli.shear;
  const T skewness = square(g.skew[0]) + square(g.skew[1]);

  const T membrane = volume * moduli.stretch * highest;
  const T bending = membrane * (moment * inverse_gyration);
  const T shear = volume * shear_modulus * (highest + 0.25 * inverse_gyration);
  // Shear from rotation in the middle of the diagonals.
  const T obliqueness =
      2.0 + square(g.diagonal[0][0] * g.diagonal[1][0] + g.diagonal[0][1] * g.diagonal[1][1]) *
                square(g.inverse_area);
  const T oblique = volume * shear_modulus * (0.125 * skewness) * (obliqueness * inverse_gyration);
  T plate = joined(shear, bending, oblique);

  const HourglassStiffness<T> unit = hourglass_stiffness(g, moduli, shear_factor, thickness);
  const T in_plane = (stiffness_coefficient * per_mass) * unit.membrane;
  const T turning = (stiffness_coefficient * per_mass) * (unit.rotation * inverse_gyration);
  const T bowing = (stiffness_coefficient * per_mass) * unit.normal;
  // (u + v)(u + v)^T <= 4 u u^T + 4/3 v v^T, for u = (1, -1, 1, -1), which is orthogonal to all else, and v
  // the rest.
  const T curved = 2.0 * skewness + 0.25 * (square(g.area) * s) * (1.0 + square(skewness)) * inverse_gyration;
  plate = plate + 4.0 * (turning * skewness) + (4.0 / 3) * (bowing * curved);
  plate = max(plate, max(8.0 * turning, 16.0 * bowing));
  T sheet = membrane;
  if (warping_projection) {
    // Curvature that membrane strain and spin give to a twisted element.
    const T twist = square(g.warp * s);
    const T coupling = volume * moduli.stretch * moment * twist * (2.0 * highest + 0.5 * inverse_gyration);
    plate = joined(plate, sheet, coupling);
  }
  sheet = max(sheet, plate) + 2.0 * in_plane * (2.0 * skewness + square(g.warp) * highest);
  return max(sheet, 8.0 * in_plane);
}

/// Share of 2/omega that is left with the damping ratio xi: not above sqrt(1 + xi^2) - xi, by its series.
template <class T>
BRIO_INLINE T damped_share(T xi) {
  const T squared = square(xi);
  return 1.0 - xi + 0.5 * squared - 0.125 * square(squared);
}

}  // namespace brio
