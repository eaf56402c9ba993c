#include "contact/audit/segment_triangle.hpp"

#include <algorithm>
#include <cmath>

#include "contact/audit/orientation.hpp"

namespace brio {

namespace {

Vector3d permanent_of(const Vector3d& u, const Vector3d& v) {
  const Vector3d a = absolute(u), b = absolute(v);
  return {a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]};
}

int side_of(const Vector3d& x, const SurfaceTriangle& triangle) {
  const SurfaceTriangle::Volume volume = triangle.volume(x);
  if (std::abs(volume.value) > volume.error) return volume.value > 0 ? 1 : -1;
  return exact_orientation(triangle.corner[0], triangle.corner[1], triangle.corner[2], x);
}

}  // namespace

static_assert(orientation_error <= 0x1p-50);

SurfaceTriangle::SurfaceTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                                 const Continuation& continuing)
    : corner{a, b, c},
      continues(continuing),
      area(cross(b - a, c - a)),
      permanent(permanent_of(b - a, c - a)),
      twice_area(norm(area)) {}

bool crosses(const Vector3d& from, const Vector3d& to, const SurfaceTriangle& triangle) {
  const int start = side_of(from, triangle);
  if (start == 0 || side_of(to, triangle) != -start) return false;
  std::array<int, 3> turn{};
  for (std::size_t k = 0; k < 3; ++k) {
    // Seen from the end on the side of the normal, the edges of a triangle around a line turn
    // counterclockwise.
    turn[k] = orientation(from, to, triangle.corner[k], triangle.corner[(k + 1) % 3]) * -start;
    if (turn[k] < 0 || (turn[k] == 0 && !triangle.continues.edge[k])) return false;
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (turn[k] == 0 && turn[(k + 2) % 3] == 0 && !triangle.continues.corner[k]) return false;
  return true;
}

double crossing_depth(const Vector3d& from, const Vector3d& to, const SurfaceTriangle& triangle) {
  double depth = std::min(std::abs(triangle.volume(from).value), std::abs(triangle.volume(to).value)) /
                 triangle.twice_area;
  const Vector3d along = normalized(to - from);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& corner = triangle.corner[k];
    if (!triangle.continues.corner[k]) depth = std::min(depth, norm(cross(along, corner - from)));
    if (triangle.continues.edge[k]) continue;
    const Vector3d both = cross(along, triangle.corner[(k + 1) % 3] - corner);
    const double size = norm(both);
    if (size > 0) depth = std::min(depth, std::abs(dot(both, corner - from)) / size);
  }
  return depth;
}

}  // namespace brio
