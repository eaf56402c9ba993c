#pragma once
/// The laws that a deck can name.

#include <variant>

#include "materials/elastic.hpp"
#include "materials/elastic_plastic.hpp"
#include "materials/neo_hookean.hpp"
#include "materials/power_law_hardening.hpp"

namespace brio {

using Material = std::variant<Elastic, ElasticPlastic, PowerLawHardening, NeoHookean>;

inline double density(const Material& material) {
  return std::visit([](const auto& law) { return law.density; }, material);
}

}  // namespace brio
