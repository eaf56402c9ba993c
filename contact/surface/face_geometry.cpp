#include "contact/surface/face_geometry.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

Vector3d unit(const Vector3d& vector) { return unit_or(vector, Vector3d{}); }

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

Vector3d centroid(const FaceVertices& v) {
  return v[0] + 0.25 * ((v[1] - v[0]) + (v[2] - v[0]) + (v[3] - v[0]));
}

// What one face adds to the normal at its corner: of each sub-triangle there, its normal times its angle.
Vector3d corner_share(const FaceVertices& v, std::size_t corner) {
  if (is_triangle(v)) {
    const Vector3d to_next = v[(corner + 1) % 3] - v[corner];
    const Vector3d to_last = v[(corner + 2) % 3] - v[corner];
    return angle_between(to_next, to_last) * unit(cross(to_next, to_last));
  }
  const Vector3d to_middle = centroid(v) - v[corner];
  const Vector3d to_next = v[(corner + 1) % 4] - v[corner];
  const Vector3d to_last = v[(corner + 3) % 4] - v[corner];
  return angle_between(to_next, to_middle) * unit(cross(to_next, to_middle)) +
         angle_between(to_middle, to_last) * unit(cross(to_middle, to_last));
}

Vector3d edge_normal(const Surface& surface, const Nodes& nodes, int face, const ClosestPoint& closest) {
  const auto k = index(closest.index);
  const int other = surface.neighbor[index(face)][k];
  if (other < 0) return closest.normal;
  const Face& own = surface.face[index(face)];
  const Face& across = surface.face[index(other)];
  const int from = own.node[k];
  const int to = own.node[(k + 1) % index(own.corners())];
  for (int j = 0; j < across.corners(); ++j) {
    const int a = across.node[index(j)];
    const int b = across.node[index((j + 1) % across.corners())];
    if (a == to && b == from)
      return unit_or(closest.normal + unit(sub_triangle_area(vertices(nodes, across), j)), closest.normal);
  }
  return closest.normal;
}

}  // namespace

Vector3d sub_triangle_area(const FaceVertices& v, int k) {
  if (is_triangle(v)) return accurate_cross(v[1] - v[0], v[2] - v[0]);
  const auto first = index(k);
  const Vector3d middle = centroid(v);
  return accurate_cross(v[first] - middle, v[(first + 1) % 4] - middle);
}

Vector3d vertex_normal(const Surface& surface, const Nodes& nodes, int slave) {
  Vector3d sum{};
  const int node = surface.node[index(slave)];
  for (int f : surface.faces_of.of(slave)) {
    const Face& face = surface.face[index(f)];
    if (face.shell) continue;
    for (std::size_t k = 0; k < index(face.corners()); ++k)
      if (face.node[k] == node) sum += corner_share(vertices(nodes, face), k);
  }
  return unit_or(sum, Vector3d{});
}

Vector3d fan_normal(const Surface& surface, const Nodes& nodes, int slave, int face) {
  Vector3d sum{};
  const int node = surface.node[index(slave)];
  for_fan(surface, slave, face, [&](int f) {
    const Face& own = surface.face[index(f)];
    for (std::size_t k = 0; k < index(own.corners()); ++k)
      if (own.node[k] == node) sum += corner_share(vertices(nodes, own), k);
  });
  return unit_or(sum, Vector3d{});
}

bool looks_against(const Surface& surface, const Nodes& nodes, int slave, const Vector3d& direction,
                   double limit) {
  const int node = surface.node[index(slave)];
  for (int f : surface.faces_of.of(slave)) {
    const Face& face = surface.face[index(f)];
    if (face.shell) continue;
    for (std::size_t k = 0; k < index(face.corners()); ++k)
      if (face.node[k] == node && dot(unit(corner_share(vertices(nodes, face), k)), direction) < limit)
        return true;
  }
  return false;
}

Vector3d pseudo_normal(const Surface& surface, const Nodes& nodes, int face, const ClosestPoint& closest) {
  if (closest.feature == Feature::interior) return closest.normal;
  if (closest.feature == Feature::edge) return edge_normal(surface, nodes, face, closest);
  const Face& own = surface.face[index(face)];
  const int slave = surface.slave(own.node[index(closest.index)]);
  return surface.pinched[index(slave)] != 0 ? fan_normal(surface, nodes, slave, face)
                                            : vertex_normal(surface, nodes, slave);
}

bool is_outside(const Surface& surface, const Nodes& nodes, int face, const ClosestPoint& closest) {
  if (closest.feature == Feature::vertex) {
    const Face& own = surface.face[index(face)];
    const int node = own.node[index(closest.index)];
    bool above_some = false;
    bool below_some = false;
    const auto weigh = [&](int f) {
      const Face& around = surface.face[index(f)];
      if (around.shell) return;
      const FaceVertices v = vertices(nodes, around);
      const bool triangle = is_triangle(v);
      for (int k = 0; k < (triangle ? 1 : 4); ++k) {
        const bool touches =
            triangle || around.node[index(k)] == node || around.node[index((k + 1) % 4)] == node;
        if (!touches) continue;
        (dot(sub_triangle_area(v, k), closest.separation) < 0 ? below_some : above_some) = true;
      }
    };
    const int slave = surface.slave(node);
    if (surface.pinched[index(slave)] != 0) {
      for_fan(surface, slave, face, weigh);
    } else {
      for (int f : surface.faces_of.of(slave)) weigh(f);
    }
    if (above_some != below_some) return above_some;
  }
  return dot(closest.separation, pseudo_normal(surface, nodes, face, closest)) >= 0;
}

double shortest_edge(const Nodes& nodes, const Face& face) {
  double shortest = infinity;
  for (int k = 0; k < face.corners(); ++k) {
    const Vector3d edge =
        position(nodes, face.node[index((k + 1) % face.corners())]) - position(nodes, face.node[index(k)]);
    shortest = std::min(shortest, norm(edge));
  }
  return shortest;
}

}  // namespace brio
