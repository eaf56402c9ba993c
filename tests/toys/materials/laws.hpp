#pragma once
/// The list of laws with one more, in place of materials/laws.hpp: the directory of the toys is searched
/// first.

#include "materials/elastic.hpp"
#include "materials/material_law.hpp"
#include "tests/toys/toy_maxwell.hpp"

namespace brio {

using Material = LawList<Elastic, ToyMaxwell>;

}  // namespace brio
