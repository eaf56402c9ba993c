#include "contact/features/features.hpp"

#include <algorithm>
#include <tuple>

#include "contact/surface/face_geometry.hpp"
#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

bool joins(EdgeKind kind) { return kind == EdgeKind::side || kind == EdgeKind::beam; }

/// Puts features in and takes them out.
class Collector {
 public:
  Collector(SurfaceFeatures& features, const Surface& surface, const ContactOptions& options)
      : features_(features), surface_(surface), options_(options) {}

  void start() {
    features_.edge.clear();
    features_.edge_node.clear();
    features_.edge_radius.clear();
    features_.edge_of_face.clear();
    features_.diagonal_of_face.clear();
    features_.edge_of_round.clear();
    features_.point_of_node.clear();
    features_.retired.clear();
    features_.free.clear();
    features_.all_of_faces = surface_.round.empty();
    has_beams_ = std::any_of(surface_.round.begin(), surface_.round.end(),
                             [](const RoundElement& round) { return round.alive() && !round.is_point(); });
    if (has_beams_) features_.point_of_node.assign(surface_.slaves(), -1);
    resize();
  }
  void go_on() {
    has_beams_ = !features_.point_of_node.empty();
    features_.free.insert(features_.free.end(), features_.retired.begin(), features_.retired.end());
    features_.retired.clear();
    if (has_beams_) features_.point_of_node.resize(surface_.slaves(), -1);
    resize();
  }

  void set_node_radius(int slave) {
    const auto s = index(slave);
    features_.node_radius[s] = std::max({options_.shell_thickness_scale * surface_.radius[s],
                                         surface_.radius_of_rounds(slave), features_.skin});
  }

  void add_face(int f) {
    const Face& face = surface_.face[index(f)];
    at(features_.face_radius, f) =
        std::max(0.5 * options_.shell_thickness_scale * surface_.thickness[index(f)], features_.skin);
    std::array<int, 4>& corner = at(features_.face_node, f);
    for (std::size_t k = 0; k < 4; ++k) corner[k] = surface_.slave(face.node[k]);
    const auto corners = index(face.corners());
    for (std::size_t k = 0; k < corners; ++k) {
      const int a = corner[k], b = corner[(k + 1) % corners];
      if (a == b) continue;
      int e = side_between(a, b);
      if (e < 0) e = new_edge(EdgeKind::side, std::min(a, b), std::max(a, b));
      at(features_.edge_of_face, f)[k] = e;
      touched_.push_back(e);
    }
    for (std::size_t k = 0; corners == 4 && k < 2; ++k)
      if (corner[k] != corner[k + 2]) add_diagonal(f, k);
  }

  void drop_face(int f) {
    for (int& e : at(features_.edge_of_face, f)) {
      if (e >= 0) touched_.push_back(e);
      e = -1;
    }
    for (int& e : at(features_.diagonal_of_face, f)) {
      if (e >= 0) end(e);
      e = -1;
    }
    at(features_.face_node, f) = {};
  }

  void add_round(int r) {
    const RoundElement& round = surface_.round[index(r)];
    const int a = surface_.slave(round.node[0]), b = surface_.slave(round.node[1]);
    const int e =
        new_edge(round.is_point() ? EdgeKind::particle : EdgeKind::beam, std::min(a, b), std::max(a, b));
    EdgeFeature& edge = at(features_.edge, e);
    edge.part = round.part;
    edge.body = round.body;
    edge.round = r;
    set_radius(e, std::max(round.radius, features_.skin));
    at(features_.edge_of_round, r) = e;
  }
  void drop_round(int r) {
    int& e = at(features_.edge_of_round, r);
    if (e >= 0) end(e);
    e = -1;
  }

  // Where there are beams, which may meet a node of a face with no node of their own near.
  void set_point(int slave) {
    if (!has_beams_) return;
    int& e = at(features_.point_of_node, slave);
    const bool wanted = surface_.node[index(slave)] >= 0 && !surface_.faces_of.of(slave).empty();
    if (e >= 0 && !wanted) end(e);
    if (!wanted) {
      e = -1;
      return;
    }
    if (e < 0) e = new_edge(EdgeKind::node, slave, slave);
    be_of(at(features_.edge, e), surface_.faces_of.of(slave).front());
    at(features_.edge, e).faces = 1;
    set_radius(e, at(features_.node_radius, slave));
  }

  // Sides of faces that came or went. \returns all edges that changed, ascending
  std::vector<int>& settle() {
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    for (int e : touched_)
      if (at(features_.edge, e).kind == EdgeKind::side) settle_side(e);
    if (keeps_rings_)
      for (int e : touched_)  // a side that has followed another
        if (at(features_.edge, e).kind == EdgeKind::side) join_rings(e);
    changed_.insert(changed_.end(), touched_.begin(), touched_.end());
    std::sort(changed_.begin(), changed_.end());
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    return changed_;
  }

  void keep_rings() { keeps_rings_ = true; }

 private:
  void resize() {
    features_.edge_of_face.resize(surface_.face.size(), {-1, -1, -1, -1});
    features_.diagonal_of_face.resize(surface_.face.size(), {-1, -1});
    features_.edge_of_round.resize(surface_.round.size(), -1);
    features_.face_node.resize(surface_.face.size());
    features_.face_radius.resize(surface_.face.size());
    features_.node_radius.resize(surface_.slaves());
  }

  void set_radius(int e, double radius) {
    at(features_.edge, e).radius = radius;
    at(features_.edge_radius, e) = radius;
  }

  int new_edge(EdgeKind kind, int a, int b) {
    int e = static_cast<int>(features_.edge.size());
    if (features_.free.empty()) {
      features_.edge.emplace_back();
      features_.edge_node.emplace_back();
      features_.edge_radius.push_back(0);
    } else {
      e = features_.free.back();
      features_.free.pop_back();
    }
    EdgeFeature& edge = at(features_.edge, e);
    edge = {};
    edge.node = at(features_.edge_node, e) = {a, b};
    edge.kind = kind;
    changed_.push_back(e);
    if (keeps_rings_ && joins(kind)) join_rings(e);
    return e;
  }

  void join_rings(int e) {
    const auto [a, b] = at(features_.edge_node, e);
    features_.ring.insert(a, b);
    features_.ring.insert(b, a);
  }

  void end(int e) {
    EdgeFeature& edge = at(features_.edge, e);
    const auto [a, b] = edge.node;
    if (keeps_rings_ && joins(edge.kind)) {
      features_.ring.erase(a, b);
      features_.ring.erase(b, a);
    }
    edge = {};
    edge.kind = EdgeKind::none;
    at(features_.edge_node, e) = {};
    set_radius(e, 0);
    features_.retired.push_back(e);
    changed_.push_back(e);
  }

  // Place of the side between two slave nodes among those of a face; -1: it has none.
  int place_of_side(int f, int a, int b) const {
    const Face& face = surface_.face[index(f)];
    for (int k = 0; k < face.corners(); ++k) {
      const int from = surface_.slave(face.node[index(k)]);
      const int to = surface_.slave(face.node[index((k + 1) % face.corners())]);
      if ((from == a && to == b) || (from == b && to == a)) return k;
    }
    return -1;
  }

  // The side that another face knows; -1: none does.
  int side_between(int a, int b) {
    for (int f : surface_.faces_of.of(a))
      if (const int k = place_of_side(f, a, b); k >= 0)
        if (const int e = at(features_.edge_of_face, f)[index(k)]; e >= 0) return e;
    return -1;
  }

  void be_of(EdgeFeature& edge, int f) const {
    const Face& face = surface_.face[index(f)];
    edge.face = {f, -1};
    edge.part = face.part;
    edge.body = face.body;
    edge.shell = face.shell;
  }

  void add_diagonal(int f, std::size_t k) {
    const std::array<int, 4>& corner = at(features_.face_node, f);
    const int e = new_edge(k == 0 ? EdgeKind::diagonal : EdgeKind::cross_diagonal,
                           std::min(corner[k], corner[k + 2]), std::max(corner[k], corner[k + 2]));
    at(features_.diagonal_of_face, f)[k] = e;
    be_of(at(features_.edge, e), f);
    at(features_.edge, e).faces = 1;
    set_radius(e, at(features_.face_radius, f));
    set_wings(at(features_.edge, e));
  }

  void settle_side(int e) {
    EdgeFeature& edge = at(features_.edge, e);
    const auto [a, b] = edge.node;
    edge.faces = 0;
    double radius = 0;
    bool shell = false;
    for (int f : surface_.faces_of.of(a)) {
      const int place = place_of_side(f, a, b);
      // Another side has followed this one where all of its faces went and others came.
      if (place < 0 || at(features_.edge_of_face, f)[index(place)] != e) continue;
      if (edge.faces == 0) be_of(edge, f);
      if (edge.faces == 1) edge.face[1] = f;
      if (edge.faces < 255) ++edge.faces;
      radius = std::max(radius, at(features_.face_radius, f));
      shell = shell || surface_.face[index(f)].shell;
    }
    if (edge.faces == 0) {
      end(e);
      return;
    }
    edge.shell = shell;
    set_radius(e, radius);
    set_wings(edge);
  }

  // The corners of the edge's first two faces that are not its own.
  void set_wings(EdgeFeature& edge) const {
    edge.wing = {-1, -1, -1, -1};
    std::size_t count = 0;
    for (int f : edge.face) {
      if (f < 0) continue;
      const Face& face = surface_.face[index(f)];
      for (int k = 0; k < face.corners(); ++k) {
        const int corner = surface_.slave(face.node[index(k)]);
        if (corner != edge.node[0] && corner != edge.node[1] && count < edge.wing.size())
          edge.wing[count++] = corner;
      }
    }
  }

  SurfaceFeatures& features_;
  const Surface& surface_;
  const ContactOptions& options_;
  bool has_beams_ = false, keeps_rings_ = false;
  std::vector<int> touched_, changed_;
};

void collect_rings(SurfaceFeatures& features, const Surface& surface) {
  Lists& ring = features.ring;
  ring.start_packed(surface.slaves());
  for (const EdgeFeature& edge : features.edge)
    if (joins(edge.kind))
      for (int node : edge.node) ++ring.first[index(node) + 1];
  for (std::size_t s = 0; s < surface.slaves(); ++s) ring.first[s + 1] += ring.first[s];
  ring.item.resize(index(ring.first.back()));
  std::vector<int> fill(ring.first.begin(), ring.first.end() - 1);
  for (const EdgeFeature& edge : features.edge)
    if (joins(edge.kind))
      for (std::size_t k = 0; k < 2; ++k) at(ring.item, at(fill, edge.node[k])++) = edge.node[1 - k];
  for (std::size_t s = 0; s < surface.slaves(); ++s)
    std::sort(ring.item.begin() + ring.first[s], ring.item.begin() + ring.first[s + 1]);
}

// Where a beam runs along a side, one of both may have gone.
void mend_rings_at_beams(SurfaceFeatures& features) {
  for (int e : features.edge_of_round) {
    if (e < 0 || at(features.edge, e).is_point()) continue;
    const auto [a, b] = at(features.edge, e).node;
    features.ring.insert(a, b);
    features.ring.insert(b, a);
  }
}

// Pieces of a body are bodies.
void follow_split(SurfaceFeatures& features, const Surface& surface) {
  for (EdgeFeature& edge : features.edge)
    if (edge.face[0] >= 0)
      edge.body = surface.face[index(edge.face[0])].body;
    else if (edge.round >= 0)
      edge.body = surface.round[index(edge.round)].body;
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
  features.drawn_beam.clear();
  for (const RoundElement& round : surface.round) {
    features.drawn_beam.push_back({position(nodes, round.node[0]), position(nodes, round.node[1])});
    if (!round.alive()) continue;
    add(round.is_point() ? 2 * round.radius
                         : norm(position(nodes, round.node[1]) - position(nodes, round.node[0])));
  }
  features.smallest_edge = count == 0 ? 0 : smallest;
  features.mean_edge = count == 0 ? 0 : sum / static_cast<double>(count);
  features.skin = skin_share * features.smallest_edge;
}

void collect(SurfaceFeatures& features, const Surface& surface, const ContactOptions& options) {
  Collector collector(features, surface, options);
  collector.start();
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s) collector.set_node_radius(s);
  for (int f = 0; f < static_cast<int>(surface.face.size()); ++f)
    if (surface.face[index(f)].alive()) collector.add_face(f);
  for (int r = 0; r < static_cast<int>(surface.round.size()); ++r)
    if (surface.round[index(r)].alive()) collector.add_round(r);
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s) collector.set_point(s);
  collector.settle();
  collect_rings(features, surface);
}

void update(SurfaceFeatures& features, const Surface& surface, const ContactOptions& options,
            const SurfaceChange& change, std::vector<int>& changed_edges) {
  features.ring.loosen();
  while (features.ring.first.size() < surface.slaves()) features.ring.add_list();
  Collector collector(features, surface, options);
  collector.go_on();
  collector.keep_rings();
  for (int s : change.changed_slave) collector.set_node_radius(s);
  for (int s : change.dead_slave) collector.set_node_radius(s);
  for (int r : change.dead_round) collector.drop_round(r);
  for (int f : change.dead_face) collector.drop_face(f);
  for (int f : change.new_face)
    if (surface.face[index(f)].alive()) collector.add_face(f);
  for (int s : change.dead_slave) collector.set_point(s);
  for (int s : change.changed_slave) collector.set_point(s);
  changed_edges = collector.settle();
  for (int s : change.dead_slave) features.ring.clear(s);
  mend_rings_at_beams(features);
  if (change.split) follow_split(features, surface);
}

}  // namespace brio
