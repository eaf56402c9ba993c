#pragma once
/// Toy element: a bar between two nodes that carries axial force alone. What a deck says of it; its
/// mathematics is in toy_spring_kernel.hpp. Walked through in docs/extending.md.

#include <string_view>

#include "elements/base/element_kind.hpp"
#include "src/base/fields.hpp"

namespace brio {

struct Block;

struct ToySpring {
  static constexpr std::string_view name = "toy_spring";
  static constexpr int nodes = 2;
  static constexpr bool rotations = false;
  static constexpr ElementTraits traits{.cell = line_cell, .summary_key = "toy_spring"};
  template <class Law>
  static constexpr bool accepts = Law::traits.update_fibre;

  double area = 1;

  double contact_thickness() const { return 0; }

  static constexpr auto fields() {
    return field_table(required("area", &ToySpring::area, positive, "of the cross section, length^2"));
  }
};

/// Sets block.kernel.
void choose_kernel(const ToySpring& element, Block& block);

}  // namespace brio
