#pragma once
/// Elements that no part can be made of, and what to do instead.

#include "io/mesh_file/file_mesh.hpp"

namespace brio {

inline constexpr const char* instead_of_tetrahedra =
    "hexahedra are accepted: extrude surfaces of quadrilaterals in layers, or split tetrahedra in hexahedra "
    "(Gmsh: Mesh.SubdivisionAlgorithm = 2)";
inline constexpr const char* instead_of_pyramids = "hexahedra and wedges are accepted";
inline constexpr const char* instead_of_second_order =
    "elements of first order are accepted (Gmsh: Mesh.ElementOrder = 1)";
inline constexpr const char* instead_of_others =
    "accepted are hexahedra, wedges, quadrilaterals and triangles, lines and points of first order";

inline RefusedKind tetrahedra() { return {"tetrahedra with 4 nodes", 3, instead_of_tetrahedra}; }
inline RefusedKind pyramids() { return {"pyramids with 5 nodes", 3, instead_of_pyramids}; }

}  // namespace brio
