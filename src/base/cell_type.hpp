#pragma once
/// Cell types by their VTK numbers, the only ones that elements need.

namespace brio {

enum CellType : unsigned char {
  vertex_cell = 1,
  line_cell = 3,
  quadrilateral_cell = 9,
  hexahedron_cell = 12
};

/// \param corners 1, 2, 4 or 8
constexpr CellType cell_with(int corners) {
  if (corners == 8) return hexahedron_cell;
  if (corners == 4) return quadrilateral_cell;
  return corners == 2 ? line_cell : vertex_cell;
}

/// Cells that contact and ties can touch on a side.
constexpr bool has_faces(CellType cell) { return cell == quadrilateral_cell || cell == hexahedron_cell; }

}  // namespace brio
