#pragma once
/// Quality of the elements of a part.

#include "src/model/model.hpp"

namespace brio {

/// The worst over the elements of a part.
struct MeshQuality {
  double aspect = 1;    ///< longest edge over shortest
  double warp = 0;      ///< of a four-sided face, degrees
  double jacobian = 1;  ///< scaled, at a corner (`scaled_jacobian_of`)
  double step = 0;      ///< smallest stable time step; not finite: the part is rigid
  std::size_t degenerate =
      0;  ///< elements that repeat a node: wedges among hexahedra, triangles among shells
};

/// \pre the first step of the model is known
MeshQuality quality_of(const Model& model, std::size_t part);

}  // namespace brio
