#pragma once
/// Element quality: the shape of single elements, from the positions of their corners: hexahedra (8) in VTK
/// order, shells (4), beams (2). Degenerate elements repeat a corner.

#include <array>
#include <span>
#include <vector>

#include "src/base/tensor.hpp"

namespace brio {

using Corner = Vector3d;

/// Corners of the edges of a hexahedron in VTK order, four a direction.
inline constexpr std::array<std::array<int, 2>, 12> edges_of_hex{
    {{0, 1}, {3, 2}, {4, 5}, {7, 6}, {0, 3}, {1, 2}, {4, 7}, {5, 6}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// Lengths of the edges; without those that a repeated corner makes 0.
std::vector<double> edge_lengths(std::span<const Corner> corners);

/// Longest edge over shortest; 1 of a single point.
double aspect_of(std::span<const Corner> corners);

/// Largest angle, in degrees, between the normals of the two triangles of a four-sided face, over both
/// diagonals and all faces; 0 of a beam and of triangles.
double warp_of(std::span<const Corner> corners);

/// Smallest scaled Jacobian over the corners: the determinant (of a shell: the area along its mean normal)
/// of the edges at a corner over the product of their lengths; 1 where they are square, at most 0 where a
/// corner is flat or inside out (Knupp 2000, "Achieving finite element mesh quality via optimization of the
/// Jacobian matrix norm"). A corner where a degenerate element repeats a node takes the edges of its
/// triangle. 1 of beams and points.
double scaled_jacobian_of(std::span<const Corner> corners);

/// Volume of a hexahedron with bilinear faces, below 0 where it is inside out: the mean over both ways to cut
/// every face in two triangles, which is exact.
double volume_of_hexahedron(std::span<const Corner, 8> corners);

}  // namespace brio
