#pragma once
/// Stable time step and rotational inertia of a four-node shell.
///
/// With m/4 and r^2 m/4 at each of its nodes, the highest frequency of the element comes from blocks that are
/// uncoupled in a flat parallelogram:
///
///     membrane   omega^2 = 4/rho E' g,  E' = E / (1 - nu^2),  g = (s + sqrt(s^2 - 4 (1 - nu^2) / A^2)) / 2
///     (exact),
///                s = sum over nodes of the squared mean gradient = (|d1|^2 + |d2|^2) / (2 A^2)
///     bending    the same times J h^2 / r^2,  J h^2 the second moment of the thickness rule (h^2 / 12)
///     shear      omega^2 <= 4/rho kappa G (g + 1 / (4 r^2))
///     hourglass  4/m times stiffness times |gamma|^2
///
/// Coupling by skewness and warp is bounded by block norms: the largest eigenvalue of a 2x2
/// block matrix of operators is not above that of their norms. The bound holds for any shape; it takes
/// elastic moduli, which yielding only lowers, and neglects the geometric stiffness of stress (sigma/E).

#include "elements/shell/shell_geometry.hpp"

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

/// Stiffnesses per generalized rate (Belytschko, Ong, Liu & Kennedy 1984). Theirs for the deflection is kappa
/// G h^3 s / 12, because their hourglass mode contains constant twist and must be soft. Here it does not
/// (shell_strain.hpp), so that the mode can have the transverse shear stiffness of a square, less in slender
/// elements where it would set the step. Measured on the pinched hemisphere of 8 x 8 elements, h / R = 1/250:
/// error 41 % with theirs, 2 % so.
///
/// A strip one element wide can twist through that mode alone: nodes on both sides turn so that no curvature
/// is seen. Its stiffness k then resists with k A per width, in series with the strip's own G h^3 / 3, and
/// has to be well above it: ten times. Half of what transverse shear gives to the mode, kappa G h A s / 12,
/// bounds it: more would set the step of thick elements.
template <class T>
struct HourglassStiffness {
  T membrane;  ///< c E h A s / 8
  T normal;    ///< c kappa G h / (3 A s); at least 10/3 G h^3 / A, up to kappa G h A s / 24
  T rotation;  ///< c E h^3 A s / 192
};

/// s: sum over nodes of the squared mean gradient, 1/area; 1 where there is no area.
template <class T>
BRIO_INLINE T gradient_square(const ShellGeometry<T>& g) {
  T sum = square(g.dual[0][0]) + square(g.dual[0][1]);
  sum += square(g.dual[1][0]) + square(g.dual[1][1]);
  return where(g.is_valid, 2.0 * sum, 1.0);
}

/// Coefficient c from which on the deflection's stiffness has all of that floor; below, a share of it.
inline constexpr double full_twist_coefficient = 0.01;

template <class T>
BRIO_INLINE HourglassStiffness<T> hourglass_stiffness(const ShellGeometry<T>& g,
                                                      const PlaneStressModuli<T>& moduli, double shear_factor,
                                                      T thickness, double coefficient) {
  const T spread = g.area * gradient_square(g);
  const T squared = square(thickness);
  const T shear = moduli.shear * thickness;
  const T membrane = (0.125 * coefficient) * (moduli.youngs * thickness) * spread;
  const double share = coefficient < full_twist_coefficient ? coefficient / full_twist_coefficient : 1.0;
  const T twisting = min((10.0 / 3 * share) * squared * g.inverse_area, (share * shear_factor / 24) * spread);
  return {membrane, shear * max((coefficient * shear_factor / 3) / spread, twisting),
          (1.0 / 24) * (membrane * squared)};
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

/// Stiffness of bending times its g, as that of the membrane is E' g: moduli of equal curvature, E' (1 + nu)
/// / 2, and of what differs from it, G, times `moment`, with what `bow` times the square of curvature in the
/// deflection's hourglass mode adds to them.
template <class T>
BRIO_INLINE T bending_gradient(const ShellGeometry<T>& g, const PlaneStressModuli<T>& moduli, T s, T moment,
                               T bow) {
  T mode[3];
  for (int c = 0; c < 3; ++c) {
    const int a = c == 1 ? 1 : 0, b = c == 0 ? 0 : 1;
    mode[c] = bow_share(g, 0) * (g.diagonal[0][a] * g.diagonal[0][b]) +
              bow_share(g, 1) * (g.diagonal[1][a] * g.diagonal[1][b]);
  }
  const T equal = 0.5 * abs(mode[0] + mode[1]);
  const T squared = 0.5 * square(mode[0] - mode[1]) + 2.0 * square(mode[2]);
  const T both = equal * sqrt(squared);
  const T first = 0.5 * (moduli.stretch * (1.0 + moduli.ratio)) * moment + bow * (square(equal) + both);
  const T second = moduli.shear * moment + 0.5 * bow * (squared + both);
  const T sum = max(first + second, vanishing<T>);
  return sum * highest_gradient(g, s, (first - second) / sum);
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
  const T shear = volume * shear_modulus * (highest + 0.25 * inverse_gyration);
  // Shear from rotation in the middle of the diagonals.
  const T obliqueness =
      2.0 + square(g.diagonal[0][0] * g.diagonal[1][0] + g.diagonal[0][1] * g.diagonal[1][1]) *
                square(g.inverse_area);
  const T oblique = volume * shear_modulus * (0.125 * skewness) * (obliqueness * inverse_gyration);

  const HourglassStiffness<T> hourglass =
      hourglass_stiffness(g, moduli, shear_factor, thickness, stiffness_coefficient);
  const T in_plane = per_mass * hourglass.membrane;
  const T turning = per_mass * (hourglass.rotation * inverse_gyration);
  const T bowing = per_mass * hourglass.normal;
  // (u + v)(u + v)^T <= 5 u u^T + 5/4 v v^T, for u = (1, -1, 1, -1), which is orthogonal to all else, and v
  // the rest: of the deflection, where the element is skew, and of curvature.
  const T skewed = 2.0 * skewness;
  const T curved = 0.25 * (square(g.area) * s) * (1.0 + square(skewness)) * inverse_gyration;
  const T crossed = sqrt(skewed * curved);
  const T bowed = 1.25 * bowing;
  const T with_twist =
      bending_gradient(g, moduli, s, volume * moment, bowed * (1.0 + crossed / curved)) * inverse_gyration;
  const T bending = min(with_twist, membrane * moment * inverse_gyration + bowed * (curved + crossed));
  T plate = joined(shear + bowed * (skewed + crossed), bending, oblique) + 4.0 * (turning * skewness);
  plate = max(plate, max(8.0 * turning, 20.0 * bowing));
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

/// Share of 2/omega that is left with the damping ratio xi: not above sqrt(1 + xi^2) - xi, by its series, or
/// where that ends by 1 / (2 + 2 xi).
template <class T>
BRIO_INLINE T damped_share(T xi) {
  const T squared = square(xi);
  return max(1.0 - xi + 0.5 * squared - 0.125 * square(squared), 0.5 / (1.0 + xi));
}

}  // namespace brio
