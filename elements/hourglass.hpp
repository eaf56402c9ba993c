#pragma once
/// Hourglass control of the one-point hexahedron (Flanagan & Belytschko 1981): forces along
/// gamma_aI = Gamma_aI - x_a . B_I, which see neither rigid nor linear motion. gamma is never formed: with
/// sums against the base vectors (mean_gradient.hpp), gamma_a . v = v_a - L x_a, and the force of a
/// generalized force Q_a is Q_a on pattern a together with the stress - sum_a Q_a (x) x_a / V on the mean
/// gradient.

#include "elements/mean_gradient.hpp"

namespace brio {

/// One vector for each base vector.
template <class T>
struct HourglassVectors {
  Vector3<T> mode[hourglass_modes];
};

/// gamma . v for each mode; \param l mean gradient of v on the configuration of x.
template <class T>
BRIO_INLINE HourglassVectors<T> hourglass_rates(const HexahedronModes<T>& x, const HexahedronModes<T>& v,
                                                const Tensor<T>& l) {
  HourglassVectors<T> rate;
  for (int a = 0; a < hourglass_modes; ++a) {
    const Vector3<T>& xa = x.hourglass(a);
    const Vector3<T>& va = v.hourglass(a);
    rate.mode[a] = {va.x - (l.m[0][0] * xa.x + l.m[0][1] * xa.y + l.m[0][2] * xa.z),
                    va.y - (l.m[1][0] * xa.x + l.m[1][1] * xa.y + l.m[1][2] * xa.z),
                    va.z - (l.m[2][0] * xa.x + l.m[2][1] * xa.y + l.m[2][2] * xa.z)};
  }
  return rate;
}

/// How the patterns and the mean gradient of a distorted brick overlap. All are zero for a parallelepiped.
template <class T>
struct HourglassOverlap {
  T projection;  ///< sum_a x_a . G x_a, dimensionless: what is subtracted from Gamma to form gamma
  T coupling;    ///< sum_a |B . gamma_a|^2, 1/length^2
};
template <class T>
BRIO_INLINE HourglassOverlap<T> hourglass_overlap(const HexahedronModes<T>& x, const MeanGradient<T>& b,
                                                  const SymmetricTensor<T>& g, T scaled_inverse_volume) {
  HourglassOverlap<T> overlap{T(0.0), T(0.0)};
  for (int a = 0; a < hourglass_modes; ++a) {
    const Vector3<T>& xa = x.hourglass(a);
    const Vector3<T> gx{g.xx * xa.x + g.xy * xa.y + g.xz * xa.z, g.xy * xa.x + g.yy * xa.y + g.yz * xa.z,
                        g.xz * xa.x + g.yz * xa.y + g.zz * xa.z};
    overlap.projection += dot(xa, gx);
    if (linear_modes + a < gradient_modes) {
      const Vector3<T> s = (8.0 * scaled_inverse_volume) * b.beta[linear_modes + a] - gx;
      overlap.coupling += dot(s, s);
    } else {
      overlap.coupling += dot(gx, gx);
    }
  }
  return overlap;
}

/// Force per hourglass displacement, force/length. For a parallelepiped the hourglass frequency squared is
/// then `coefficient` times that of a one-dimensional wave bound with the modulus of plane-strain bending, 4
/// mu (lambda + mu) / (lambda + 2 mu), which stays finite for incompressible materials; distorted bricks get
/// less, so that |gamma| does not raise it.
template <class T>
BRIO_INLINE T hourglass_stiffness(double coefficient, T first_lame, T shear, T volume, T trace_g,
                                  T projection) {
  const T bending_modulus = 4.0 * shear * (first_lame + shear) / (first_lame + 2.0 * shear);
  return coefficient * bending_modulus * volume * trace_g / (8.0 + projection);
}

}  // namespace brio
