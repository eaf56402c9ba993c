#include "contact/audit/distance.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

double ratio_within(double part, double whole) {
  return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0;
}

double squared_distance_to_edge(const Vector3d& x, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  return squared_norm(x - a - ratio_within(dot(x - a, along), squared_norm(along)) * along);
}

}  // namespace

double squared_distance_to_triangle(const Vector3d& x, const Vector3d& a, const Vector3d& b,
                                    const Vector3d& c) {
  const Vector3d normal = cross(b - a, c - a);
  const double area = squared_norm(normal);
  if (area > 0 && dot(normal, cross(b - a, x - a)) >= 0 && dot(normal, cross(c - b, x - b)) >= 0 &&
      dot(normal, cross(a - c, x - c)) >= 0) {
    const double height = dot(normal, x - a);
    return height * height / area;
  }
  return std::min({squared_distance_to_edge(x, a, b), squared_distance_to_edge(x, b, c),
                   squared_distance_to_edge(x, c, a)});
}

double distance_to_face(const Vector3d& x, const std::array<Vector3d, 4>& face, int corners) {
  if (corners == 3) return std::sqrt(squared_distance_to_triangle(x, face[0], face[1], face[2]));
  const Vector3d middle = 0.25 * (face[0] + face[1] + face[2] + face[3]);
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < 4; ++k)
    least = std::min(least, squared_distance_to_triangle(x, middle, face[k], face[(k + 1) % 4]));
  return std::sqrt(least);
}

SegmentDistance distance_of_segments(const std::array<Vector3d, 2>& first,
                                     const std::array<Vector3d, 2>& second) {
  const Vector3d u = first[1] - first[0], v = second[1] - second[0], between = first[0] - second[0];
  const double uu = squared_norm(u), vv = squared_norm(v), uv = dot(u, v);
  const double u_between = dot(u, between), v_between = dot(v, between);
  const auto on_second = [&](double s) { return ratio_within(uv * s + v_between, vv); };
  const auto on_first = [&](double t) { return ratio_within(uv * t - u_between, uu); };
  double s = ratio_within(uv * v_between - vv * u_between, uu * vv - uv * uv);
  const double t = on_second(s);
  s = on_first(t);
  return {.distance = norm(between + s * u - t * v), .parameter = {s, t}};
}

}  // namespace brio
