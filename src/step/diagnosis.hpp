#pragma once
/// Messages of a breakdown: place, likely cause, advice; what sets the time step.

#include <string>

#include "src/model/model.hpp"

namespace brio {

/// Shortest text of a number, the same in every locale.
std::string written(double number);

/// "element 3 of part 'cube'"; by the numbers of the part's mesh.
std::string element_name(const Model& model, std::size_t block, std::size_t element);

/// What sets the stable time step: an element, or "spring 'strut'".
std::string critical_name(const Model& model);

/// Of an energy error: the place of the largest velocity over the speed of sound of its part, or of a value
/// that is not a number; the likely cause; advice.
std::string cause_of_energy_error(const Model& model);

/// Of a collapsed time step or an inverted element, at the element that sets the stable time step.
std::string cause_of_collapse(const Model& model);

}  // namespace brio
