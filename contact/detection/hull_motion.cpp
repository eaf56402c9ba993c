#include "contact/detection/hull_motion.hpp"

#include <cmath>

#include "contact/apart.hpp"
#include "contact/detection/closest_on_hull.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

constexpr std::size_t hull_triangles[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};

Vector3<double> lane_vector(const Vector3d& a) { return {a[0], a[1], a[2]}; }
Vector3d eigen_vector(const Vector3<double>& a) { return {a.x, a.y, a.z}; }

ClosestOnHull<double> hull_at_start(const MovingNode& node, const MovingFace& face) {
  return closest_on_hull(lane_vector(node.start), {lane_vector(face.start[0]), lane_vector(face.start[1]),
                                                   lane_vector(face.start[2]), lane_vector(face.start[3])});
}

bool hull_stays_apart(const MovingNode& node, const MovingFace& face, double reach) {
  MovingPair<double> pair;
  pair.start[0] = lane_vector(node.start);
  pair.displacement[0] = lane_vector(node.displacement);
  for (std::size_t k = 0; k < 4; ++k) {
    pair.start[k + 1] = lane_vector(face.start[k]);
    pair.displacement[k + 1] = lane_vector(face.displacement[k]);
  }
  return surely_apart(pair, reach);
}

MovingFace hull_triangle(const MovingFace& face, std::size_t which) {
  const auto& [a, b, c] = hull_triangles[which];
  return {{face.start[a], face.start[b], face.start[c], face.start[c]},
          {face.displacement[a], face.displacement[b], face.displacement[c], face.displacement[c]}};
}

// From the point of the weights to the node, at the time.
Vector3d offset_from_hull(const MovingNode& node, const MovingFace& face,
                          const std::array<double, 4>& weights, double time) {
  Vector3d offset = Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    offset += weights[k] * ((node.start - face.start[k]) + time * (node.displacement - face.displacement[k]));
  return offset;
}

}  // namespace

std::optional<MotionContact> hull_motion(const MovingNode& node, const MovingFace& face, double reach) {
  if (hull_stays_apart(node, face, reach)) return std::nullopt;
  const ClosestOnHull<double> start = hull_at_start(node, face);
  const Vector3d start_direction = unit_or(eigen_vector(start.offset), Vector3d::Zero());
  if (start.inside) return MotionContact{0, start.weights, -start_direction, 0};

  const bool is_triangle = face.start[3] == face.start[2] && face.displacement[3] == face.displacement[2];
  std::optional<MotionContact> first;
  for (std::size_t which = 0; which < (is_triangle ? 1 : 4); ++which) {
    const auto contact = velocity_check(node, hull_triangle(face, which), reach);
    if (!contact || (first && contact->time >= first->time)) continue;
    first = MotionContact{contact->time, {0, 0, 0, 0}, contact->side * contact->normal, contact->distance};
    for (std::size_t k = 0; k < 3; ++k) first->weights[hull_triangles[which][k]] = contact->weights[k];
  }
  if (!first) return std::nullopt;
  // At a distance the normal is along it. Else the triangle tells; sliding in its plane, the start does.
  if (reach > 0) {
    const Vector3d offset = offset_from_hull(node, face, first->weights, first->time);
    if (offset.norm() > 0.5 * reach) first->normal = offset.normalized();
  }
  if (first->normal.isZero(0)) first->normal = start_direction;
  return first;
}

std::optional<MotionContact> edge_motion(const MovingEdge& a, const MovingEdge& b) {
  const auto contact = edge_check(a, b);
  if (!contact) return std::nullopt;
  const auto& [on_a, on_b] = contact->parameters;
  return MotionContact{contact->time, {1 - on_a, on_a, 1 - on_b, on_b}, contact->normal, contact->distance};
}

}  // namespace brio
