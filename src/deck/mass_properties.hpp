#pragma once
/// Mass, centre and inertia of a mesh of hexahedra or shells.

#include "src/base/tensor.hpp"
#include "src/deck/mesh.hpp"

namespace brio {

struct MassProperties {
  double mass = 0;
  Vector3d centre{};
  Tensor<double> inertia{};  ///< about the centre, along the axes of the mesh
};

/// Integrals over the elements as they are drawn: exact for trilinear hexahedra.
/// \param thickness of shells
/// \throws std::invalid_argument naming an element without volume
MassProperties mass_properties(const Mesh& mesh, double density, double thickness);

}  // namespace brio
