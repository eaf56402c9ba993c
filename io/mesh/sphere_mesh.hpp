#pragma once
/// Meshes of solid and hollow spheres, from the six sides of a cube.

#include "src/deck/mesh.hpp"

namespace brio {

/// Hexahedra filling a sphere about the origin: a core with bulging sides in layers that lead to the sphere.
/// No corner has a scaled Jacobian below 0.67. Sets: outside all. \param across elements across the diameter,
/// even \param keep_volume the sphere is drawn so much larger that its elements fill the volume of the round
/// one
Mesh sphere_mesh(double radius, int across, bool keep_volume);

/// Shells on a sphere about the origin, seen from outside. Set: all.
/// \param around elements along each edge of the cube: a quarter of those around the equator
Mesh hollow_sphere_mesh(double radius, int around);

}  // namespace brio
