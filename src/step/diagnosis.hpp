#pragma once
/// What a run that breaks down says of the place, the likely cause and what to try.

#include <string>

#include "src/model/model.hpp"

namespace brio {

/// As few digits as tell a number; in every locale the same.
std::string written(double number);

/// "element 3 of part 'cube'"; by the numbers of the part's mesh.
std::string element_name(const Model& model, std::size_t block, std::size_t element);

/// Of an energy error: where nodes move fastest by the speed of sound of their part, or where a value is not
/// a number; the likely cause; what to try.
std::string cause_of_energy_error(const Model& model);

/// Of a step that has collapsed, or an element that has inverted, at the element that sets the step.
std::string cause_of_collapse(const Model& model);

}  // namespace brio
