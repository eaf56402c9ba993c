#include "contact/detection/features.hpp"

#include <algorithm>
#include <tuple>

#include "contact/candidates.hpp"
#include "contact/face_geometry.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

namespace {

/// One side of a face.
struct HalfEdge {
  int low, high;  ///< slave indices
  int face, corner;
  auto order() const { return std::tie(low, high, face, corner); }
};

void collect_half_edges(const Surface& surface, std::vector<HalfEdge>& halves) {
  for (int f = 0; f < static_cast<int>(surface.face.size()); ++f) {
    const Face& face = surface.face[static_cast<std::size_t>(f)];
    if (!face.alive()) continue;
    for (int k = 0; k < face.corners(); ++k) {
      const int a = surface.slave(face.node[static_cast<std::size_t>(k)]);
      const int b = surface.slave(face.node[static_cast<std::size_t>((k + 1) % face.corners())]);
      if (a != b) halves.push_back({std::min(a, b), std::max(a, b), f, k});
    }
  }
  std::sort(halves.begin(), halves.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return a.order() < b.order(); });
}

EdgeFeature edge_on(const Surface& surface, const SurfaceFeatures& features, int f, int a, int b,
                    EdgeKind kind) {
  const Face& face = surface.face[static_cast<std::size_t>(f)];
  EdgeFeature edge;
  edge.node = {std::min(a, b), std::max(a, b)};
  edge.face[0] = f;
  edge.faces = 1;
  edge.part = face.part;
  edge.body = face.body;
  edge.kind = kind;
  edge.shell = face.shell;
  edge.radius = features.face_radius[static_cast<std::size_t>(f)];
  return edge;
}

// The corners of the edge's first two faces that are not its own.
void set_wings(EdgeFeature& edge, const Surface& surface) {
  std::size_t count = 0;
  for (int f : edge.face) {
    if (f < 0) continue;
    const Face& face = surface.face[static_cast<std::size_t>(f)];
    for (int k = 0; k < face.corners(); ++k) {
      const int corner = surface.slave(face.node[static_cast<std::size_t>(k)]);
      if (corner != edge.node[0] && corner != edge.node[1] && count < edge.wing.size())
        edge.wing[count++] = corner;
    }
  }
}

void add_sides(SurfaceFeatures& features, const Surface& surface) {
  std::vector<HalfEdge> halves;
  collect_half_edges(surface, halves);
  for (std::size_t i = 0; i < halves.size();) {
    EdgeFeature edge =
        edge_on(surface, features, halves[i].face, halves[i].low, halves[i].high, EdgeKind::side);
    const int number = static_cast<int>(features.edge.size());
    std::size_t j = i;
    for (; j < halves.size() && halves[j].low == halves[i].low && halves[j].high == halves[i].high; ++j) {
      const auto f = static_cast<std::size_t>(halves[j].face);
      features.edge_of_face[f][static_cast<std::size_t>(halves[j].corner)] = number;
      edge.radius = std::max(edge.radius, features.face_radius[f]);
      edge.shell = edge.shell || surface.face[f].shell;
      if (j > i && edge.faces < 255) ++edge.faces;
      if (j == i + 1) edge.face[1] = halves[j].face;
    }
    set_wings(edge, surface);
    features.edge.push_back(edge);
    i = j;
  }
}

void add_diagonals(SurfaceFeatures& features, const Surface& surface) {
  for (int f = 0; f < static_cast<int>(surface.face.size()); ++f) {
    const Face& face = surface.face[static_cast<std::size_t>(f)];
    if (!face.alive() || face.corners() < 4) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      const int a = surface.slave(face.node[k]), b = surface.slave(face.node[k + 2]);
      if (a == b) continue;
      EdgeFeature edge =
          edge_on(surface, features, f, a, b, k == 0 ? EdgeKind::diagonal : EdgeKind::cross_diagonal);
      set_wings(edge, surface);
      features.edge.push_back(edge);
    }
  }
}

EdgeFeature round_edge(const Surface& surface, int number) {
  const RoundElement& round = surface.round[static_cast<std::size_t>(number)];
  const int a = surface.slave(round.node[0]), b = surface.slave(round.node[1]);
  EdgeFeature edge;
  edge.node = {std::min(a, b), std::max(a, b)};
  edge.part = round.part;
  edge.body = round.body;
  edge.round = number;
  edge.kind = round.is_point() ? EdgeKind::particle : EdgeKind::beam;
  edge.radius = round.radius;
  return edge;
}

// Beams and particles; and nodes of faces, where they have beams to meet with no node near.
void add_round_elements(SurfaceFeatures& features, const Surface& surface) {
  bool beams = false;
  for (int r = 0; r < static_cast<int>(surface.round.size()); ++r) {
    if (!surface.round[static_cast<std::size_t>(r)].alive()) continue;
    features.edge.push_back(round_edge(surface, r));
    features.edge.back().radius = std::max(features.edge.back().radius, features.skin);
    beams = beams || features.edge.back().kind == EdgeKind::beam;
  }
  if (!beams) return;
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s) {
    if (surface.node[static_cast<std::size_t>(s)] < 0 || surface.faces_of.of(s).empty()) continue;
    const int f = surface.faces_of.of(s).front();
    EdgeFeature point = edge_on(surface, features, f, s, s, EdgeKind::node);
    point.radius = features.node_radius[static_cast<std::size_t>(s)];
    features.edge.push_back(point);
  }
}

void collect_rings(SurfaceFeatures& features, const Surface& surface) {
  const auto joins = [](const EdgeFeature& edge) {
    return edge.kind == EdgeKind::side || edge.kind == EdgeKind::beam;
  };
  Lists& ring = features.ring;
  ring.start_packed(surface.slaves());
  for (const EdgeFeature& edge : features.edge)
    if (joins(edge))
      for (int node : edge.node) ++ring.first[static_cast<std::size_t>(node) + 1];
  for (std::size_t s = 0; s < surface.slaves(); ++s) ring.first[s + 1] += ring.first[s];
  ring.item.resize(static_cast<std::size_t>(ring.first.back()));
  std::vector<int> fill(ring.first.begin(), ring.first.end() - 1);
  for (const EdgeFeature& edge : features.edge)
    if (joins(edge))
      for (std::size_t k = 0; k < 2; ++k)
        ring.item[static_cast<std::size_t>(fill[static_cast<std::size_t>(edge.node[k])]++)] =
            edge.node[1 - k];
}

void set_radii(SurfaceFeatures& features, const Surface& surface, const ContactOptions& options) {
  features.face_radius.resize(surface.face.size());
  for (std::size_t f = 0; f < surface.face.size(); ++f)
    features.face_radius[f] =
        std::max(0.5 * options.shell_thickness_scale * surface.thickness[f], features.skin);
  features.node_radius.resize(surface.slaves());
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s)
    features.node_radius[static_cast<std::size_t>(s)] =
        std::max(reach_of_node(surface, options, s), features.skin);
}

void collect_nodes(SurfaceFeatures& features, const Surface& surface) {
  features.face_node.assign(surface.face.size(), {});
  for (std::size_t f = 0; f < surface.face.size(); ++f)
    for (std::size_t k = 0; k < 4 && surface.face[f].alive(); ++k)
      features.face_node[f][k] = surface.slave(surface.face[f].node[k]);
  features.edge_node.clear();
  for (const EdgeFeature& edge : features.edge) features.edge_node.push_back(edge.node);
}

}  // namespace

void measure(SurfaceFeatures& features, const Surface& surface, const Nodes& nodes) {
  double smallest = infinity, sum = 0;
  std::size_t count = 0;
  const auto add = [&](double length) {
    if (!(length > 0)) return;
    smallest = std::min(smallest, length);
    sum += length;
    ++count;
  };
  for (const Face& face : surface.face)
    if (face.alive()) add(shortest_edge(nodes, face));
  for (const RoundElement& round : surface.round) {
    if (!round.alive()) continue;
    add(round.is_point() ? 2 * round.radius
                         : (position(nodes, round.node[1]) - position(nodes, round.node[0])).norm());
  }
  features.smallest_edge = count == 0 ? 0 : smallest;
  features.mean_edge = count == 0 ? 0 : sum / static_cast<double>(count);
  features.skin = skin_share * features.smallest_edge;
}

void collect(SurfaceFeatures& features, const Surface& surface, const ContactOptions& options) {
  set_radii(features, surface, options);
  features.edge.clear();
  features.edge_of_face.assign(surface.face.size(), {-1, -1, -1, -1});
  add_sides(features, surface);
  add_diagonals(features, surface);
  add_round_elements(features, surface);
  collect_rings(features, surface);
  collect_nodes(features, surface);
}

}  // namespace brio
