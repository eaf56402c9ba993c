#pragma once
/// Energies of parts in the history: PART.kinetic, PART.internal, PART.hourglass.

#include <string>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

/// Names of the columns, three a part.
void add_part_energy_columns(const Model& model, std::vector<std::string>& columns);

/// Kinetic energy of the last half step; of a node that parts share each of them has all.
void add_part_energy_values(const Model& model, std::vector<double>& row);

}  // namespace brio
