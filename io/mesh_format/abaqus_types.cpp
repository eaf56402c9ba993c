#include "io/mesh_format/abaqus_types.hpp"

#include <string_view>

#include "io/mesh_file/element_kinds.hpp"

namespace brio {

namespace {

/// Beginning of the names of a family; the longest that fits is taken.
struct Family {
  std::string_view beginning;
  int nodes;
  ElementShape shape;
  const char* refused = "";
  int dimension = 0;
};
constexpr Family families[] = {
    {"C3D8", 8, ElementShape::hexahedron},
    {"C3D6", 6, ElementShape::wedge},
    {"SC8", 8, ElementShape::refused, "continuum shells", 3},
    {"S4", 4, ElementShape::quadrilateral},
    {"S3", 3, ElementShape::triangle},
    {"STRI3", 3, ElementShape::triangle},
    {"M3D4", 4, ElementShape::quadrilateral},
    {"M3D3", 3, ElementShape::triangle},
    {"R3D4", 4, ElementShape::quadrilateral},
    {"R3D3", 3, ElementShape::triangle},
    {"SFM3D4", 4, ElementShape::quadrilateral},
    {"SFM3D3", 3, ElementShape::triangle},
    {"CPS4", 4, ElementShape::quadrilateral},
    {"CPE4", 4, ElementShape::quadrilateral},
    {"CPS3", 3, ElementShape::triangle},
    {"CPE3", 3, ElementShape::triangle},
    {"B31", 2, ElementShape::line},
    {"B33", 2, ElementShape::line},
    {"T3D2", 2, ElementShape::line},
    {"PIPE31", 2, ElementShape::line},
    {"PC3D", 1, ElementShape::point},
    {"MASS", 1, ElementShape::point},
    {"C3D4", 4, ElementShape::refused, "tetrahedra with 4 nodes", 3},
    {"C3D5", 5, ElementShape::refused, "pyramids with 5 nodes", 3},
    {"C3D10", 10, ElementShape::refused, "tetrahedra with 10 nodes", 3},
    {"C3D15", 15, ElementShape::refused, "wedges with 15 nodes", 3},
    {"C3D20", 20, ElementShape::refused, "hexahedra with 20 nodes", 3},
    {"C3D27", 27, ElementShape::refused, "hexahedra with 27 nodes", 3},
    {"S8", 8, ElementShape::refused, "quadrilaterals with 8 nodes", 2},
    {"S9", 9, ElementShape::refused, "quadrilaterals with 9 nodes", 2},
    {"STRI65", 6, ElementShape::refused, "triangles with 6 nodes", 2},
    {"M3D6", 6, ElementShape::refused, "triangles with 6 nodes", 2},
    {"M3D8", 8, ElementShape::refused, "quadrilaterals with 8 nodes", 2},
    {"CPS6", 6, ElementShape::refused, "triangles with 6 nodes", 2},
    {"CPS8", 8, ElementShape::refused, "quadrilaterals with 8 nodes", 2},
    {"CPE6", 6, ElementShape::refused, "triangles with 6 nodes", 2},
    {"CPE8", 8, ElementShape::refused, "quadrilaterals with 8 nodes", 2},
    {"B32", 3, ElementShape::refused, "lines with 3 nodes", 1},
    {"T3D3", 3, ElementShape::refused, "lines with 3 nodes", 1},
    {"PIPE32", 3, ElementShape::refused, "lines with 3 nodes", 1},
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::optional<AbaqusType> abaqus_type(const std::string& name) {
  const Family* found = nullptr;
  for (const Family& family : families) {
    if (!name.starts_with(family.beginning)) continue;
    // What follows a number of nodes are letters: C3D8R, but not C3D80.
    if (name.size() > family.beginning.size() && is_digit(family.beginning.back()) &&
        is_digit(name[family.beginning.size()]))
      continue;
    if (found == nullptr || family.beginning.size() > found->beginning.size()) found = &family;
  }
  if (found == nullptr) return {};
  AbaqusType type{found->shape, found->nodes, {}};
  if (found->shape != ElementShape::refused) return type;
  if (found->beginning == "C3D4")
    type.refused = tetrahedra();
  else if (found->beginning == "C3D5")
    type.refused = pyramids();
  else if (found->beginning == "SC8")
    type.refused = {found->refused, 3, instead_of_others};
  else
    type.refused = {found->refused, found->dimension, instead_of_second_order};
  return type;
}

std::vector<std::vector<int>> abaqus_sides(ElementShape shape) {
  switch (shape) {
    case ElementShape::hexahedron:
      return {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    case ElementShape::wedge:
      return {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
    case ElementShape::quadrilateral:
      return {{0, 1, 2, 3}, {0, 3, 2, 1}, {0, 1}, {1, 2}, {2, 3}, {3, 0}};
    case ElementShape::triangle:
      return {{0, 1, 2}, {0, 2, 1}, {0, 1}, {1, 2}, {2, 0}};
    default:
      return {};
  }
}

}  // namespace brio
