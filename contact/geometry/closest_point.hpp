#pragma once
/// Closest point of a triangle and of a quadrilateral face to a node, with the feature it lies on. Everything
/// here is local to one face: normals that need the neighbours (angle-weighted at vertices, averaged at
/// edges: Baerentzen and Aanaes 2005) belong to whoever knows the neighbours.
///
/// A face has four vertices, counterclockwise when seen from the side its normal points to. It is the union
/// of four triangles (centroid, vertex k, vertex k+1), the centroid being the mean of the four vertices. A
/// triangular face repeats its third vertex as the fourth and is then that one triangle.

#include <array>

#include "src/base/tensor.hpp"

namespace brio {

using FaceVertices = std::array<Vector3d, 4>;

/// A weight below this is rounding: the closest point does not lie on that corner's side.
inline constexpr double no_weight = 1e-9;

enum class Feature { interior, edge, vertex };

/// a x b, each component correct to about one rounding even where the products nearly cancel (Kahan's
/// difference of products with fused multiply-add): the normal of a sliver keeps its direction.
Vector3d accurate_cross(const Vector3d& a, const Vector3d& b);

/// Closest point of one triangle.
struct TrianglePoint {
  std::array<double, 3> weights;  // of the three vertices: none negative, their sum is 1
  Vector3d offset;                // from the node to the closest point, in the unit of the vertices
  Vector3d area_vector;           // (b - a) x (c - a): twice the area times the unit normal
  double squared_distance;
  Feature feature;
  int index;  // edge k joins vertices k and k+1; vertex k; 0 in the interior
};

/// Closest point of the triangle to the node. Slivers and triangles without area are allowed: whatever the
/// shape, the point lies on the triangle and is the closest within a few roundings of the distances involved.
TrianglePoint closest_point_on_triangle(const Vector3d& node, const std::array<Vector3d, 3>& vertices);

/// Closest point of a face.
struct ClosestPoint {
  Vector3d point;
  Vector3d separation;  // node - point, formed from local differences, so exact also far from the origin
  std::array<double, 4> weights;  // of the four face vertices: none negative, their sum is 1
  Vector3d normal;  // unit normal of the sub-triangle; zero if neither it nor the face has an area
  double squared_distance;
  Feature feature;   // seams between sub-triangles belong to the interior
  int index;         // edge k joins face vertices k and k+1; vertex k; the sub-triangle in the interior
  int sub_triangle;  // 0..3, one of those that share the closest point; 0 for a triangular face
};

ClosestPoint closest_point_on_quad(const Vector3d& node, const FaceVertices& vertices);

/// Whether the fourth vertex repeats the third.
inline bool is_triangle(const FaceVertices& vertices) { return vertices[3] == vertices[2]; }

/// Length without overflow or underflow of squares.
double safe_length(const Vector3d& vector);

/// Unit vector along `area_vector`, or along `otherwise` if that has no length, or zero if neither has.
Vector3d unit_or(const Vector3d& area_vector, const Vector3d& otherwise);

}  // namespace brio
