#pragma once
/// Precision of the element state. Positions, velocities, forces, time, energies and sums are double in every
/// run; the deck's `numerics.precision` chooses what the element and material kernels compute and store.

#include <array>
#include <concepts>

#include "src/base/fields.hpp"

namespace brio {

enum class Precision { double_precision, single_precision };
constexpr std::array<NamedValue<Precision>, 2> named_values(Precision) {
  return {{{"double", Precision::double_precision}, {"float", Precision::single_precision}}};
}

template <class Real>
concept Floating = std::same_as<Real, float> || std::same_as<Real, double>;

}  // namespace brio
