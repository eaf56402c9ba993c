#pragma once
/// Positions of faces, and the normals that need the neighbours of a face.

#include "contact/geometry/closest_point.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/index.hpp"
#include "src/base/nodes.hpp"
#include "src/base/tensor.hpp"

namespace brio {

inline FaceVertices vertices(const Nodes& nodes, const Face& face) {
  return {position(nodes, face.node[0]), position(nodes, face.node[1]), position(nodes, face.node[2]),
          position(nodes, face.node[3])};
}

/// Normal of the sub-triangle of a face that holds the edge from corner k to the next, not normalised.
Vector3d sub_triangle_area(const FaceVertices& vertices, int k);

/// Normals of a closed surface that tell inside from outside at any feature: of the face, the mean of both
/// faces at an edge, angle-weighted at a vertex (Baerentzen and Aanaes 2005). Of unit length; zero without
/// any area.
Vector3d pseudo_normal(const Surface& surface, const Nodes& nodes, int face, const ClosestPoint& closest);

/// Whether the node is not inside the closed surface, as its pseudo-normal says at the closest point; the
/// normals around a vertex are weighed only where they disagree.
bool is_outside(const Surface& surface, const Nodes& nodes, int face, const ClosestPoint& closest);

/// Angle-weighted normal of the hexahedron sides around a slave node.
Vector3d vertex_normal(const Surface& surface, const Nodes& nodes, int slave);
/// The same of one fan of them.
Vector3d fan_normal(const Surface& surface, const Nodes& nodes, int slave, int face);

/// Whether any of the hexahedron sides around a slave node looks against a unit vector there: its normal
/// times the vector is below a limit. Their mean would not tell: that of a rim sees neither of the surfaces
/// that meet in it.
bool looks_against(const Surface& surface, const Nodes& nodes, int slave, const Vector3d& direction,
                   double limit);

/// Shortest side of a face.
double shortest_edge(const Nodes& nodes, const Face& face);

}  // namespace brio
