#include "tests/contact/audit/exact_crossing.hpp"

#include "tests/contact/geometry/exact_geometry.hpp"

namespace brio::test {

ExactCrossing judge_crossing(const std::array<Vector3d, 2>& segment,
                             const std::array<Vector3d, 3>& triangle) {
  using namespace exact;
  Scaled scaled;
  for (const Vector3d& x : segment) scaled.note(x);
  for (const Vector3d& x : triangle) scaled.note(x);
  const IntegerVector corner[3] = {scaled(triangle[0]), scaled(triangle[1]), scaled(triangle[2])};
  const IntegerVector from = scaled(segment[0]), to = scaled(segment[1]);
  const IntegerVector normal = exact::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const Integer above = dot(from - corner[0], normal), below = dot(to - corner[0], normal);
  ExactCrossing result;
  result.start = sgn(above);
  result.end = sgn(below);
  if (result.start * result.end >= 0) return result;
  // The point times (above - below), which has the sign at the start.
  const Integer scale = above - below;
  for (std::size_t k = 0; k < 3; ++k) {
    const IntegerVector edge = corner[(k + 1) % 3] - corner[k];
    IntegerVector point;
    for (std::size_t i = 0; i < 3; ++i) point[i] = above * to[i] - below * from[i] - scale * corner[k][i];
    result.within[k] = sgn(dot(exact::cross(edge, point), normal)) * result.start;
  }
  return result;
}

}  // namespace brio::test
