#pragma once
/// Fields of points of scenes with contact: means since the last dump.

#include <span>

#include "src/fields/point_variable.hpp"

namespace brio {

/// Written of every scene with contact.
const PointVariable& contact_force_variable();
/// Those that a deck can name, `output.fields.variables`.
std::span<const PointVariable> contact_variables();

/// Area of the faces at a node, a quarter of each (a third of a triangle), as seen along a force on the node:
/// of the faces of solids that the force pushes upon, of shells from either side. \param area of all of them
/// \param direction unit vector
double pushed_area(const Surface& surface, const Nodes& nodes, int slave, const Vector3d& direction,
                   double& area);

}  // namespace brio
