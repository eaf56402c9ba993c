#pragma once
/// Failure strain of Mohr & Marcadet (International Journal of Solids and Structures 67-68, 2015): plastic
/// strain to fracture under a constant direction of stress. With the principal stresses sigma_1 >= sigma_2 >=
/// sigma_3 and the von Mises stress q,
///
///     g = ( ((sigma_1 - sigma_2)^a + (sigma_2 - sigma_3)^a + (sigma_1 - sigma_3)^a) / 2 )^(1/a) / q
///         + c (sigma_1 + sigma_3) / q,
///     eps_f = b ((1 + c) / g)^(1/n_f),     none where g <= 0,
///     D = integral of dp / eps_f;  failure at D = 1
///
/// which are its terms in the triaxiality and the Lode angle, of stresses in place of angles. g is 1 + c, and
/// eps_f is b, in uniaxial and in equal biaxial tension.

#include "materials/failure.hpp"
#include "materials/principal_stress.hpp"
#include "materials/stress_state.hpp"
#include "src/base/lane_math.hpp"

namespace brio {

/// Growth of D over a step of plastic flow.
/// \param stress of the law, at the end of the step
/// \param least_stress von Mises stress that counts as none, as of a molten point
template <class T>
BRIO_INLINE T hosford_coulomb_damage(const HosfordCoulombFracture& fracture, const SymmetricTensor<T>& stress,
                                     T flow, double least_stress) {
  const SymmetricTensor<T> s = deviator(stress);
  const T inverse = 1.0 / max(sqrt(1.5 * contract(s, s)), T(least_stress));
  const Vector3<T> value = inverse * principal_axes(stress).value;
  const T largest = max(value.x, max(value.y, value.z));
  const T smallest = min(value.x, min(value.y, value.z));
  const auto power = [&](T difference) { return pow(abs(difference), T(fracture.a)); };
  const T sum = power(value.x - value.y) + power(value.y - value.z) + power(value.x - value.z);
  const T g = pow(0.5 * sum, T(1 / fracture.a)) + T(fracture.c) * (largest + smallest);
  const auto grows = (flow > T(0.0)) & (g > T(0.0));
  const T ratio = where(grows, g, T(1.0)) * T(1 / (1 + fracture.c));
  // Beyond, exp leaves the range of single precision.
  const T exponent = min(max(log(ratio) * T(1 / fracture.transformation_exponent), T(-80.0)), T(80.0));
  return where(grows, flow * T(1 / fracture.b) * exp(exponent), T(0.0));
}

}  // namespace brio
