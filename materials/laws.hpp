#pragma once
/// The laws that a deck can name. A new one is its header and a word here (docs/extending.md).

#include "materials/elastic.hpp"
#include "materials/elastic_plastic.hpp"
#include "materials/johnson_cook.hpp"
#include "materials/material_law.hpp"
#include "materials/neo_hookean.hpp"
#include "materials/power_law_hardening.hpp"
#include "materials/tabulated/tabulated_plasticity.hpp"

namespace brio {

using Material =
    LawList<Elastic, ElasticPlastic, PowerLawHardening, JohnsonCook, NeoHookean, TabulatedPlasticity>;

}  // namespace brio
