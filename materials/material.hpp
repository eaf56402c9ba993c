#pragma once
/// The laws that a deck can name.

#include <variant>

#include "materials/elastic.hpp"
#include "materials/elastic_plastic.hpp"
#include "materials/johnson_cook.hpp"
#include "materials/neo_hookean.hpp"
#include "materials/power_law_hardening.hpp"

namespace brio {

using Material = std::variant<Elastic, ElasticPlastic, PowerLawHardening, JohnsonCook, NeoHookean>;

inline bool has_plastic_strain(const Material& material) {
  return std::visit(
      []<class Law>(const Law&) {
        return requires(const typename Law::template History<double>& history) {
          history.equivalent_plastic_strain;
        };
      },
      material);
}

inline bool has_failure(const Material& material) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.failure; }) {
          return law.failure.has_value();
        } else {
          return false;
        }
      },
      material);
}

inline double density(const Material& material) {
  return std::visit([](const auto& law) { return law.density; }, material);
}

}  // namespace brio
