#include "contact/geometry/closest_point.hpp"

#include <cmath>

#include "contact/geometry/closest_on_triangle.hpp"
#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

namespace {

// a b - c d with the rounding of c d given back (Kahan; Jeannerod, Louvet and Muller 2013: within 1.5 units
// in the last place).
double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  const double given_back = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + given_back;
}

}  // namespace

Vector3d accurate_cross(const Vector3d& a, const Vector3d& b) {
  return {difference_of_products(a[1], b[2], a[2], b[1]), difference_of_products(a[2], b[0], a[0], b[2]),
          difference_of_products(a[0], b[1], a[1], b[0])};
}

TrianglePoint closest_point_on_triangle(const Vector3d& node, const std::array<Vector3d, 3>& vertices) {
  const auto [a, b, c] = vertices;
  const ClosestOnTriangle<double> found = closest_on_triangle(node, a, b, c);
  TrianglePoint point{found.weights,          -found.offset,     accurate_cross(a - c, b - a),
                      found.squared_distance, Feature::interior, 0};
  // Edge k faces vertex k + 2.
  for (int k = 0; k < 3; ++k) {
    if (found.weights[index((k + 2) % 3)] == 0) {
      point.feature = Feature::edge;
      point.index = k;
    }
  }
  for (int k = 0; k < 3; ++k) {
    if (found.weights[index(k)] == 1) {
      point.feature = Feature::vertex;
      point.index = k;
    }
  }
  return point;
}

double safe_length(const Vector3d& vector) {
  const double squared = squared_norm(vector);
  if (squared > 0x1p-900 && squared < 0x1p900) return std::sqrt(squared);
  const double largest = maximum_norm(vector);
  return largest > 0 && largest < infinity ? largest * norm(vector / largest) : largest;
}

Vector3d unit_or(const Vector3d& area_vector, const Vector3d& otherwise) {
  const double length = safe_length(area_vector);
  if (length > 0) return area_vector / length;
  const double other_length = safe_length(otherwise);
  return other_length > 0 ? otherwise / other_length : Vector3d{};
}

ClosestPoint closest_point_on_quad(const Vector3d& node, const FaceVertices& vertices) {
  const Vector3d& origin = vertices[0];
  const Vector3d local_node = node - origin;
  FaceVertices local;
  for (std::size_t k = 0; k < 4; ++k) local[k] = vertices[k] - origin;
  const bool triangle = is_triangle(vertices);
  const Vector3d centroid = 0.25 * (local[1] + local[2] + local[3]);  // local[0] is zero
  const Vector3d face_area = accurate_cross(local[2] - local[0], local[3] - local[1]);

  ClosestPoint closest;
  Vector3d area_vector = face_area;
  closest.squared_distance = infinity;
  for (int k = 0; k < (triangle ? 1 : 4); ++k) {
    const auto first = index(k);
    const auto second = index((k + 1) % 4);
    const TrianglePoint foot =
        triangle ? closest_point_on_triangle(local_node, {local[0], local[1], local[2]})
                 : closest_point_on_triangle(local_node, {centroid, local[first], local[second]});
    if (!(foot.squared_distance < closest.squared_distance)) continue;
    closest.squared_distance = foot.squared_distance;
    closest.separation = -foot.offset;
    closest.point = origin + (local_node + foot.offset);
    area_vector = foot.area_vector;
    closest.sub_triangle = k;
    closest.feature = foot.feature;
    closest.index = foot.index;
    if (triangle) {
      closest.weights = {foot.weights[0], foot.weights[1], foot.weights[2], 0};
      continue;
    }
    closest.weights.fill(0.25 * foot.weights[0]);
    closest.weights[first] += foot.weights[1];
    closest.weights[second] += foot.weights[2];
    const bool outer = (foot.feature == Feature::edge && foot.index == 1) ||
                       (foot.feature == Feature::vertex && foot.index != 0);
    if (!outer) closest.feature = Feature::interior;
    const bool last = foot.feature == Feature::vertex && foot.index == 2;
    closest.index = last ? (k + 1) % 4 : k;
  }
  closest.normal = unit_or(area_vector, face_area);
  return closest;
}

}  // namespace brio
