#pragma once
/// What is asked of a material, whatever its law.

#include <string_view>
#include <type_traits>
#include <vector>

#include "materials/laws.hpp"

namespace brio {

/// Traits of the law.
inline MaterialTraits traits_of(const Material& material) {
  return std::visit([](const auto& law) { return std::decay_t<decltype(law)>::traits; }, material);
}

inline bool has_plastic_strain(const Material& material) {
  return traits_of(material).equivalent_plastic_strain;
}

inline bool has_failure(const Material& material) {
  return std::visit(
      []<class Law>(const Law& law) {
        if constexpr (Law::traits.failure) {
          return law.failure.has_value();
        } else {
          return false;
        }
      },
      material);
}

/// Names that the history of the law has, and so the cells of its elements.
inline std::vector<std::string_view> history_names_of(const Material& material) {
  return std::visit(
      []<class Law>(const Law& law) {
        std::vector<std::string_view> names(history_names<Law>.begin(), history_names<Law>.end());
        if constexpr (Law::traits.failure)
          if (law.failure) names.emplace_back("damage");
        return names;
      },
      material);
}

inline double density(const Material& material) {
  return std::visit([](const auto& law) { return law.density; }, material);
}

}  // namespace brio
