#pragma once
/// Quadrilaterals in the plane, of which the mesh generators pull their solids along z.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "src/deck/mesh.hpp"

namespace brio {

using Point2 = std::array<double, 2>;

/// An edge of a quadrilateral: from its corner `edge` to the next one.
struct SectionEdge {
  int quad;
  int edge;
};

struct Section {
  std::vector<Point2> point;
  std::vector<std::array<int, 4>> quad;  ///< counter-clockwise
  std::map<std::string, std::vector<SectionEdge>> edges;
};

/// nx by ny quadrilaterals on the rectangle centred on the origin. Edges: xmin xmax ymin ymax.
Section rectangle_section(Point2 size, std::array<int, 2> elements);

/// A closed ring between two radii. Edges: inside outside.
Section ring_section(double inner_radius, double outer_radius, int around, int through);

/// A disc: a square core with bulging sides in a ring of layers (an O-grid). Edges: outside.
/// \param across elements across the diameter, even
/// \param keep_area the outer nodes stand out of the circle so far that the facets enclose its area
Section disc_section(double radius, int across, bool keep_area);

/// A blade's section: its edge on the point (0, 0), up along the second axis to the height. From the width of
/// its tip it widens on both sides by the half angle to the thickness. A tip of no width is one point that
/// the quadrilaterals above it share. Edges: xmin xmax zmax, and zmin where the tip has a width.
struct BladeSize {
  double thickness;
  double height;
  double tip_width;
  double shoulder;  ///< height at which the full thickness is reached
};
Section blade_section(const BladeSize& size, int across, int up);

/// Hexahedra over a section, in `layers` from z = start to z = start + length. The section's edges become
/// side sets and node sets; bottom, top and all (the whole surface; every node) are added.
Mesh pull_along_z(const Section& section, double start, double length, int layers);

/// Corners of a side set, each node once, ascending.
std::vector<int> nodes_of_sides(const Mesh& mesh, const std::vector<ElementSide>& sides);

}  // namespace brio
