#pragma once
/// The state of single elements as rows of numbers, by which it passes from one model to another.

#include <array>
#include <cstddef>
#include <string_view>

#include "elements/block.hpp"

namespace brio {

/// Numbers that elements of a block remember: header and points of the kernel, of which the first is the
/// mass.
std::size_t state_components(const Block& block);
/// \param row out
void read_state(const Block& block, std::size_t element, double* row);
/// All but the mass, which is as the deck says. \param row of elements of the same kind, points and law
void write_state(const double* row, std::size_t element, Block& block);

/// Why a stress alone is not the state of elements with that law, so that they cannot start with it; empty
/// where it is. \param with_plastic_strain whether that is given beside the stress
std::string_view why_not_by_stress(const Element& element, const Material& material,
                                   bool with_plastic_strain);
/// With the elastic energy of the stress. \param stress Cauchy stress on global axes: xx, yy, zz, xy, yz, xz
/// \pre !why_not_by_stress
void write_stress(const std::array<double, 6>& stress, std::size_t element, Block& block);
void write_plastic_strain(double strain, std::size_t element, Block& block);

/// The energy that an element is accounted for when it is deleted. \pre block.loses_elements
void hold_energy(double internal, std::size_t element, Block& block);

}  // namespace brio
