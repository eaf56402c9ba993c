#pragma once
/// The steel of beams and shells in these tests.

#include "materials/elastic.hpp"

namespace brio {

inline Elastic steel() { return {.density = 7850, .youngs_modulus = 200e9, .poissons_ratio = 0.3}; }

}  // namespace brio
