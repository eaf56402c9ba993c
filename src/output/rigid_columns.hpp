#pragma once
/// Motion of rigid parts in the history: PART.centre_x, _y, _z, PART.rotation_x, _y, _z.

#include <string>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

/// Names of the columns, six a rigid part.
void add_rigid_columns(const Model& model, std::vector<std::string>& columns);

/// Place of the centre of mass; rotation from the attitude at the start to the present one as a vector: axis
/// times angle in [0, pi].
void add_rigid_values(const Model& model, std::vector<double>& row);

}  // namespace brio
