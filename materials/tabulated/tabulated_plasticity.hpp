#pragma once
/// J2 plasticity whose yield stress is a table of the equivalent plastic strain, or one table a strain rate,
/// or one table times the factor of Cowper and Symonds (1957),
///
///     1 + (rate / C)^(1/p).
///
/// The strain rate is that of the deviatoric strain of the step, elastic part included (as *MAT_024 of
/// LS-DYNA with VP = 0): it is known before the return, which is then exact on a polygon
/// (tabulated_hardening.hpp). Shells and fibres, of which the strain across is not yet known, take it for
/// that of a material that keeps its volume.

#include <optional>
#include <string_view>

#include "materials/material_law.hpp"
#include "materials/plastic_flow.hpp"
#include "materials/tabulated/tabulated_hardening.hpp"
#include "src/base/lane_math.hpp"

namespace brio {

struct CowperSymonds {
  double c = 0;
  double p = 1;
  static constexpr auto fields() {
    return field_table(
        required("c", &CowperSymonds::c, positive,
                 "C: strain rate at which the yield stress is twice that of the table, 1/time"),
        required("p", &CowperSymonds::p, positive, "p in 1 + (rate / C)^(1/p), -"));
  }
};

struct TabulatedPlasticity {
  static constexpr std::string_view name = "tabulated_plasticity";
  using Settings = TabulatedPlasticity;
  static constexpr MaterialTraits traits{.update = true,
                                         .update_plane_stress = true,
                                         .update_fibre = true,
                                         .equivalent_plastic_strain = true,
                                         .hardening = true,
                                         .time_step = true,
                                         .failure = true,
                                         .named_history = true,
                                         .fault = true};
  double density = 0;
  double youngs_modulus = 0;
  double poissons_ratio = 0;
  SharedYieldTable yield_stress{};
  std::optional<CowperSymonds> cowper_symonds{};
  std::optional<Failure> failure{};
  double time_step = 0;  ///< of the present step; no entry of a deck

  static constexpr auto fields() {
    return field_table(
        required("density", &TabulatedPlasticity::density, positive, "mass per reference volume"),
        required("youngs_modulus", &TabulatedPlasticity::youngs_modulus, positive, "Young's modulus, stress"),
        required("poissons_ratio", &TabulatedPlasticity::poissons_ratio, poissons_ratio_range,
                 "Poisson's ratio, -"),
        required("yield_stress", &TabulatedPlasticity::yield_stress, any_number,
                 "uniaxial (true) yield stress over equivalent plastic strain"),
        optional("cowper_symonds", &TabulatedPlasticity::cowper_symonds, any_number,
                 "growth of the yield stress with the strain rate; absent: none"),
        optional("failure", &TabulatedPlasticity::failure, any_number,
                 "how the material fails; absent: never"));
  }
  std::string_view fault() const {
    if (cowper_symonds && yield_stress->curves() > 1)
      return "cowper_symonds and a table a strain rate say the same twice; one of them is accepted";
    // Elastic unloading in plane stress has a stiffness of at least E / 4, whatever Poisson's ratio.
    if (yield_stress->steepest_softening() <= -0.25 * youngs_modulus)
      return "the yield stress falls too steeply; slopes above -1/4 of Young's modulus are accepted";
    return fault_without_rate(failure);
  }

  template <class T>
  struct History {
    T equivalent_plastic_strain;
  };

  static constexpr auto named_history() {
    return field_table(largest("equivalent_plastic_strain", &History<double>::equivalent_plastic_strain));
  }

  ElasticConstants elastic() const { return {youngs_modulus, poissons_ratio}; }
  SlowHardening hardening() const { return {yield_stress.table.get()}; }

  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return elastic().template moduli<T>();
  }

  template <class T>
  BRIO_INLINE void update(const SymmetricTensor<T>& strain_increment, SymmetricTensor<T>& stress,
                          History<T>& history) const {
    const auto squared_rate = [&] {
      const SymmetricTensor<T> e = deviator(strain_increment);
      return (2.0 / 3.0) * contract(e, e);
    };
    plastic_update(flow_at(squared_rate), strain_increment, stress, history);
  }

  template <class T>
  BRIO_INLINE void update_plane_stress(const ShellTensor<T>& strain_increment, double shear_factor,
                                       ShellTensor<T>& stress, History<T>& history,
                                       T& thickness_strain_increment) const {
    const auto squared_rate = [&] {
      const ShellTensor<T>& e = strain_increment;
      return (4.0 / 3.0) *
             (square(e.xx) + square(e.yy) + e.xx * e.yy + square(e.xy) + square(e.yz) + square(e.xz));
    };
    plastic_update_plane_stress(flow_at(squared_rate), strain_increment, shear_factor, stress, history,
                                thickness_strain_increment);
  }

  template <class T>
  BRIO_INLINE void update_fibre(const FibreTensor<T>& strain_increment, FibreTensor<T>& stress,
                                History<T>& history) const {
    const auto squared_rate = [&] {
      const FibreTensor<T>& e = strain_increment;
      return square(e.xx) + (4.0 / 3.0) * (square(e.xy) + square(e.xz));
    };
    plastic_update_fibre(flow_at(squared_rate), strain_increment, stress, history);
  }

  /// The yield stress at a strain rate, 1/time.
  template <class T>
  TabulatedHardening<T> hardening_at(T rate) const {
    TabulatedHardening<T> hardening{yield_stress.table.get(), T(1.0), T(0.0)};
    if (cowper_symonds)
      hardening.lower = 1.0 + pow(rate * T(1 / cowper_symonds->c), T(1 / cowper_symonds->p));
    if (yield_stress->curves() > 1) hardening.set_rate(log(rate));
    return hardening;
  }

 private:
  /// What the returns of plastic_flow.hpp ask of a law.
  template <class T>
  struct Flow {
    ElasticConstants constants;
    TabulatedHardening<T> yield;
    ElasticConstants elastic() const { return constants; }
    const TabulatedHardening<T>& hardening() const { return yield; }
    double kinematic_modulus() const { return 0; }
  };
  /// \param squared_rate gives the square of the strain increment, where rates matter
  template <class SquaredRate>
  BRIO_INLINE auto flow_at(const SquaredRate& squared_rate) const -> Flow<decltype(squared_rate())> {
    using T = decltype(squared_rate());
    if (!cowper_symonds && yield_stress->curves() == 1)
      return {elastic(), {yield_stress.table.get(), T(1.0), T(0.0)}};
    const double per_time = time_step > 0 ? 1 / time_step : 0;
    return {elastic(), hardening_at(sqrt(squared_rate()) * T(per_time))};
  }
};

}  // namespace brio
