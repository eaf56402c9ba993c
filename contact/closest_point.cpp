#include "contact/closest_point.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/floating_point.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

// a b - c d with the rounding of c d given back (Kahan; Jeannerod, Louvet and Muller 2013: within 1.5 units
// in the last place).
double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  const double given_back = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + given_back;
}

// What is known of the triangle as seen from the node.
struct View {
  std::array<Vector3d, 3> to;    // from the node to each vertex
  std::array<Vector3d, 3> edge;  // from vertex k to vertex k+1
  Vector3d area;
};

Vector3d weighted(const View& view, const std::array<double, 3>& w) {
  return w[0] * view.to[0] + w[1] * view.to[1] + w[2] * view.to[2];
}

void normalise(std::array<double, 3>& weights) {
  for (double& w : weights) w = std::max(w, 0.0);
  const double sum = weights[0] + weights[1] + weights[2];
  for (double& w : weights) w /= sum;
}

// Foot on the segment of edge k. A segment is well conditioned whatever the triangle.
TrianglePoint foot_on_edge(const View& view, int k) {
  const int next = (k + 1) % 3;
  const Vector3d& start = view.to[static_cast<std::size_t>(k)];
  const Vector3d& along = view.edge[static_cast<std::size_t>(k)];
  const double length_squared = along.squaredNorm();
  const double reach = -start.dot(along);
  TrianglePoint foot;
  foot.weights = {0, 0, 0};
  foot.area_vector = view.area;
  foot.feature = Feature::edge;
  foot.index = k;
  double share = 0;
  if (reach <= 0 || length_squared == 0) {
    foot.feature = Feature::vertex;
  } else if (reach >= length_squared) {
    foot.feature = Feature::vertex;
    foot.index = next;
    share = 1;
  } else {
    share = reach / length_squared;
  }
  foot.weights[static_cast<std::size_t>(k)] = 1 - share;
  foot.weights[static_cast<std::size_t>(next)] = share;
  // From the nearer end: the foot then carries the rounding of its own small distance to it.
  foot.offset = share <= 0.5 ? Vector3d(start + share * along)
                             : Vector3d(view.to[static_cast<std::size_t>(next)] - (1 - share) * along);
  foot.squared_distance = foot.offset.squaredNorm();
  return foot;
}

// The foot of the perpendicular, given weights that are about right: what is left of the offset within the
// plane is taken out again, because in a sliver the first weights are good only to (length / height)
// roundings.
void refine(const View& view, TrianglePoint& foot) {
  const double area_squared = view.area.squaredNorm();
  const double resolution = 4 * unit_roundoff * (view.to[0].lpNorm<1>() + view.edge[0].lpNorm<1>());
  for (int pass = 0; pass < 3; ++pass) {
    const Vector3d in_plane = foot.offset - view.area * (view.area.dot(foot.offset) / area_squared);
    if (in_plane.lpNorm<Eigen::Infinity>() <= resolution) return;
    TrianglePoint better = foot;
    const double to_second = view.area.dot(accurate_cross(in_plane, view.edge[2])) / area_squared;
    const double to_third = -view.area.dot(accurate_cross(view.edge[0], in_plane)) / area_squared;
    better.weights[1] += to_second;
    better.weights[2] += to_third;
    better.weights[0] -= to_second + to_third;
    normalise(better.weights);
    better.offset = weighted(view, better.weights);
    better.squared_distance = better.offset.squaredNorm();
    if (!(better.squared_distance < foot.squared_distance)) return;
    foot = better;
  }
}

// The foot of the perpendicular if it falls inside the triangle.
bool foot_inside(const View& view, TrianglePoint& foot) {
  const double area_squared = view.area.squaredNorm();
  if (!(area_squared > 0)) return false;
  std::array<double, 3> weights;
  for (std::size_t k = 0; k < 3; ++k) {  // edge k faces vertex k+2
    const double inside = view.area.dot(accurate_cross(view.to[k], view.edge[k]));
    if (!(inside > 0)) return false;
    weights[(k + 2) % 3] = inside;
  }
  normalise(weights);
  foot.weights = weights;
  foot.area_vector = view.area;
  foot.feature = Feature::interior;
  foot.index = 0;
  foot.offset = weighted(view, weights);
  foot.squared_distance = foot.offset.squaredNorm();
  refine(view, foot);
  return true;
}

}  // namespace

Vector3d accurate_cross(const Vector3d& a, const Vector3d& b) {
  return {difference_of_products(a[1], b[2], a[2], b[1]), difference_of_products(a[2], b[0], a[0], b[2]),
          difference_of_products(a[0], b[1], a[1], b[0])};
}

TrianglePoint closest_point_on_triangle(const Vector3d& node, const std::array<Vector3d, 3>& vertices) {
  View view;
  for (std::size_t k = 0; k < 3; ++k) {
    view.to[k] = vertices[k] - node;
    view.edge[k] = vertices[(k + 1) % 3] - vertices[k];
  }
  view.area = accurate_cross(view.edge[2], view.edge[0]);
  TrianglePoint best;
  bool found = foot_inside(view, best);
  for (int k = 0; k < 3; ++k) {
    const TrianglePoint foot = foot_on_edge(view, k);
    if (!found || foot.squared_distance < best.squared_distance) best = foot;
    found = true;
  }
  return best;
}

double safe_length(const Vector3d& vector) {
  const double squared = vector.squaredNorm();
  if (squared > 0x1p-900 && squared < 0x1p900) return std::sqrt(squared);
  const double largest = vector.lpNorm<Eigen::Infinity>();
  return largest > 0 && largest < infinity ? largest * (vector / largest).norm() : largest;
}

Vector3d unit_or(const Vector3d& area_vector, const Vector3d& otherwise) {
  const double length = safe_length(area_vector);
  if (length > 0) return area_vector / length;
  const double other_length = safe_length(otherwise);
  return other_length > 0 ? Vector3d(otherwise / other_length) : Vector3d::Zero();
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
    const auto first = static_cast<std::size_t>(k);
    const auto second = static_cast<std::size_t>((k + 1) % 4);
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

double signed_gap(const ClosestPoint& closest, const Vector3d& normal) {
  const double distance = std::sqrt(closest.squared_distance);
  return closest.separation.dot(normal) < 0 ? -distance : distance;
}

double normal_gap(const ClosestPoint& closest) { return closest.separation.dot(closest.normal); }

}  // namespace brio
