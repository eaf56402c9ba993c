#include "contact/pairs/edge_pairs.hpp"

#include <algorithm>
#include <numbers>

#include "contact/geometry/closest_segments.hpp"
#include "contact/surface/exclusion.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

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

// But for opposite sides: a face may collapse until they meet.
bool on_one_face(const EdgeFeature& a, const EdgeFeature& b) {
  if (!a.is_diagonal() && !b.is_diagonal()) return false;
  for (int f : a.face)
    for (int g : b.face)
      if (f >= 0 && f == g) return true;
  return false;
}

// Whether edges may meet at all: parts, rigid bodies, ties.
bool may_meet(const Surface& surface, const EdgeFeature& a, const EdgeFeature& b) {
  const auto global = [&](int slave) { return surface.node[index(slave)]; };
  const int rigid = surface.rigid_body_of_all(std::array{global(a.node[0]), global(a.node[1])});
  if (rigid >= 0 && rigid == surface.rigid_body_of_all(std::array{global(b.node[0]), global(b.node[1])}))
    return false;
  if (surface.pairs.parts_apart(a.part, b.part)) return false;
  if (surface.tied.empty()) return true;
  const auto tied = [&](const EdgeFeature& edge, const EdgeFeature& other) {
    return std::any_of(edge.node.begin(), edge.node.end(),
                       [&](int slave) { return surface.tied.apart(surface.node[index(slave)], other.part); });
  };
  return !tied(a, b) && !tied(b, a);
}

// Beams that were drawn within the tightest fold of each other, as shells are (exclusion.hpp).
bool drawn_together(const SurfaceFeatures& features, const EdgeFeature& a, const EdgeFeature& b) {
  if (a.round < 0 || b.round < 0) return true;
  const auto drawn = [&](const EdgeFeature& edge) -> const Segment& {
    return features.drawn_beam[index(edge.round)];
  };
  const double fold = 0.5 * std::numbers::pi * (a.radius + b.radius);
  return closest_points_of_segments(drawn(a), drawn(b)).squared_distance < fold * fold;
}

}  // namespace

bool may_be_paired(const Surface& surface, const EdgeFeature& a, const EdgeFeature& b) {
  return !share_node(a, b) && kinds_meet(a, b) && !on_one_face(a, b) && may_meet(surface, a, b);
}

bool are_of_one_piece(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                      const EdgeFeature& a, const EdgeFeature& b) {
  const auto excludes = [&](const EdgeFeature& edge, const EdgeFeature& other) {
    for (int node : edge.node)
      for (int f : other.face)
        if (f >= 0 && is_excluded(excluded, node, f)) return true;
    return false;
  };
  if (!surface.tied.one_piece(a.body, b.body)) return false;
  if (!a.of_face() && !b.of_face()) return a.body == b.body && drawn_together(features, a, b);
  return excludes(a, b) || excludes(b, a);
}

}  // namespace brio
