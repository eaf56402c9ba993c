#pragma once
/// Segments and triangles chosen to be difficult for the predicate of the audit.

#include <array>
#include <string_view>

#include "tests/contact/geometry/adversarial_queries.hpp"

namespace brio::test {

struct SegmentAndTriangle {
  std::array<Vector3d, 2> segment;
  std::array<Vector3d, 3> triangle;
};

enum class CrossingFamily {
  random,           // all of a size
  through_inside,   // aimed at the inside
  through_edge,     // aimed at an edge, or beside it by 1e-17 to 1e-2
  through_corner,   // aimed at a corner, or beside it
  end_on_triangle,  // an end in the plane but for 1e-17 to 1e-2
  coplanar,         // all in one plane but for rounding
  lattice,          // small integers: exact touches of every kind
  sliver,           // height of the triangle 1e-17 to 1e-1 of its length, or none
  parallel_edge,    // along an edge of the triangle but for rounding
  short_segment,    // 1e-12 to 1e-3 of the triangle
  far_from_origin,  // any of these, 1e6 sizes away
};
inline constexpr int crossing_family_count = 11;

std::string_view name_of(CrossingFamily family);

SegmentAndTriangle adversarial_crossing(CrossingFamily family, Random& random);

}  // namespace brio::test
