#include "contact/surface.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace brio {

namespace {

// Sides of a hexahedron in VTK's order, counterclockwise from outside.
constexpr int side_corner[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                   {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

// Repeated nodes removed, the order kept; fewer than three left: the side has collapsed.
bool make_face(std::array<int, 4> corner, Face& face) {
  std::array<int, 4> distinct{};
  std::size_t count = 0;
  for (int node : corner)
    if (std::find(distinct.begin(), distinct.begin() + count, node) == distinct.begin() + count)
      distinct[count++] = node;
  if (count < 3) return false;
  if (count == 3) distinct[3] = distinct[2];
  face.node = distinct;
  return true;
}

std::array<int, 4> sorted_nodes(const Face& face) {
  std::array<int, 4> key = face.node;
  std::sort(key.begin(), key.end());
  return key;
}

// Sides that occur once. Sides are put into the bucket of their smallest node, where only a few meet.
std::vector<Face> exterior(const std::vector<Face>& sides, std::size_t node_count) {
  std::vector<int> first(node_count + 1, 0);
  std::vector<std::array<int, 4>> key(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    key[i] = sorted_nodes(sides[i]);
    ++first[static_cast<std::size_t>(key[i][0]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::size_t> bucket(sides.size());
  std::vector<int> fill(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < sides.size(); ++i)
    bucket[static_cast<std::size_t>(fill[static_cast<std::size_t>(key[i][0])]++)] = i;
  std::vector<Face> open;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto node = static_cast<std::size_t>(key[i][0]);
    int shared = 0;
    for (int k = first[node]; k < first[node + 1]; ++k)
      shared += key[bucket[static_cast<std::size_t>(k)]] == key[i];
    if (shared == 1) open.push_back(sides[i]);
  }
  return open;
}

// Roots of the trees that join nodes into bodies.
class Bodies {
 public:
  explicit Bodies(std::size_t nodes) : parent_(nodes) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int node) {
    while (at(node) != node) node = at(node) = at(at(node));
    return node;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    at(std::max(a, b)) = std::min(a, b);
  }

 private:
  int& at(int node) { return parent_[static_cast<std::size_t>(node)]; }
  std::vector<int> parent_;
};

void check(const SurfacePart& part, std::size_t node_count) {
  const auto per_element = static_cast<std::size_t>(part.nodes_per_element);
  if (per_element != (part.shell ? 4U : 8U) || part.connectivity.size() % per_element != 0)
    throw std::invalid_argument("contact: part '" + part.name + "' has elements of a shape without surface");
  for (int node : part.connectivity)
    if (node < 0 || static_cast<std::size_t>(node) >= node_count)
      throw std::invalid_argument("contact: part '" + part.name + "' names node " + std::to_string(node) +
                                  ", which does not exist");
  if (part.shell && part.thickness.size() != part.connectivity.size() / per_element)
    throw std::invalid_argument("contact: the shells of part '" + part.name + "' need one thickness each");
}

void collect_faces(std::span<const SurfacePart> parts, std::size_t node_count, Surface& surface) {
  std::vector<Face> sides;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const SurfacePart& part = parts[p];
    if (part.shell) continue;
    for (std::size_t e = 0; e < part.connectivity.size() / 8; ++e)
      for (const auto& corner : side_corner) {
        Face face{.node = {}, .part = static_cast<int>(p), .element = static_cast<int>(e)};
        const int* node = part.connectivity.data() + 8 * e;
        if (make_face({node[corner[0]], node[corner[1]], node[corner[2]], node[corner[3]]}, face))
          sides.push_back(face);
      }
  }
  surface.face = exterior(sides, node_count);
  surface.thickness.assign(surface.face.size(), 0.0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const SurfacePart& part = parts[p];
    if (!part.shell) continue;
    for (std::size_t e = 0; e < part.connectivity.size() / 4; ++e) {
      Face face{
          .node = {}, .part = static_cast<int>(p), .element = static_cast<int>(e), .body = 0, .shell = true};
      const int* node = part.connectivity.data() + 4 * e;
      if (!make_face({node[0], node[1], node[2], node[3]}, face)) continue;
      surface.face.push_back(face);
      surface.thickness.push_back(part.thickness[e]);
    }
  }
}

void number_bodies(std::span<const SurfacePart> parts, std::size_t node_count, Surface& surface) {
  Bodies bodies(node_count);
  for (const SurfacePart& part : parts) {
    const auto per_element = static_cast<std::size_t>(part.nodes_per_element);
    for (std::size_t i = 0; i < part.connectivity.size(); ++i)
      bodies.join(part.connectivity[i / per_element * per_element], part.connectivity[i]);
  }
  std::vector<int> number(node_count, -1);
  surface.body_count = 0;
  for (Face& face : surface.face) {
    int& body = number[static_cast<std::size_t>(bodies.root(face.node[0]))];
    if (body < 0) body = surface.body_count++;
    face.body = body;
  }
}

void collect_slaves(std::size_t node_count, Surface& surface) {
  surface.slave_of.assign(node_count, -1);
  for (const Face& face : surface.face)
    for (int node : face.node) surface.slave_of[static_cast<std::size_t>(node)] = 0;
  surface.node.clear();
  for (std::size_t n = 0; n < node_count; ++n) {
    if (surface.slave_of[n] < 0) continue;
    surface.slave_of[n] = static_cast<int>(surface.node.size());
    surface.node.push_back(static_cast<int>(n));
  }
  const std::size_t slaves = surface.slaves();
  surface.faces_of.first.assign(slaves + 1, 0);
  for (const Face& face : surface.face)
    for (int k = 0; k < face.corners(); ++k)
      ++surface.faces_of
            .first[static_cast<std::size_t>(surface.slave(face.node[static_cast<std::size_t>(k)])) + 1];
  auto& first = surface.faces_of.first;
  std::partial_sum(first.begin(), first.end(), first.begin());
  surface.faces_of.item.resize(static_cast<std::size_t>(first.back()));
  std::vector<int> fill(first.begin(), first.end() - 1);
  surface.body.assign(slaves, 0);
  surface.of_solid.assign(slaves, 0);
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    const Face& face = surface.face[f];
    for (int k = 0; k < face.corners(); ++k) {
      const auto slave = static_cast<std::size_t>(surface.slave(face.node[static_cast<std::size_t>(k)]));
      surface.faces_of.item[static_cast<std::size_t>(fill[slave]++)] = static_cast<int>(f);
      surface.body[slave] = face.body;
      if (!face.shell) surface.of_solid[slave] = 1;
    }
  }
}

// The face across the edge from a to b: the first that runs it the other way; for shells, whose normals need
// not agree, else one that runs it the same way.
int face_across(const Surface& surface, int self, int a, int b) {
  int same_way = -1;
  const Face& own = surface.face[static_cast<std::size_t>(self)];
  for (int other : surface.faces_of.of(surface.slave(a))) {
    const Face& face = surface.face[static_cast<std::size_t>(other)];
    if (other == self || face.shell != own.shell) continue;
    for (int k = 0; k < face.corners(); ++k) {
      const int from = face.node[static_cast<std::size_t>(k)];
      const int to = face.node[static_cast<std::size_t>((k + 1) % face.corners())];
      if (from == b && to == a) return other;
      if (from == a && to == b && same_way < 0) same_way = other;
    }
  }
  return own.shell ? same_way : -1;
}

void connect(Surface& surface) {
  surface.neighbor.assign(surface.face.size(), {-1, -1, -1, -1});
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    const Face& face = surface.face[f];
    for (int k = 0; k < face.corners(); ++k)
      surface.neighbor[f][static_cast<std::size_t>(k)] =
          face_across(surface, static_cast<int>(f), face.node[static_cast<std::size_t>(k)],
                      face.node[static_cast<std::size_t>((k + 1) % face.corners())]);
  }
}

void update_radius(Surface& surface) {
  surface.radius.assign(surface.slaves(), 0.0);
  for (std::size_t s = 0; s < surface.slaves(); ++s) {
    double sum = 0;
    int shells = 0;
    for (int f : surface.faces_of.of(static_cast<int>(s))) {
      if (!surface.face[static_cast<std::size_t>(f)].shell) continue;
      sum += surface.thickness[static_cast<std::size_t>(f)];
      ++shells;
    }
    if (shells > 0) surface.radius[s] = 0.5 * sum / shells;
  }
}

}  // namespace

Surface make_surface(std::span<const SurfacePart> parts, std::size_t node_count) {
  Surface surface;
  for (const SurfacePart& part : parts) {
    check(part, node_count);
    surface.part_name.push_back(part.name);
  }
  collect_faces(parts, node_count, surface);
  number_bodies(parts, node_count, surface);
  collect_slaves(node_count, surface);
  connect(surface);
  update_radius(surface);
  return surface;
}

void update_thickness(Surface& surface, int part, std::span<const double> thickness) {
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    const Face& face = surface.face[f];
    if (face.part == part && face.shell)
      surface.thickness[f] = thickness[static_cast<std::size_t>(face.element)];
  }
  update_radius(surface);
}

}  // namespace brio
