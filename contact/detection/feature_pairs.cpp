#include "contact/detection/feature_pairs.hpp"

#include <algorithm>

#include "contact/exclusion.hpp"

namespace brio {

namespace {

/// Steps of the present motion that boxes hold.
constexpr double steps_ahead = 10;
/// Of ContactOptions::reach_buffer: both features of a pair have a box that is larger on both sides.
constexpr double share_of_buffer = 0.25;

CaptureBox joined(const CaptureBox& a, const CaptureBox& b) {
  CaptureBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
    box.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
  }
  return box;
}

CaptureBox grown(CaptureBox box, double by) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] -= by;
    box.upper[axis] += by;
  }
  return box;
}

bool share_node(const EdgeFeature& a, const EdgeFeature& b) {
  return a.node[0] == b.node[0] || a.node[0] == b.node[1] || a.node[1] == b.node[0] || a.node[1] == b.node[1];
}

bool kinds_meet(const EdgeFeature& a, const EdgeFeature& b) {
  const auto with_node = [](const EdgeFeature& node, const EdgeFeature& other) {
    return node.kind != EdgeKind::node || other.kind == EdgeKind::beam;
  };
  const auto with_particle = [](const EdgeFeature& particle, const EdgeFeature& other) {
    return particle.kind != EdgeKind::particle || other.kind == EdgeKind::beam ||
           (other.kind == EdgeKind::particle && other.body != particle.body);
  };
  return with_node(a, b) && with_node(b, a) && with_particle(a, b) && with_particle(b, a);
}

bool on_one_face(const EdgeFeature& a, const EdgeFeature& b) {
  for (int f : a.face)
    for (int g : b.face)
      if (f >= 0 && f == g) return true;
  return false;
}

// Whether edges may meet at all: parts, rigid bodies, ties.
bool may_meet(const Surface& surface, const EdgeFeature& a, const EdgeFeature& b) {
  const int node_a = surface.node[static_cast<std::size_t>(a.node[0])];
  const int node_b = surface.node[static_cast<std::size_t>(b.node[0])];
  const int rigid = surface.rigid_body(node_a);
  if (rigid >= 0 && rigid == surface.rigid_body(node_b)) return false;
  if (surface.pairs.parts_apart(a.part, b.part)) return false;
  if (surface.held.empty()) return true;
  const auto tied = [&](const EdgeFeature& edge, const EdgeFeature& other) {
    return std::any_of(edge.node.begin(), edge.node.end(), [&](int slave) {
      return surface.held.apart(surface.node[static_cast<std::size_t>(slave)], other.part);
    });
  };
  return !tied(a, b) && !tied(b, a);
}

// Edges of one piece: a node of one is not held apart from a face of the other.
bool one_piece(const Surface& surface, const Lists& excluded, const EdgeFeature& a, const EdgeFeature& b) {
  const auto excludes = [&](const EdgeFeature& edge, const EdgeFeature& other) {
    for (int node : edge.node)
      for (int f : other.face)
        if (f >= 0 && is_excluded(excluded, node, f)) return true;
    return false;
  };
  if (!surface.held.one_piece(a.body, b.body)) return false;
  if (!a.of_face() && !b.of_face()) return a.body == b.body;  // beams that were drawn together
  return excludes(a, b) || excludes(b, a);
}

}  // namespace

void PairList::clear() {
  first.clear();
  second.clear();
  for (auto& axis : direction) axis.clear();
  wake.clear();
  spaced.clear();
}

void PairList::add(int a, int b, bool keep_distance) {
  first.push_back(a);
  second.push_back(b);
  for (auto& axis : direction) axis.push_back(0);
  wake.push_back(-1);
  spaced.push_back(keep_distance ? 1 : 0);
}

bool FeaturePairs::is_due(const Surface& surface, const FeatureMotion& motion) const {
  if (box_.size() != surface.slaves()) return true;
  const double* since = motion.frame_since_restart();
  const double* frame = motion.frame();
  double moved[3];
  for (int axis = 0; axis < 3; ++axis) moved[axis] = since[axis] + frame[axis];
  for (std::size_t s = 0; s < box_.size(); ++s) {
    if (surface.node[s] < 0) continue;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = motion.node[s].end[axis] - moved[axis];
      inside = inside && x >= box_[s].lower[axis] && x <= box_[s].upper[axis];
    }
    if (!inside) return true;
  }
  return false;
}

void FeaturePairs::find(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                        const ContactOptions& options, FeatureMotion& motion, ThreadTeam& team) {
  motion.restart(features, surface);
  const double margin = share_of_buffer * options.reach_buffer * features.mean_edge;
  box_.assign(surface.slaves(), empty_box);
  for (std::size_t s = 0; s < box_.size(); ++s) {
    if (surface.node[s] < 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = motion.node[s].start[axis];
      const double ahead = steps_ahead * (motion.node[s].end[axis] - x - motion.frame()[axis]);
      box_[s].lower[axis] = x + std::min(ahead, 0.0) - margin;
      box_[s].upper[axis] = x + std::max(ahead, 0.0) + margin;
    }
  }
  find_node_face(features, surface, excluded, team);
  find_edge_edge(features, surface, excluded, team);
}

CaptureBox FeaturePairs::box_of(const Surface& surface, const Face& face) const {
  CaptureBox box = empty_box;
  for (int corner : face.node) box = joined(box, box_[static_cast<std::size_t>(surface.slave(corner))]);
  return box;
}

CaptureBox FeaturePairs::box_of(const EdgeFeature& edge) const {
  return joined(box_[static_cast<std::size_t>(edge.node[0])], box_[static_cast<std::size_t>(edge.node[1])]);
}

void FeaturePairs::find_node_face(const SurfaceFeatures& features, const Surface& surface,
                                  const Lists& excluded, ThreadTeam& team) {
  const double band = 0.5 * proximity_band * features.smallest_edge;
  first_box_.assign(surface.slaves(), empty_box);
  for (std::size_t s = 0; s < surface.slaves(); ++s)
    if (surface.node[s] >= 0) first_box_[s] = grown(box_[s], features.node_radius[s] + band);
  second_box_.assign(surface.face.size(), empty_box);
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    if (!surface.face[f].alive()) continue;
    second_box_[f] = grown(box_of(surface, surface.face[f]), features.face_radius[f] + band);
  }
  search_.find(SearchNodes(first_box_), second_box_, team, found_, counts);
  node_face.clear();
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    const Face& face = surface.face[f];
    if (!face.alive()) continue;
    const CaptureBox near_face = grown(box_of(surface, face), 2 * features.skin + 2 * band);
    for (int s : found_.of_box(f)) {
      if (face.has(surface.node[static_cast<std::size_t>(s)]) || surface.never_touch(s, face)) continue;
      const bool spaced = !is_excluded(excluded, s, static_cast<int>(f));
      if (!spaced && !near_face.overlaps(box_[static_cast<std::size_t>(s)])) continue;
      node_face.add(s, static_cast<int>(f), spaced);
    }
  }
}

void FeaturePairs::find_edge_edge(const SurfaceFeatures& features, const Surface& surface,
                                  const Lists& excluded, ThreadTeam& team) {
  const double band = 0.5 * proximity_band * features.smallest_edge;
  first_box_.resize(features.edge.size());
  for (std::size_t e = 0; e < features.edge.size(); ++e) {
    const EdgeFeature& edge = features.edge[e];
    first_box_[e] = grown(box_of(edge), edge.radius + band);
  }
  search_.find(SearchNodes(first_box_), first_box_, team, found_, counts);
  edge_edge.clear();
  for (std::size_t e = 0; e < features.edge.size(); ++e) {
    const EdgeFeature& a = features.edge[e];
    for (int other : found_.of_box(e)) {
      if (other <= static_cast<int>(e)) continue;
      const EdgeFeature& b = features.edge[static_cast<std::size_t>(other)];
      if (share_node(a, b) || !kinds_meet(a, b) || on_one_face(a, b) || !may_meet(surface, a, b)) continue;
      const bool spaced = !one_piece(surface, excluded, a, b);
      if (!spaced && (a.kind == EdgeKind::cross_diagonal || b.kind == EdgeKind::cross_diagonal)) continue;
      if (!spaced && !grown(box_of(a), 2 * features.skin + 2 * band).overlaps(box_of(b))) continue;
      edge_edge.add(static_cast<int>(e), other, spaced);
    }
  }
}

}  // namespace brio
