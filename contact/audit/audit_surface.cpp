#include "contact/audit/audit_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "src/base/index.hpp"

namespace brio {

namespace {

/// Of the largest coordinate: positions are sums of many steps, each rounded.
constexpr double rounding_ratio = 64 * std::numeric_limits<double>::epsilon();
/// Cosine of 20 degrees.
constexpr double cosine_of_continuing = 0.93969262078590843;

int root_of(std::vector<int>& parent, int number) {
  const auto up = [&](int i) -> int& { return parent[index(i)]; };
  while (up(number) != number) number = up(number) = up(up(number));
  return number;
}

void join(std::vector<int>& parent, int a, int b) {
  a = root_of(parent, a);
  b = root_of(parent, b);
  parent[index(std::max(a, b))] = std::min(a, b);
}

Vector3d unit_normal(const AuditedFace& face) {
  return normalized(cross(face.x[2] - face.x[0], face.x[3] - face.x[1]));
}

}  // namespace

AuditedSurface::AuditedSurface(const Surface& the_surface, const Nodes& the_nodes)
    : surface(the_surface), nodes(the_nodes) {
  find_pieces();
  collect_faces();
  find_continuation();
  double largest = 0;
  for (int node : surface.node)
    if (node >= 0) largest = std::max(largest, maximum_norm(position(node)));
  tolerance = rounding_ratio * largest;
}

void AuditedSurface::find_pieces() {
  std::vector<int> parent(surface.slaves());
  std::iota(parent.begin(), parent.end(), 0);
  // Sides around a cavity that deletions have left belong to the solid.
  std::vector<int> first_of_body(index(surface.body_count), -1);
  for (const Face& f : surface.face) {
    if (!f.alive()) continue;
    const int slave = surface.slave(f.node[0]);
    for (std::size_t k = 1; k < 4; ++k) join(parent, slave, surface.slave(f.node[k]));
    if (f.shell) continue;
    int& first = first_of_body[index(f.body)];
    if (first < 0) first = slave;
    join(parent, first, slave);
  }
  for (const RoundElement& round : surface.round)
    if (round.alive() && !round.is_point())
      join(parent, surface.slave(round.node[0]), surface.slave(round.node[1]));
  piece.resize(parent.size());
  for (std::size_t s = 0; s < parent.size(); ++s) {
    const int root = root_of(parent, static_cast<int>(s));
    piece[s] = root == static_cast<int>(s) ? pieces++ : piece[index(root)];
  }
}

void AuditedSurface::collect_faces() {
  std::vector<int> alive;
  std::vector<BoundingBox> box;
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    if (!surface.face[f].alive()) continue;
    alive.push_back(static_cast<int>(f));
    BoundingBox& bounds = box.emplace_back();
    for (int node : surface.face[f].node) bounds.add(position(node));
  }
  std::vector<BoundingBox> sorted(box.size());
  face.reserve(box.size());
  for (int i : morton_order(box)) {
    sorted[face.size()] = box[index(i)];
    add_face(alive[index(i)]);
  }
  tree = BoxTree(std::move(sorted));
}

void AuditedSurface::add_face(int number) {
  const Face& known = surface.face[index(number)];
  AuditedFace& own = face.emplace_back();
  own.node = known.node;
  own.shell = known.shell;
  own.corners = known.corners();
  own.face = number;
  own.piece = piece_of_node(known.node[0]);
  own.rigid = surface.rigid_body_of_all(known.node);
  for (std::size_t k = 0; k < 4; ++k) own.x[k] = position(known.node[k]);
  const auto corners = index(own.corners);
  double shortest = HUGE_VAL;
  for (std::size_t k = 0; k < corners; ++k)
    shortest = std::min(shortest, squared_norm(own.x[(k + 1) % corners] - own.x[k]));
  own.shortest_edge = std::sqrt(shortest);
  (known.shell ? has_shells : has_solids) = true;
}

void AuditedSurface::find_continuation() {
  std::vector<Vector3d> normal(surface.face.size(), Vector3d{});
  std::vector<std::uint8_t> ends_at(
      surface.slaves());  // of each slave node: 1 where a sharp or free edge ends
  for (const AuditedFace& f : face) normal[index(f.face)] = unit_normal(f);
  const auto slave = [&](int node) { return index(surface.slave(node)); };
  for (AuditedFace& f : face)
    for (std::size_t k = 0; k < index(f.corners); ++k) {
      const auto own = index(f.face);
      const int across = surface.neighbor[own][k];
      f.edge_continues[k] = across >= 0 && dot(normal[own], normal[index(across)]) > cosine_of_continuing;
      if (!f.edge_continues[k])
        ends_at[slave(f.node[k])] = ends_at[slave(f.node[(k + 1) % index(f.corners)])] = 1;
    }
  for (AuditedFace& f : face)
    for (std::size_t k = 0; k < 4; ++k) f.corner_continues[k] = ends_at[slave(f.node[k])] == 0;
}

}  // namespace brio
