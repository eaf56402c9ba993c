#pragma once
/// The crossing of a segment and a triangle in integer arithmetic (GMP), by the point in which the segment
/// meets the plane.

#include <array>

#include "contact/audit/segment_triangle.hpp"

namespace brio::test {

struct ExactCrossing {
  int start = 0, end = 0;       ///< sides of the plane on which the ends lie: 1, 0, -1
  std::array<int, 3> within{};  ///< of each edge: 1 inside, 0 on it, -1 outside; where the plane is crossed

  bool crosses(const Continuation& continues) const {
    if (start * end >= 0) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (within[k] < 0 || (within[k] == 0 && !continues.edge[k])) return false;
      if (within[k] == 0 && within[(k + 1) % 3] == 0 && !continues.corner[(k + 1) % 3]) return false;
    }
    return true;
  }
};

ExactCrossing judge_crossing(const std::array<Vector3d, 2>& segment, const std::array<Vector3d, 3>& triangle);

}  // namespace brio::test
