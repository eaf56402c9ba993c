#pragma once
/// Failure strain of Johnson & Cook (Engineering Fracture Mechanics 21, 1985), under triaxiality sigma* =
/// mean stress / von Mises stress:
///
///     eps_f = (D1 + D2 exp(D3 sigma*)) (1 + D4 ln max(dp/dt / reference rate, 1)) (1 + D5 T*),
///     D = integral of dp / eps_f;  failure at D = 1
///
/// A law that knows no rate has rate_logarithm 0, one that knows no temperature T* = 0; decks in which D4 or
/// D5 would want them are refused.

#include "materials/failure.hpp"
#include "materials/stress_state.hpp"
#include "src/base/lane_math.hpp"

namespace brio {

/// Growth of D over a step of plastic flow.
/// \param stress of the law, at the end of the step
/// \param least_stress von Mises stress that counts as none, as of a molten point, in triaxiality
template <class T>
BRIO_INLINE T johnson_cook_damage(const JohnsonCookFracture& fracture, const SymmetricTensor<T>& stress,
                                  T flow, T rate_logarithm, T homologous_temperature, double least_stress) {
  const SymmetricTensor<T> s = deviator(stress);
  const T von_mises = max(sqrt(1.5 * contract(s, s)), T(least_stress));
  const T triaxiality = trace(stress) * (1.0 / 3.0) / von_mises;
  // Beyond, the share of a step is below 1e-34 and exp leaves the range of single precision.
  const T power = exp(min(T(fracture.d3) * triaxiality, T(80.0)));
  T strain = (T(fracture.d1) + T(fracture.d2) * power) * (1.0 + T(fracture.d4) * rate_logarithm) *
             (1.0 + T(fracture.d5) * homologous_temperature);
  if (fracture.least_strain) strain = max(strain, T(*fracture.least_strain));
  auto grows = flow > T(0.0);
  if (fracture.least_triaxiality) grows = grows & (triaxiality > T(*fracture.least_triaxiality));
  return where(grows, flow / strain, T(0.0));
}

}  // namespace brio
