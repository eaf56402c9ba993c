#pragma once
/// J2 plasticity whose yield stress follows strain, strain rate and temperature (Johnson & Cook 1983):
///
///     (A + B p^n) (1 + C ln max(dp/dt / reference rate, 1)) (1 - T*^m),   T* = (T - T_r) / (T_melt - T_r)
///
/// The rate is that of the step's flow and is solved for with it; heat stays where it is made, and the
/// temperature of a step is that of its start: rho c dT = share of the plastic work.

#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "materials/material_law.hpp"
#include "materials/plastic_flow.hpp"
#include "materials/power_hardening.hpp"
#include "src/base/lane_math.hpp"

namespace brio {

/// Softening by the heat of plastic flow.
struct ThermalSoftening {
  double specific_heat = 0;
  double melting_temperature = 0;
  double reference_temperature = 0;
  std::optional<double> initial_temperature{};
  double exponent = 1;
  double heat_fraction = 0.9;

  static constexpr auto fields() {
    return field_table(required("specific_heat", &ThermalSoftening::specific_heat, positive,
                                "heat per mass and degree, length^2 per time^2 per degree"),
                       required("melting_temperature", &ThermalSoftening::melting_temperature, any_number,
                                "temperature at which nothing is carried, degree"),
                       required("reference_temperature", &ThermalSoftening::reference_temperature, any_number,
                                "temperature of the other constants, degree"),
                       optional("initial_temperature", &ThermalSoftening::initial_temperature, any_number,
                                "at the start; default: reference_temperature, degree"),
                       required("exponent", &ThermalSoftening::exponent, positive, "m of 1 - T*^m, -"),
                       optional("heat_fraction", &ThermalSoftening::heat_fraction, fraction,
                                "share of plastic work that becomes heat, -"));
  }
  constexpr std::string_view fault() const {
    if (melting_temperature <= reference_temperature)
      return "melting_temperature must exceed reference_temperature";
    if (initial_temperature && *initial_temperature >= melting_temperature)
      return "initial_temperature must be below melting_temperature";
    return "";
  }

  double start() const { return initial_temperature.value_or(reference_temperature); }
};

/// The yield stress in one step: plastic strain starts from `base`, at the temperature at the start of the
/// step. hardening.hpp says what it provides.
template <class T>
struct JohnsonCookHardening {
  static constexpr HardeningShape shape = HardeningShape::any;
  double initial, constant, exponent, rate_constant;
  double rate_step;  ///< reference rate times the step
  T base;
  T thermal;  ///< 1 - T*^m

  T initial_yield_stress() const { return T(initial) * thermal; }

  BRIO_INLINE HardeningPoint<T> at(T plastic_strain) const {
    const T strain = max(plastic_strain, T(least));
    const T rise = T(constant) * pow(strain, T(exponent));
    const T flow = plastic_strain - base;
    const auto fast = flow > T(rate_step);
    const T safe_flow = where(fast, flow, T(1.0));
    T rate(1.0), rate_slope(0.0);
    if (rate_constant > 0 && any(fast)) {
      rate = where(fast, 1.0 + T(rate_constant) * log(safe_flow * T(1 / rate_step)), T(1.0));
      rate_slope = where(fast, T(rate_constant) / safe_flow, T(0.0));
    }
    const T strength = T(initial) + rise;
    return {plastic_strain, thermal * rate * strength,
            thermal * (rate * T(exponent) * rise / strain + rate_slope * strength)};
  }

  /// Newton's method within a bracket. The stiffness of a metal is far above its hardening, so that the
  /// start from no hardening is near. What Newton's method has not found is halved, which comes to an end
  /// unless the input is not a number.
  BRIO_CALLED HardeningPoint<T> meet(HardeningPoint<T> near, T effective_stress, T stiffness) const {
    T low = min(base, near.plastic_strain);
    T high = near.plastic_strain + max(effective_stress - initial_yield_stress(), T(0.0)) / stiffness;
    T strain = near.plastic_strain + max(effective_stress - near.stress, T(0.0)) / stiffness;
    HardeningPoint<T> point = at(strain);
    const T distance = T(exact) * effective_stress / stiffness;
    MaskOf<T> found = low > high;  // none
    for (int iteration = 0; iteration < most_iterations && !all(found); ++iteration) {
      const T over = effective_stress - stiffness * (strain - near.plastic_strain) - point.stress;
      low = where(over > T(0.0), strain, low);
      high = where(over > T(0.0), high, strain);
      T next = strain + over / (stiffness + point.slope);
      const T middle = 0.5 * (low + high);
      if (iteration < newton_iterations) {
        next = where((next >= low) & (next <= high), next, middle);
      } else {
        next = middle;
      }
      next = where(found, strain, next);
      found = found | (abs(next - strain) <= distance + T(round_off) * strain);
      strain = next;
      point = at(strain);
    }
    point.stress = where(found, point.stress, T(std::numeric_limits<RealOf<T>>::quiet_NaN()));
    return point;
  }

 private:
  static constexpr double least = sizeof(RealOf<T>) == 8 ? 1e-200 : 1e-25;
  static constexpr double exact = sizeof(RealOf<T>) == 8 ? 1e-14 : 1e-6;
  static constexpr double round_off = std::numeric_limits<RealOf<T>>::epsilon();
  static constexpr int newton_iterations = 20;
  /// Each beyond halves the bracket, whose first width is at most the effective stress over the stiffness.
  static constexpr int most_iterations = newton_iterations + (sizeof(RealOf<T>) == 8 ? 48 : 22);
};

struct JohnsonCook {
  static constexpr std::string_view name = "johnson_cook";
  using Settings = JohnsonCook;
  static constexpr MaterialTraits traits{.update = true,
                                         .update_plane_stress = true,
                                         .update_fibre = true,
                                         .equivalent_plastic_strain = true,
                                         .hardening = true,
                                         .time_step = true,
                                         .rate_logarithm = true,
                                         .failure = true,
                                         .named_history = true,
                                         .fault = true};
  double density = 0;
  double youngs_modulus = 0;
  double poissons_ratio = 0;
  double yield_stress = 0;
  double hardening_constant = 0;
  double hardening_exponent = 1;
  double rate_constant = 0;
  double reference_rate = 1;
  std::optional<ThermalSoftening> thermal{};
  std::optional<Failure> failure{};
  double time_step = 0;  ///< of the present step; no entry of a deck

  static constexpr auto fields() {
    return field_table(
        required("density", &JohnsonCook::density, positive, "mass per reference volume"),
        required("youngs_modulus", &JohnsonCook::youngs_modulus, positive, "Young's modulus, stress"),
        required("poissons_ratio", &JohnsonCook::poissons_ratio, poissons_ratio_range, "Poisson's ratio, -"),
        required("yield_stress", &JohnsonCook::yield_stress, positive,
                 "A: uniaxial yield stress at the reference rate and temperature"),
        required("hardening_constant", &JohnsonCook::hardening_constant, non_negative,
                 "B in A + B p^hardening_exponent, stress"),
        required("hardening_exponent", &JohnsonCook::hardening_exponent, hardening_exponent_range,
                 "exponent of the plastic strain, -"),
        optional("rate_constant", &JohnsonCook::rate_constant, non_negative,
                 "C: growth of the yield stress with the logarithm of the rate, -"),
        optional("reference_rate", &JohnsonCook::reference_rate, positive,
                 "plastic strain rate at and below which A and B were measured, 1/time"),
        optional("thermal", &JohnsonCook::thermal, any_number,
                 "softening by the heat of plastic flow; absent: none"),
        optional("failure", &JohnsonCook::failure, any_number, "how the material fails; absent: never"));
  }
  constexpr std::string_view fault() const {
    if (failure && failure->johnson_cook && failure->johnson_cook->d5 != 0 && !thermal)
      return "d5 of johnson_cook acts on the temperature, which is known with 'thermal' only";
    return "";
  }

  template <class T>
  struct History {
    T equivalent_plastic_strain;
    T temperature_rise;
  };

  static constexpr auto named_history() {
    return field_table(largest("equivalent_plastic_strain", &History<double>::equivalent_plastic_strain),
                       largest("temperature", &JohnsonCook::temperature));
  }
  /// Degree; 0 without `thermal`, where none is known.
  double temperature(const History<double>& history) const {
    return thermal ? thermal->start() + history.temperature_rise : 0;
  }

  ElasticConstants elastic() const { return {youngs_modulus, poissons_ratio}; }
  /// At the reference rate and temperature.
  PowerHardening hardening() const { return {yield_stress, hardening_constant, hardening_exponent, 0}; }

  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return elastic().template moduli<T>();
  }

  template <class T>
  BRIO_INLINE void update(const SymmetricTensor<T>& strain_increment, SymmetricTensor<T>& stress,
                          History<T>& history) const {
    const T before = history.equivalent_plastic_strain;
    plastic_update(flow_from(history), strain_increment, stress, history);
    if (!thermal) return;
    const SymmetricTensor<T> s = deviator(stress);
    heat(1.5 * contract(s, s), before, history);
  }

  template <class T>
  BRIO_INLINE void update_plane_stress(const ShellTensor<T>& strain_increment, double shear_factor,
                                       ShellTensor<T>& stress, History<T>& history,
                                       T& thickness_strain_increment) const {
    const T before = history.equivalent_plastic_strain;
    plastic_update_plane_stress(flow_from(history), strain_increment, shear_factor, stress, history,
                                thickness_strain_increment);
    if (!thermal) return;
    heat(square(stress.xx) + square(stress.yy) - stress.xx * stress.yy +
             3.0 * (square(stress.xy) + square(stress.yz) + square(stress.xz)),
         before, history);
  }

  template <class T>
  BRIO_INLINE void update_fibre(const FibreTensor<T>& strain_increment, FibreTensor<T>& stress,
                                History<T>& history) const {
    const T before = history.equivalent_plastic_strain;
    plastic_update_fibre(flow_from(history), strain_increment, stress, history);
    if (!thermal) return;
    heat(square(stress.xx) + 3.0 * (square(stress.xy) + square(stress.xz)), before, history);
  }

  template <class T>
  BRIO_INLINE JohnsonCookHardening<T> hardening_from(const History<T>& history) const {
    T softened(1.0);
    if (thermal) softened = 1.0 - pow(homologous_temperature(history), T(thermal->exponent));
    return {yield_stress,  hardening_constant,         hardening_exponent,
            rate_constant, reference_rate * time_step, history.equivalent_plastic_strain,
            softened};
  }

  /// T*: 0 at and below the reference temperature, 1 at melting and above.
  template <class T>
  BRIO_INLINE T homologous_temperature(const History<T>& history) const {
    if (!thermal) return T(0.0);
    const double range = thermal->melting_temperature - thermal->reference_temperature;
    const T above =
        (T(thermal->start() - thermal->reference_temperature) + history.temperature_rise) * T(1 / range);
    return min(max(above, T(0.0)), T(1.0));
  }
  /// ln of the plastic strain rate over the reference rate; 0 below that.
  template <class T>
  BRIO_INLINE T rate_logarithm(T flow) const {
    return log(max(flow * T(1 / (reference_rate * time_step)), T(1.0)));
  }

 private:
  /// What the returns of plastic_flow.hpp ask of a law.
  template <class T>
  struct Flow {
    ElasticConstants constants;
    JohnsonCookHardening<T> yield;
    ElasticConstants elastic() const { return constants; }
    const JohnsonCookHardening<T>& hardening() const { return yield; }
    double kinematic_modulus() const { return 0; }
  };
  template <class T>
  BRIO_INLINE Flow<T> flow_from(const History<T>& history) const {
    return {elastic(), hardening_from(history)};
  }

  /// \param squared of the effective stress
  template <class T>
  BRIO_INLINE void heat(T squared, T before, History<T>& history) const {
    const T flow = history.equivalent_plastic_strain - before;
    if (!any(flow > T(0.0))) return;
    history.temperature_rise +=
        T(thermal->heat_fraction / (density * thermal->specific_heat)) * sqrt(squared) * flow;
  }
};

}  // namespace brio
