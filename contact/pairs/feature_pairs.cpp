#include "contact/pairs/feature_pairs.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "contact/pairs/edge_pairs.hpp"
#include "contact/surface/exclusion.hpp"

namespace brio {

namespace {

/// Steps of the present motion contained in a box (search margin): at least so many, and as many as move a
/// node by this fraction of its scale.
constexpr double least_steps_ahead = 10;
constexpr double most_steps_ahead = 200;
constexpr double way_ahead = 0.6;
/// Features that would leave their box within so many steps are searched together with those that do.
constexpr double steps_of_notice = 4;
/// If more than this fraction of the nodes have left, all are searched.
constexpr double most_leaving = 0.2;
/// The scale of a node is the mean edge of all, or this times the shortest edge at it: boxes of slender cells
/// contain a few neighbours, not hundreds.
constexpr double most_of_own_edge = 4;
/// Of ContactOptions::reach_buffer: both features of a pair have a box that is larger on both sides.
constexpr double share_of_buffer = 0.25;
constexpr std::size_t nodes_a_range = 4096;
/// Overlapping boxes in a search: so many a feature, and so many times those that do at rest (cells much
/// finer than they are thick meet hundreds), where what is at rest grows by so much at a search for all.
/// Where motion takes nodes past each other, all meet.
constexpr std::uint64_t most_pairs_a_feature = 150;
constexpr std::uint64_t most_of_rest = 3;
constexpr double growth_of_rest = 1.1;
constexpr std::uint64_t no_limit = ~std::uint64_t{0};

CaptureBox grown(CaptureBox box, double by) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] -= by;
    box.upper[axis] += by;
  }
  return box;
}

}  // namespace

bool FeaturePairs::is_inside(std::size_t slave, const FeatureMotion& motion, double steps) const {
  const NodeMotion64& node = motion.node[slave];
  for (int axis = 0; axis < 3; ++axis) {
    const double moved = motion.frame_since_restart()[axis];
    const double x =
        node.start[axis] - moved + steps * (node.end[axis] - node.start[axis] - motion.frame()[axis]);
    if (!(x >= reach_[slave].lower[axis] && x <= reach_[slave].upper[axis])) return false;
  }
  return true;
}

bool FeaturePairs::is_due(const SurfaceFeatures& features, const Surface& surface,
                          const FeatureMotion& motion, ThreadTeam& team) {
  if (reach_.size() != surface.slaves() || !changes_.empty()) return true;
  std::atomic<bool> any_left = false;
  team.for_ranges(reach_.size(), nodes_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      if (surface.node[s] >= 0 && !is_inside(s, motion, 1)) {
        any_left.store(true, std::memory_order_relaxed);
        return;
      }
  });
  return any_left || flat_.any_bends(features, motion, team);
}

bool FeaturePairs::is_due_after_solution(const SurfaceFeatures& features, const Surface& surface,
                                         const FeatureMotion& motion, ThreadTeam& team) {
  if (!motion.knows_corrected() || motion.exceeds_limits()) return is_due(features, surface, motion, team);
  bool due = false;
  motion.for_each_corrected([&](std::size_t s) {
    if (surface.node[s] < 0) return;
    due = due || !is_inside(s, motion, 1);
    for (int f : surface.faces_of.of(static_cast<int>(s))) due = flat_.bends(features, f, motion) || due;
  });
  return due;
}

double FeaturePairs::scale_of(std::size_t slave, const Scene& scene, const FeatureMotion& motion) {
  const double* own = motion.node[slave].start;
  double shortest = infinity;
  for (int other : scene.features.ring.of(static_cast<int>(slave))) {
    const double* end = motion.node[static_cast<std::size_t>(other)].start;
    const Vector3<double> edge{end[0] - own[0], end[1] - own[1], end[2] - own[2]};
    shortest = std::min(shortest, dot(edge, edge));
  }
  return std::min(scene.features.mean_edge, most_of_own_edge * std::sqrt(shortest));
}

void FeaturePairs::place(std::size_t slave, const Scene& scene, const FeatureMotion& motion) {
  const NodeMotion64& node = motion.node[slave];
  const Eigen::Vector3d step =
      motion.displacement(static_cast<int>(slave)) - Eigen::Map<const Eigen::Vector3d>(motion.frame());
  const double length = step.norm(), scale = scale_of(slave, scene, motion), margin = scene.margin * scale;
  const double steps = std::clamp(length > 0 ? way_ahead * scale / length : most_steps_ahead,
                                  least_steps_ahead, most_steps_ahead);
  for (int axis = 0; axis < 3; ++axis) {
    const double x = node.start[axis] - motion.frame_since_restart()[axis];
    const double ahead = steps * step[axis];
    reach_[slave].lower[axis] = x + std::min(ahead, 0.0) - margin;
    reach_[slave].upper[axis] = x + std::max(ahead, 0.0) + margin;
  }
}

CaptureBox FeaturePairs::box_of(const Surface& surface, const Face& face) const {
  CaptureBox box = empty_box;
  for (int corner : face.node) box.include(reach_[static_cast<std::size_t>(surface.slave(corner))]);
  return box;
}
CaptureBox FeaturePairs::box_of(const EdgeFeature& edge) const {
  CaptureBox box = reach_[static_cast<std::size_t>(edge.node[0])];
  box.include(reach_[static_cast<std::size_t>(edge.node[1])]);
  return box;
}
CaptureBox FeaturePairs::node_box(const Scene& scene, std::size_t slave) const {
  return grown(reach_[slave], scene.features.node_radius[slave] +
                                  0.5 * (scene.band + scene.depth.of(static_cast<int>(slave))));
}
CaptureBox FeaturePairs::face_box(const Scene& scene, std::size_t face) const {
  return grown(box_of(scene.surface, scene.surface.face[face]),
               scene.features.face_radius[face] +
                   0.5 * (scene.band + scene.depth.of(scene.surface, scene.surface.face[face])));
}
CaptureBox FeaturePairs::edge_box(const Scene& scene, std::size_t edge) const {
  const EdgeFeature& own = scene.features.edge[edge];
  if (!flat_.pairs(own, false)) return empty_box;
  return grown(box_of(own), own.radius + 0.5 * (scene.band + scene.depth.of(own)));
}

void FeaturePairs::find(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                        const ContactOptions& options, FeatureMotion& motion, ThreadTeam& team,
                        const SearchedDepth& depth) {
  const Scene scene{features,
                    surface,
                    excluded,
                    share_of_buffer * options.reach_buffer,
                    proximity_band * features.smallest_edge,
                    options.edges,
                    depth};
  ++searches_;
  const std::size_t all = surface.slaves() + surface.face.size() + features.edge.size();
  const std::uint64_t before = counts.candidate_pairs;
  most_pairs_ = depth.empty() ? before + most_pairs_a_feature * all + most_of_rest * met_at_rest_ : no_limit;
  changed_ = !changes_.empty();
  kept_node_face_.clear();
  kept_edge_edge_.clear();
  if (!reach_.empty()) take_in_changes(scene);
  if (reach_.size() == surface.slaves() && collect_leaving(scene, motion)) {
    find_leaving(scene, motion, team);
  } else {
    find_all(scene, motion, team);
    const std::uint64_t met = counts.candidate_pairs - before;
    const auto grown_rest = static_cast<std::uint64_t>(growth_of_rest * static_cast<double>(met_at_rest_));
    met_at_rest_ = depth.empty() && met_at_rest_ > 0 ? std::min(met, grown_rest) : met;
  }
  node_face.close_up();
  edge_edge.close_up();
  forget_changes();
}

void FeaturePairs::forget_changes() {
  const auto forget = [](std::vector<std::uint8_t>& leaves, std::vector<int>& changed) {
    for (int i : changed) leaves[static_cast<std::size_t>(i)] = 0;
    changed.clear();
  };
  forget(node_leaves_, changes_.node);
  forget(face_leaves_, changes_.face);
  forget(edge_leaves_, changes_.edge);
  changes_.grown.clear();
  changes_.before_first_search = false;
}

void FeaturePairs::change(std::span<const int> nodes, std::span<const int> faces, std::span<const int> edges,
                          std::span<const int> grown) {
  if (reach_.empty()) {
    changes_.before_first_search = true;
    return;
  }
  const auto append = [](std::vector<int>& to, std::span<const int> from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(changes_.node, nodes);
  append(changes_.face, faces);
  append(changes_.edge, edges);
  append(changes_.grown, grown);
}

std::vector<std::pair<std::size_t, int>> FeaturePairs::find_faces(std::vector<CaptureBox> boxes,
                                                                  const FeatureMotion& motion,
                                                                  ThreadTeam& team) {
  std::vector<std::pair<std::size_t, int>> found;
  if (reach_.empty()) return found;
  for (CaptureBox& box : boxes)
    for (int axis = 0; axis < 3; ++axis) {
      const double moved = motion.frame_since_restart()[axis] + motion.frame()[axis];
      box.lower[axis] -= moved;
      box.upper[axis] -= moved;
    }
  SearchCounts apart;
  face_box_.find(
      boxes, team, apart, no_limit, false, [](std::size_t, int) { return true; },
      [&](std::size_t i, int f, bool) { found.emplace_back(i, f); });
  return found;
}

void FeaturePairs::take_in_changes(const Scene& scene) {
  reach_.resize(scene.surface.slaves(), empty_box);
  flat_.change(scene.surface.face.size(), changes_.face);
  node_box_.grow(reach_.size());
  face_box_.grow(scene.surface.face.size());
  edge_box_.grow(scene.features.edge.size());
  node_leaves_.resize(node_box_.size(), 0);
  face_leaves_.resize(face_box_.size(), 0);
  edge_leaves_.resize(edge_box_.size(), 0);
}

namespace {

std::uint64_t key_of(int a, int b) {
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
}

}  // namespace

void FeaturePairs::remember(std::vector<std::uint64_t>& kept, int a, int b, Spacing spacing) const {
  if (spacing == (changed_ ? Spacing::radii : Spacing::waiting)) kept.push_back(key_of(a, b));
}

Spacing FeaturePairs::spacing_of_new(const std::vector<std::uint64_t>& kept, int a, int b,
                                     bool only_skins) const {
  if (only_skins) return Spacing::radii;
  const bool was_kept = std::binary_search(kept.begin(), kept.end(), key_of(a, b));
  return was_kept == changed_ ? Spacing::radii : Spacing::waiting;
}

void FeaturePairs::find_all(const Scene& scene, FeatureMotion& motion, ThreadTeam& team) {
  motion.restart(scene.features, scene.surface, team);
  if (scene.depth.bends_faces)
    flat_.forget(scene.surface.face.size());
  else
    flat_.measure(scene.features, motion);
  const Surface& surface = scene.surface;
  reach_.assign(surface.slaves(), empty_box);
  node_box_.start(surface.slaves());
  for (std::size_t s = 0; s < reach_.size(); ++s) {
    if (surface.node[s] < 0) continue;
    place(s, scene, motion);
    node_box_.set(s, node_box(scene, s));
  }
  face_box_.start(surface.face.size());
  for (std::size_t f = 0; f < surface.face.size(); ++f)
    if (surface.face[f].alive()) face_box_.set(f, face_box(scene, f));
  edge_box_.start(scene.features.edge.size());
  for (std::size_t e = 0; e < scene.features.edge.size(); ++e)
    if (scene.features.edge[e].alive()) edge_box_.set(e, edge_box(scene, e));
  node_box_.build(team);
  face_box_.build(team);
  edge_box_.build(team);
  node_leaves_.assign(node_box_.size(), 0);
  face_leaves_.assign(face_box_.size(), 0);
  edge_leaves_.assign(edge_box_.size(), 0);

  const auto remember_all = [&](const PairList& pairs, std::vector<std::uint64_t>& kept) {
    for (const PairRecord& pair : pairs.records()) remember(kept, pair.first, pair.second, pair.spacing);
    std::sort(kept.begin(), kept.end());
  };
  remember_all(node_face, kept_node_face_);
  remember_all(edge_edge, kept_edge_edge_);
  node_face.clear();
  node_box_.find(
      face_box_.boxes(), team, counts, most_pairs_, Spacing::none,
      [&](std::size_t f, int s) { return node_face_spacing(scene, s, static_cast<int>(f)); },
      [&](std::size_t f, int s, Spacing spacing) {
        add_node_face(scene, motion.groups, s, static_cast<int>(f), spacing);
      });
  edge_edge.clear();
  edge_box_.find(
      edge_box_.boxes(), team, counts, most_pairs_, Spacing::none,
      [&](std::size_t e, int other) {
        return other > static_cast<int>(e) ? edge_edge_spacing(scene, static_cast<int>(e), other)
                                           : Spacing::none;
      },
      [&](std::size_t e, int other, Spacing spacing) {
        add_edge_edge(scene, motion.groups, static_cast<int>(e), other, spacing);
      });
}

// \returns whether they are few
bool FeaturePairs::collect_leaving(const Scene& scene, const FeatureMotion& motion) {
  const Surface& surface = scene.surface;
  for (int s : node_) node_leaves_[static_cast<std::size_t>(s)] = 0;
  for (int f : face_) face_leaves_[static_cast<std::size_t>(f)] = 0;
  for (int e : edge_) edge_leaves_[static_cast<std::size_t>(e)] = 0;
  node_.clear();
  face_.clear();
  edge_.clear();
  const auto mark = [](std::vector<std::uint8_t>& leaves, const std::vector<int>& changed) {
    for (int i : changed) leaves[static_cast<std::size_t>(i)] = 1;
  };
  mark(node_leaves_, changes_.node);
  mark(face_leaves_, changes_.face);
  mark(edge_leaves_, changes_.edge);
  for (std::size_t s = 0; s < reach_.size(); ++s)
    if (surface.node[s] >= 0 && (node_leaves_[s] != 0 || !is_inside(s, motion, steps_of_notice))) {
      node_.push_back(static_cast<int>(s));
      node_leaves_[s] = 1;
    }
  const auto few = static_cast<double>(node_box_.size()) * most_leaving;
  if (static_cast<double>(node_.size() + node_box_.changed()) > few) return false;
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    if (!surface.face[f].alive()) continue;
    for (int corner : surface.face[f].node)
      face_leaves_[f] |= node_leaves_[static_cast<std::size_t>(surface.slave(corner))];
    if (face_leaves_[f] != 0) face_.push_back(static_cast<int>(f));
  }
  flat_.take_over(scene.features, motion, edge_leaves_);
  for (std::size_t e = 0; e < scene.features.edge.size(); ++e) {
    if (!scene.features.edge[e].alive() || !flat_.pairs(scene.features.edge[e], false)) continue;
    for (int node : scene.features.edge[e].node)
      edge_leaves_[e] |= node_leaves_[static_cast<std::size_t>(node)];
    if (edge_leaves_[e] != 0) edge_.push_back(static_cast<int>(e));
  }
  return true;
}

void FeaturePairs::find_leaving(const Scene& scene, FeatureMotion& motion, ThreadTeam& team) {
  const auto leaves = [](const std::vector<std::uint8_t>& flags, int feature) {
    return flags[static_cast<std::size_t>(feature)] != 0;
  };
  const auto gather = [&](const FeatureBoxes& boxes, const std::vector<int>& features) {
    query_.clear();
    for (int feature : features) query_.push_back(boxes.of(feature));
  };
  for (int s : node_) place(static_cast<std::size_t>(s), scene, motion);
  for (int s : node_) node_box_.change(s, node_box(scene, static_cast<std::size_t>(s)));
  for (int f : face_) face_box_.change(f, face_box(scene, static_cast<std::size_t>(f)));
  for (int e : edge_) edge_box_.change(e, edge_box(scene, static_cast<std::size_t>(e)));
  drop_dead(scene);

  node_face.remove_if([&](int s, int f) { return leaves(node_leaves_, s) || leaves(face_leaves_, f); }, team,
                      [&](int s, int f, Spacing spacing) { remember(kept_node_face_, s, f, spacing); });
  std::sort(kept_node_face_.begin(), kept_node_face_.end());
  gather(face_box_, face_);
  node_box_.find(
      query_, team, counts, most_pairs_, Spacing::none,
      [&](std::size_t i, int s) { return node_face_spacing(scene, s, face_[i]); },
      [&](std::size_t i, int s, Spacing spacing) {
        add_node_face(scene, motion.groups, s, face_[i], spacing);
      });
  gather(node_box_, node_);
  face_box_.find(
      query_, team, counts, most_pairs_, Spacing::none,
      [&](std::size_t i, int f) {
        return leaves(face_leaves_, f) ? Spacing::none : node_face_spacing(scene, node_[i], f);
      },
      [&](std::size_t i, int f, Spacing spacing) {
        add_node_face(scene, motion.groups, node_[i], f, spacing);
      });

  edge_edge.remove_if([&](int a, int b) { return leaves(edge_leaves_, a) || leaves(edge_leaves_, b); }, team,
                      [&](int a, int b, Spacing spacing) { remember(kept_edge_edge_, a, b, spacing); });
  std::sort(kept_edge_edge_.begin(), kept_edge_edge_.end());
  gather(edge_box_, edge_);
  edge_box_.find(
      query_, team, counts, most_pairs_, Spacing::none,
      [&](std::size_t i, int other) {
        const int own = edge_[i];
        if (other == own || (leaves(edge_leaves_, other) && other < own)) return Spacing::none;
        return edge_edge_spacing(scene, std::min(own, other), std::max(own, other));
      },
      [&](std::size_t i, int other, Spacing spacing) {
        add_edge_edge(scene, motion.groups, std::min(edge_[i], other), std::max(edge_[i], other), spacing);
      });
}

// What is no more has no box; the flags of what changed stay for the removal of pairs.
void FeaturePairs::drop_dead(const Scene& scene) {
  for (int s : changes_.node)
    if (scene.surface.node[static_cast<std::size_t>(s)] < 0) node_box_.change(s, empty_box);
  for (int f : changes_.face)
    if (!scene.surface.face[static_cast<std::size_t>(f)].alive()) face_box_.change(f, empty_box);
  for (int e : changes_.edge)
    if (!scene.features.edge[static_cast<std::size_t>(e)].alive()) edge_box_.change(e, empty_box);
}

// None: they are not paired.
Spacing FeaturePairs::node_face_spacing(const Scene& scene, int slave, int f) const {
  const Face& face = scene.surface.face[static_cast<std::size_t>(f)];
  if (face.body == scene.surface.body[static_cast<std::size_t>(slave)] && !scene.depth.empty() &&
      !grown(face_box_.of(f), -0.5 * (scene.depth.of(scene.surface, face) + scene.depth.of(slave)))
           .overlaps(node_box_.of(slave)))
    return Spacing::none;
  if (face.has(scene.surface.node[static_cast<std::size_t>(slave)]) || scene.surface.never_touch(slave, face))
    return Spacing::none;
  const bool spaced = !is_excluded(scene.excluded, slave, f);
  if (!spaced) {
    const CaptureBox near = grown(box_of(scene.surface, face), 2 * scene.features.skin + scene.band);
    return near.overlaps(reach_[static_cast<std::size_t>(slave)]) ? Spacing::skins : Spacing::none;
  }
  const auto& grown_nodes = changes_.grown;
  if (std::find(grown_nodes.begin(), grown_nodes.end(), slave) != grown_nodes.end()) return Spacing::waiting;
  const double radii = scene.features.node_radius[static_cast<std::size_t>(slave)] +
                       scene.features.face_radius[static_cast<std::size_t>(f)];
  return spacing_of_new(kept_node_face_, slave, f, radii <= 2 * scene.features.skin);
}

Spacing FeaturePairs::edge_edge_spacing(const Scene& scene, int first, int second) const {
  const EdgeFeature& a = scene.features.edge[static_cast<std::size_t>(first)];
  const EdgeFeature& b = scene.features.edge[static_cast<std::size_t>(second)];
  if (!scene.edges && a.of_face() && b.of_face()) return Spacing::none;
  if (a.body == b.body && !scene.depth.empty() &&
      !grown(edge_box_.of(first), -0.5 * (scene.depth.of(a) + scene.depth.of(b)))
           .overlaps(edge_box_.of(second)))
    return Spacing::none;
  if (!may_be_paired(scene.surface, a, b)) return Spacing::none;
  const bool spaced = !are_of_one_piece(scene.features, scene.surface, scene.excluded, a, b);
  if (!spaced && !grown(box_of(a), 2 * scene.features.skin + scene.band).overlaps(box_of(b)))
    return Spacing::none;
  const bool only_skins = a.radius + b.radius <= 2 * scene.features.skin;
  const Spacing spacing =
      spaced ? spacing_of_new(kept_edge_edge_, first, second, only_skins) : Spacing::skins;
  // At the start nothing may be missing when such a face bends.
  const bool radii = spacing == Spacing::radii && scene.depth.empty();
  return flat_.pairs(a, radii) && flat_.pairs(b, radii) ? spacing : Spacing::none;
}

void FeaturePairs::add_node_face(const Scene& scene, MotionGroups& groups, int slave, int f,
                                 Spacing spacing) {
  node_face.add(slave, f, spacing,
                groups.relate(slave, scene.features.face_node[static_cast<std::size_t>(f)][0]));
}

void FeaturePairs::add_edge_edge(const Scene& scene, MotionGroups& groups, int first, int second,
                                 Spacing spacing) {
  const auto node_of = [&](int edge) { return scene.features.edge[static_cast<std::size_t>(edge)].node[0]; };
  edge_edge.add(first, second, spacing, groups.relate(node_of(first), node_of(second)));
}

}  // namespace brio
