#include "contact/surface/surface.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "contact/surface/element_sides.hpp"
#include "src/base/disjoint_sets.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

// Sides that occur once. Sides are put into the bucket of their smallest node, where only a few meet.
std::vector<Face> exterior(const std::vector<Face>& sides, std::size_t node_count) {
  std::vector<int> first(node_count + 1, 0);
  std::vector<std::array<int, 4>> key(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    key[i] = side_key(sides[i].node);
    ++first[index(key[i][0]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::size_t> bucket(sides.size());
  std::vector<int> fill(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < sides.size(); ++i) bucket[index(fill[index(key[i][0])]++)] = i;
  std::vector<Face> open;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto node = index(key[i][0]);
    int shared = 0;
    for (int k = first[node]; k < first[node + 1]; ++k) shared += key[bucket[index(k)]] == key[i];
    if (shared == 1) open.push_back(sides[i]);
  }
  return open;
}

void check(const SurfacePart& part, std::size_t node_count) {
  const auto per_element = index(part.nodes_per_element);
  const bool known = per_element == 8 || per_element == 4 || per_element == 2 || per_element == 1;
  if (!known || part.connectivity.size() % per_element != 0)
    throw std::invalid_argument("contact: part '" + part.name + "' has elements of a shape without surface");
  for (int node : part.connectivity)
    if (node < 0 || index(node) >= node_count)
      throw std::invalid_argument("contact: part '" + part.name + "' names node " + std::to_string(node) +
                                  ", which does not exist");
  if (per_element != 8 && part.thickness.size() != part.connectivity.size() / per_element)
    throw std::invalid_argument("contact: the elements of part '" + part.name + "' need one " +
                                (part.shell() ? "thickness" : "diameter") + " each");
}

void collect_faces(std::span<const SurfacePart> parts, std::size_t node_count, Surface& surface) {
  std::vector<Face> sides;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const SurfacePart& part = parts[p];
    if (!part.solid()) continue;
    for (std::size_t e = 0; e < part.connectivity.size() / 8; ++e)
      for (int side = 0; side < sides_of_hexahedron; ++side) {
        Face face{.node = {},
                  .part = static_cast<int>(p),
                  .element = static_cast<int>(e),
                  .side = static_cast<std::uint8_t>(side)};
        if (side_nodes(part.connectivity.data() + 8 * e, side, face.node)) sides.push_back(face);
      }
  }
  surface.face = exterior(sides, node_count);
  surface.thickness.assign(surface.face.size(), 0.0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const SurfacePart& part = parts[p];
    if (!part.shell()) continue;
    for (std::size_t e = 0; e < part.connectivity.size() / 4; ++e) {
      Face face{
          .node = {}, .part = static_cast<int>(p), .element = static_cast<int>(e), .body = 0, .shell = true};
      const int* node = part.connectivity.data() + 4 * e;
      if (!distinct_nodes({node[0], node[1], node[2], node[3]}, face.node)) continue;
      surface.face.push_back(face);
      surface.thickness.push_back(part.thickness[e]);
    }
  }
}

void collect_round_elements(std::span<const SurfacePart> parts, Surface& surface) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const SurfacePart& part = parts[p];
    if (!part.round()) continue;
    const auto per_element = index(part.nodes_per_element);
    for (std::size_t e = 0; e < part.thickness.size(); ++e) {
      const int* node = part.connectivity.data() + per_element * e;
      surface.round.push_back({.node = {node[0], node[per_element - 1]},
                               .part = static_cast<int>(p),
                               .radius = 0.5 * part.thickness[e]});
    }
  }
}

// Elements that are connected through nodes are one body; so are the particles of a part.
void number_bodies(std::span<const SurfacePart> parts, std::size_t node_count, Surface& surface) {
  DisjointSets bodies(node_count);
  for (const SurfacePart& part : parts) {
    const auto per_element = index(part.nodes_per_element);
    for (std::size_t i = 0; i < part.connectivity.size(); ++i)
      bodies.join(part.connectivity[per_element == 1 ? 0 : i / per_element * per_element],
                  part.connectivity[i]);
  }
  std::vector<int> number(node_count, -1);
  surface.body_count = 0;
  const auto number_of = [&](int node) {
    int& body = number[index(bodies.root(node))];
    if (body < 0) body = surface.body_count++;
    return body;
  };
  for (Face& face : surface.face) face.body = number_of(face.node[0]);
  for (RoundElement& element : surface.round) element.body = number_of(element.node[0]);
}

void collect_slaves(std::size_t node_count, Surface& surface) {
  surface.slave_of.assign(node_count, -1);
  for (const Face& face : surface.face)
    for (int node : face.node) surface.slave_of[index(node)] = 0;
  for (const RoundElement& element : surface.round)
    for (int node : element.node) surface.slave_of[index(node)] = 0;
  surface.node.clear();
  for (std::size_t n = 0; n < node_count; ++n) {
    if (surface.slave_of[n] < 0) continue;
    surface.slave_of[n] = static_cast<int>(surface.node.size());
    surface.node.push_back(static_cast<int>(n));
  }
  const std::size_t slaves = surface.slaves();
  surface.faces_of.start_packed(slaves);
  for (const Face& face : surface.face)
    for (int k = 0; k < face.corners(); ++k)
      ++surface.faces_of.first[index(surface.slave(face.node[index(k)])) + 1];
  auto& first = surface.faces_of.first;
  std::partial_sum(first.begin(), first.end(), first.begin());
  surface.faces_of.item.resize(index(first.back()));
  std::vector<int> fill(first.begin(), first.end() - 1);
  surface.body.assign(slaves, 0);
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    const Face& face = surface.face[f];
    for (int k = 0; k < face.corners(); ++k) {
      const auto slave = index(surface.slave(face.node[index(k)]));
      surface.faces_of.item[index(fill[slave]++)] = static_cast<int>(f);
      surface.body[slave] = face.body;
    }
  }
}

void settle_round_elements(Surface& surface) {
  if (surface.round.empty()) return;
  surface.round_radius.assign(surface.slaves(), 0);
  surface.rounds.assign(surface.slaves(), 0);
  for (const RoundElement& element : surface.round)
    for (int k = 0; k < (element.is_point() ? 1 : 2); ++k) {
      const auto slave = index(surface.slave(element.node[index(k)]));
      surface.body[slave] = element.body;
      surface.round_radius[slave] = std::max(surface.round_radius[slave], element.radius);
      ++surface.rounds[slave];
    }
}

// Only where a part is rigid.
void find_rigid(std::span<const SurfacePart> parts, std::size_t node_count, Surface& surface) {
  for (const SurfacePart& part : parts) {
    if (part.rigid < 0) continue;
    surface.rigid_of_node.resize(node_count, -1);
    for (int node : part.connectivity) surface.rigid_of_node[index(node)] = part.rigid;
  }
}

// The face across the edge from a to b: one that runs it the other way; for shells, whose normals need not
// agree, else one that runs it the same way. Where several do, one of the same element, which bounds the same
// piece of solid, else the first by part, element, side.
int face_across(const Surface& surface, int self, int a, int b) {
  const Face& own = surface.face[index(self)];
  const auto rank = [&](const Face& face, bool same_way) {
    const bool other_element = face.part != own.part || face.element != own.element;
    return std::tuple(same_way, other_element, face.part, face.element, face.side);
  };
  int across = -1;
  bool across_same_way = false;
  for (int other : surface.faces_of.of(surface.slave(a))) {
    const Face& face = surface.face[index(other)];
    if (other == self || face.shell != own.shell) continue;
    for (int k = 0; k < face.corners(); ++k) {
      const int from = face.node[index(k)];
      const int to = face.node[index((k + 1) % face.corners())];
      const bool same_way = from == a && to == b;
      if (!(from == b && to == a) && !(same_way && own.shell)) continue;
      if (across >= 0 && rank(surface.face[index(across)], across_same_way) <= rank(face, same_way)) continue;
      across = other;
      across_same_way = same_way;
    }
  }
  return across;
}

}  // namespace

void connect(Surface& surface, int face) {
  const Face& own = surface.face[index(face)];
  std::array<int, 4>& neighbor = surface.neighbor[index(face)];
  neighbor = {-1, -1, -1, -1};
  for (int k = 0; k < own.corners(); ++k)
    neighbor[index(k)] =
        face_across(surface, face, own.node[index(k)], own.node[index((k + 1) % own.corners())]);
}

void update_slave(Surface& surface, int slave) {
  const auto s = index(slave);
  if (surface.faces_of.of(slave).empty()) return;  // debris keeps its radius
  double sum = 0;
  int shells = 0;
  int sides = 0;
  for (int f : surface.faces_of.of(slave)) {
    if (surface.face[index(f)].shell) {
      sum += surface.thickness[index(f)];
      ++shells;
    } else {
      ++sides;
    }
  }
  surface.radius[s] = shells > 0 ? 0.5 * sum / shells : 0;
  surface.of_solid[s] = sides > 0 ? 1 : 0;
  surface.pinched[s] = 0;
  for (int f : surface.faces_of.of(slave)) {
    if (surface.face[index(f)].shell) continue;
    int of_fan = 0;
    for_fan(surface, slave, f, [&](int) { ++of_fan; });
    if (of_fan < sides) surface.pinched[s] = 1;
  }
}

Surface make_surface(std::span<const SurfacePart> parts, std::size_t node_count) {
  Surface surface;
  for (const SurfacePart& part : parts) {
    check(part, node_count);
    surface.part_name.push_back(part.name);
  }
  collect_faces(parts, node_count, surface);
  collect_round_elements(parts, surface);
  number_bodies(parts, node_count, surface);
  collect_slaves(node_count, surface);
  settle_round_elements(surface);
  find_rigid(parts, node_count, surface);
  surface.neighbor.resize(surface.face.size());
  for (std::size_t f = 0; f < surface.face.size(); ++f) connect(surface, static_cast<int>(f));
  surface.radius.resize(surface.slaves());
  surface.of_solid.resize(surface.slaves());
  surface.pinched.resize(surface.slaves());
  for (std::size_t s = 0; s < surface.slaves(); ++s) update_slave(surface, static_cast<int>(s));
  return surface;
}

}  // namespace brio
