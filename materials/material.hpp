#pragma once
/// The laws that a deck can name.

#include <variant>

#include "materials/elastic.hpp"

namespace brio {

using Material = std::variant<Elastic>;

inline double density(const Material& material) {
  return std::visit([](const auto& law) { return law.density; }, material);
}

}  // namespace brio
