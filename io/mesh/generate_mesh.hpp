#pragma once
/// Meshes of simple shapes, from what the deck says about them.

#include <string_view>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/deck/mesh.hpp"

namespace brio {

/// Nodes, elements and named sets of a shape, where `placement` puts them.
/// Hexahedra have VTK node order and positive volume; shells are seen counter-clockwise from their outward
/// side.
Mesh generate_mesh(const MeshSource& source, const Placement& placement);

/// 8 for solid shapes, 4 for shells, 2 for lines, 1 for particles. Of a mesh file what was read.
int nodes_per_element(const MeshSource& source);

/// Names of the node sets that `generate_mesh` makes of a shape, in alphabetical order.
std::vector<std::string_view> node_set_names(const MeshSource& source);
/// The same for its side sets.
std::vector<std::string_view> side_set_names(const MeshSource& source);

/// Where a placement puts a point: first turned, then moved. Quarter turns are exact.
Vector3d place(const Placement& placement, const Vector3d& point);

}  // namespace brio
