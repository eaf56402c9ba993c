#pragma once
/// Any plastic law with damage: the stress carried is (1 - damage) of that of the law, which goes on by
/// itself (Wellman, SAND2012-1343, and the pipe of Heinstein, Attaway, Swegle & Mello 1993). With sigma_1 the
/// largest principal stress of the law, n its direction and p the equivalent plastic strain:
///
///     failure sets in     p > failure strain, or TP > tearing parameter, where
///                         TP = integral of < 2 sigma_1 / (3 (sigma_1 - sigma_m)) >^4 dp,
///                         or D > 1 of Johnson & Cook (johnson_cook_fracture.hpp) or of Mohr & Marcadet
///                         (hosford_coulomb_fracture.hpp)
///     opening             d(damage) = <n . d(eps) . n> / opening strain      while sigma_1 > 0, once it has
///     in tension          d(damage) = dp / failure strain                    while sigma_1 > 0
///     sudden              damage = TP / tearing parameter, or D; the stress is whole until it is dropped
///
/// Of the step in which failure sets in, the part beyond the bound counts. A point whose damage has reached
/// deletion_damage carries nothing from then on.

#include "materials/failure.hpp"
#include "materials/hosford_coulomb_fracture.hpp"
#include "materials/johnson_cook_fracture.hpp"
#include "materials/material_law.hpp"
#include "materials/principal_stress.hpp"
#include "materials/stress_state.hpp"

namespace brio {

/// Damage of a point, part of its history.
template <class T>
struct DamageState {
  T damage;
  T measure;         ///< tearing parameter or D; 0 where the deck names a strain
  T opening_strain;  ///< at which damage is 1

  BRIO_INLINE MaskOf<T> has_failed(const Failure& f) const { return damage >= T(f.end_of_damage()); }
  BRIO_INLINE void add(T growth) { damage = min(damage + growth, T(1.0)); }
};

/// Plastic flow of a step, of which damage grows.
template <class T>
struct DamagingFlow {
  const SymmetricTensor<T>& strain_increment;
  const SymmetricTensor<T>& stress;          ///< of the law
  T flow;                                    ///< increment of the equivalent plastic strain
  T before, plastic_strain;                  ///< at the start and at the end of the step
  T rate_logarithm, homologous_temperature;  ///< 0 where the failure asks for neither
};

/// < 2 sigma_1 / (3 (sigma_1 - sigma_m)) >^4, 1 in uniaxial tension; 0 where nothing but pressure acts.
template <class T>
BRIO_INLINE T tearing(const SymmetricTensor<T>& stress, T largest) {
  const T deviatoric = largest - trace(stress) * (1.0 / 3.0);
  const auto sheared = (deviatoric > T(0.0)) & (largest > T(0.0));
  const T ratio = where(sheared, (2.0 / 3.0) * largest / where(sheared, deviatoric, T(1.0)), T(0.0));
  return square(square(ratio));
}

/// Of the tearing parameter or of D.
template <class T>
BRIO_INLINE T growth_of_measure(const Failure& f, double youngs_modulus, const DamagingFlow<T>& of) {
  if (f.tearing_parameter) return tearing(of.stress, largest_principal(of.stress).value) * of.flow;
  const double least_stress = 1e-9 * youngs_modulus;
  if (f.hosford_coulomb) return hosford_coulomb_damage(*f.hosford_coulomb, of.stress, of.flow, least_stress);
  return johnson_cook_damage(*f.johnson_cook, of.stress, of.flow, of.rate_logarithm,
                             of.homologous_temperature, least_stress);
}

/// Whatever the law: compiled once.
template <class T>
BRIO_CALLED void grow_damage(const Failure& f, double youngs_modulus, const DamagingFlow<T>& of,
                             DamageState<T>& state) {
  if (f.damage_growth == DamageGrowth::plastic_strain_in_tension) {
    if (!any(of.flow > T(0.0))) return;
    const T tension = largest_principal(of.stress).value;
    state.add(where(tension > T(0.0), of.flow * T(1 / *f.strain), T(0.0)));
    return;
  }
  T measure_before = of.before;
  T measure = of.plastic_strain;
  double bound = f.strain.value_or(0);
  if (!f.strain) {
    measure_before = state.measure;
    const auto flows = of.flow > T(0.0);
    if (any(flows)) state.measure += where(flows, growth_of_measure(f, youngs_modulus, of), T(0.0));
    measure = state.measure;
    bound = f.tearing_parameter.value_or(1);
  }
  if (f.damage_growth == DamageGrowth::sudden) {
    state.damage = min(measure / T(bound), T(1.0));
    return;
  }
  const auto fails = (measure > T(bound)) & !state.has_failed(f);
  if (!any(fails)) return;
  // The share of the step beyond the bound.
  const T step = measure - measure_before;
  const auto crosses = fails & (measure_before < T(bound));
  const T share = where(crosses, (measure - T(bound)) / where(crosses, step, T(1.0)), T(1.0));
  const PrincipalValue<T> principal = largest_principal(of.stress);
  const T opening = max(along(of.strain_increment, principal.direction), T(0.0));
  const auto opens = fails & (principal.value > T(0.0));
  state.add(where(opens, share * opening / state.opening_strain, T(0.0)));
}

/// \tparam Law with traits.failure
template <class Law>
struct Failing : Law {
  static constexpr MaterialTraits traits = [] {
    MaterialTraits failing = Law::traits;
    failing.has_failed = failing.named_history = true;
    return failing;
  }();

  template <class T>
  struct History : Law::template History<T>, DamageState<T> {};

  /// Those of the law, and damage.
  static constexpr auto named_history() {
    return [](const auto& take) {
      if constexpr (Law::traits.named_history) Law::named_history()(take);
      take(largest("damage", &History<double>::damage));
    };
  }

  template <class T>
  ElasticModuli<T> moduli(const History<T>& history) const {
    return Law::moduli(static_cast<const typename Law::template History<T>&>(history));
  }

  /// \param size edge length of the piece of the body that the point stands for
  template <class T>
  void start(History<T>& history, T size) const {
    const Failure& f = *this->failure;
    history.opening_strain = T(f.opening_strain.value_or(0));
    if (f.opening_displacement) history.opening_strain = T(*f.opening_displacement) / size;
  }

  template <class T>
  BRIO_INLINE MaskOf<T> has_failed(const History<T>& history) const {
    return history.DamageState<T>::has_failed(*this->failure);
  }

  /// Of the stress of the law.
  template <class T>
  BRIO_INLINE T carried_share(const History<T>& history) const {
    return where(has_failed(history), T(0.0), weakens() ? 1.0 - history.damage : T(1.0));
  }

  template <class T>
  BRIO_INLINE void update(const SymmetricTensor<T>& strain_increment, SymmetricTensor<T>& stress,
                          History<T>& history) const {
    stress = undamaged_share(history) * stress;
    const T plastic_strain = history.equivalent_plastic_strain;
    Law::update(strain_increment, stress, history);
    grow_damage(strain_increment, stress, plastic_strain, history);
    stress = carried_share(history) * stress;
  }

  template <class T>
  BRIO_INLINE void update_plane_stress(const ShellTensor<T>& strain_increment, double shear_factor,
                                       ShellTensor<T>& stress, History<T>& history,
                                       T& thickness_strain_increment) const {
    stress = undamaged_share(history) * stress;
    const T plastic_strain = history.equivalent_plastic_strain;
    Law::update_plane_stress(strain_increment, shear_factor, stress, history, thickness_strain_increment);
    const SymmetricTensor<T> strain{strain_increment.xx, strain_increment.yy, thickness_strain_increment,
                                    strain_increment.xy, strain_increment.yz, strain_increment.xz};
    const SymmetricTensor<T> in_space{stress.xx, stress.yy, T(0.0), stress.xy, stress.yz, stress.xz};
    grow_damage(strain, in_space, plastic_strain, history);
    stress = carried_share(history) * stress;
  }

  template <class T>
  BRIO_INLINE void update_fibre(const FibreTensor<T>& strain_increment, FibreTensor<T>& stress,
                                History<T>& history) const {
    const FibreTensor<T> before = undamaged_share(history) * stress;
    stress = before;
    const T plastic_strain = history.equivalent_plastic_strain;
    Law::update_fibre(strain_increment, stress, history);
    // Plastic strain keeps the volume.
    const T elastic_strain = (stress.xx - before.xx) * T(1 / this->youngs_modulus);
    const T across = T(-this->poissons_ratio) * elastic_strain - 0.5 * (strain_increment.xx - elastic_strain);
    const SymmetricTensor<T> strain{strain_increment.xx, across, across,
                                    strain_increment.xy, T(0.0), strain_increment.xz};
    const SymmetricTensor<T> in_space{stress.xx, T(0.0), T(0.0), stress.xy, T(0.0), stress.xz};
    grow_damage(strain, in_space, plastic_strain, history);
    stress = carried_share(history) * stress;
  }

 private:
  /// What a point that has failed holds is nothing, and stays so.
  template <class T>
  BRIO_INLINE T undamaged_share(const History<T>& history) const {
    const auto failed = has_failed(history);
    if (!weakens()) return where(failed, T(0.0), T(1.0));
    return where(failed, T(0.0), 1.0 / where(failed, T(1.0), 1.0 - history.damage));
  }
  bool weakens() const { return this->failure->damage_growth != DamageGrowth::sudden; }

  /// \param before equivalent plastic strain at the start of the step
  template <class T>
  BRIO_INLINE void grow_damage(const SymmetricTensor<T>& strain_increment, const SymmetricTensor<T>& stress,
                               T before, History<T>& history) const {
    const Failure& f = *this->failure;
    // What a failed point does is no longer that of the material.
    history.equivalent_plastic_strain = where(has_failed(history), before, history.equivalent_plastic_strain);
    const T plastic_strain = history.equivalent_plastic_strain;
    DamagingFlow<T> of{strain_increment, stress, plastic_strain - before, before, plastic_strain,
                       T(0.0),           T(0.0)};
    if constexpr (Law::traits.rate_logarithm) {
      if (f.johnson_cook && any(of.flow > T(0.0))) {
        if (f.johnson_cook->d4 != 0) of.rate_logarithm = Law::rate_logarithm(of.flow);
        if (f.johnson_cook->d5 != 0) of.homologous_temperature = Law::homologous_temperature(history);
      }
    }
    brio::grow_damage<T>(f, this->youngs_modulus, of, history);
  }
};

}  // namespace brio
