#pragma once
/// What a deck may say about contact beside the list of surfaces.

#include <tuple>

#include "src/base/fields.hpp"

namespace brio {

struct ContactOptions {
  double friction = 0;
  static constexpr auto fields() {
    return std::tuple{
        optional("friction", &ContactOptions::friction, non_negative, "Coulomb coefficient, -")};
  }
};

}  // namespace brio
