#include "contact/pairs/feature_pairs.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "src/base/index.hpp"

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
constexpr std::size_t nodes_a_range = 1024;
/// Overlapping boxes in a search, and open pairs: so many a feature, and so many times those that do at rest
/// (cells much finer than they are thick meet hundreds), where what is at rest grows by so much at a search
/// for all. Where motion takes nodes past each other, all meet.
constexpr std::uint64_t most_pairs_a_feature = 150;
constexpr std::uint64_t most_of_rest = 3;
constexpr double growth_of_rest = 1.1;
/// Of two faces: pairs of features that they are the first to have.
constexpr std::uint64_t features_of_pair = 18;
constexpr std::uint64_t no_limit = ~std::uint64_t{0};

using Flags = SearchedBoxes::Change;

}  // namespace

void SearchedBoxes::begin_search(std::size_t count) {
  box.grow(count);
  flag.assign(count, 0);
  before.resize(count, empty_box);
  leaving.clear();
}

void SearchedBoxes::leave(int i, const CaptureBox& other) {
  at(before, i) = box.of(i);
  box.change(i, other);
}

FeaturePairs::Scene FeaturePairs::scene_of(const SurfaceFeatures& features, const Surface& surface,
                                           const Lists& excluded, const ContactOptions& options,
                                           const SearchedDepth& depth) {
  return {features,
          surface,
          excluded,
          share_of_buffer * options.reach_buffer,
          proximity_band * features.smallest_edge,
          options.edges,
          depth};
}

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

bool FeaturePairs::begin_step(const SurfaceFeatures& features, const Surface& surface,
                              const FeatureMotion& motion, ThreadTeam& team) {
  const bool hides_less = flat_.follow_lengths(features, motion, team);
  return is_due(features, surface, motion, team) || hides_less;
}

bool FeaturePairs::is_due(const SurfaceFeatures& features, const Surface& surface,
                          const FeatureMotion& motion, ThreadTeam& team) {
  if (reach_.size() != surface.slaves() || !changes_.empty()) return true;
  std::atomic<bool> any_left = false;
  team.for_ranges(reach_.size(), nodes_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      if (surface.node[s] >= 0 && !is_inside(s, motion, approach_factor)) {
        any_left.store(true, std::memory_order_relaxed);
        return;
      }
  });
  return any_left || flat_.any_bends(features, motion, team);
}

bool FeaturePairs::is_due_after_solution(const SurfaceFeatures& features, const Surface& surface,
                                         const FeatureMotion& motion, ThreadTeam& team) {
  if (!motion.knows_corrected() || motion.exceeds_limits()) return is_due(features, surface, motion, team);
  std::atomic<bool> any_left = false;
  motion.for_each_corrected(team, [&](std::size_t, std::size_t s) {
    if (surface.node[s] >= 0 && !is_inside(s, motion, 1)) any_left.store(true, std::memory_order_relaxed);
  });
  return any_left || flat_.any_bends_by_solution(features, surface, motion, team);
}

double FeaturePairs::scale_of(std::size_t slave, const Scene& scene, const FeatureMotion& motion) {
  const double* own = motion.node[slave].start;
  double shortest = infinity;
  for (int other : scene.features.ring.of(static_cast<int>(slave))) {
    const double* end = motion.node[index(other)].start;
    const Vector3d edge{end[0] - own[0], end[1] - own[1], end[2] - own[2]};
    shortest = std::min(shortest, dot(edge, edge));
  }
  return std::min(scene.features.mean_edge, most_of_own_edge * std::sqrt(shortest));
}

void FeaturePairs::place(std::size_t slave, const Scene& scene, const FeatureMotion& motion) {
  const NodeMotion64& node = motion.node[slave];
  const Vector3d step = motion.displacement(static_cast<int>(slave)) - vector_at(motion.frame());
  const double length = norm(step), scale = scale_of(slave, scene, motion), margin = scene.margin * scale;
  const double steps = std::clamp(length > 0 ? way_ahead * scale / length : most_steps_ahead,
                                  least_steps_ahead, most_steps_ahead);
  for (int axis = 0; axis < 3; ++axis) {
    const double x = node.start[axis] - motion.frame_since_restart()[axis];
    const double ahead = steps * step[axis];
    reach_[slave].lower[axis] = x + std::min(ahead, 0.0) - margin;
    reach_[slave].upper[axis] = x + std::max(ahead, 0.0) + margin;
  }
}

CaptureBox FeaturePairs::face_box(const Scene& scene, int face) const {
  const std::array<int, 4>& nodes = at(scene.features.face_node, face);
  return grown(box_of(nodes), at(face_radius_, face) + 0.5 * (scene.band + scene.depth.most_of(nodes)));
}
CaptureBox FeaturePairs::round_box(const Scene& scene, int edge) const {
  const std::array<int, 2>& nodes = at(scene.features.edge_node, edge);
  return grown(box_of(nodes), at(round_radius_, edge) + 0.5 * (scene.band + scene.depth.most_of(nodes)));
}

CaptureBox FeaturePairs::debris_box(const Scene& scene, int slave) const {
  return grown(at(reach_, slave),
               at(scene.features.node_radius, slave) + 0.5 * (scene.band + scene.depth.of(slave)));
}

// A node, a side or a beam may have a radius of its own.
void FeaturePairs::measure_radii(const Scene& scene) {
  const SurfaceFeatures& features = scene.features;
  face_radius_.resize(features.face_node.size(), 0);
  for (int f : faces_.leaving) {
    double& radius = at(face_radius_, f);
    radius = at(features.face_radius, f);
    for (int node : at(features.face_node, f)) radius = std::max(radius, at(features.node_radius, node));
    for (int e : at(features.edge_of_face, f))
      if (e >= 0) radius = std::max(radius, at(features.edge_radius, e));
  }
  round_radius_.resize(rounds_.flag.size(), 0);
  for (int e : rounds_.leaving) {
    double& radius = at(round_radius_, e);
    radius = at(features.edge_radius, e);
    for (int node : at(features.edge_node, e)) radius = std::max(radius, at(features.node_radius, node));
  }
}

void FeaturePairs::list_rounds_of_nodes(const Scene& scene) {
  if (scene.features.all_of_faces) return;
  round_of_node_.assign(scene.surface.slaves(), -1);
  for (int e : scene.features.edge_of_round) {
    if (e < 0) continue;
    for (int node : at(scene.features.edge_node, e))
      if (int& first = at(round_of_node_, node); first < 0 || e < first) first = e;
  }
}

void FeaturePairs::list_debris(const Scene& scene) {
  debris_node_.clear();
  for (int s = 0; s < static_cast<int>(scene.surface.slaves()); ++s)
    if (at(scene.surface.node, s) >= 0 && scene.surface.faces_of.of(s).empty() &&
        (round_of_node_.empty() || at(round_of_node_, s) < 0))
      debris_node_.push_back(s);
}

void FeaturePairs::find(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                        const ContactOptions& options, FeatureMotion& motion, ThreadTeam& team,
                        const SearchedDepth& depth) {
  const Scene scene = scene_of(features, surface, excluded, options, depth);
  ++searches_;
  const std::size_t all = surface.slaves() + surface.face.size() + features.edge.size();
  const std::uint64_t before = counts.candidate_pairs;
  const std::uint64_t at_rest = most_of_rest * met_at_rest_;
  most_pairs_ = depth.empty() ? before + most_pairs_a_feature * all + at_rest : no_limit;
  most_open_ = depth.empty() ? most_pairs_a_feature * all + features_of_pair * at_rest : no_limit;
  kept_.clear();
  kept_.young = changes_;
  kept_.young.sort();
  const bool is_first = reach_.empty();
  reach_.resize(surface.slaves(), empty_box);
  if (is_first)
    flat_.measure(features, motion, team);
  else
    flat_.change(features, motion, changes_.face, changes_.edge);
  faces_.begin_search(surface.face.size());
  rounds_.begin_search(features.all_of_faces ? 0 : features.edge.size());
  if (is_first || !changes_.empty()) {
    list_rounds_of_nodes(scene);
    list_debris(scene);
  }
  const bool has_debris = !debris_node_.empty() || debris_.box.size() > 0;
  debris_.begin_search(has_debris ? surface.slaves() : 0);
  if (!is_first && collect_leaving(scene, motion, team)) {
    lay_boxes_of_leaving(scene, motion);
    drop_pairs(scene, motion, team);
    add_hidden(scene, motion);
    add_pairs(scene, motion, team);
  } else {
    start_over(scene, motion, team);
    add_pairs(scene, motion, team);
    const std::uint64_t met = counts.candidate_pairs - before;
    const auto grown_rest = static_cast<std::uint64_t>(growth_of_rest * static_cast<double>(met_at_rest_));
    met_at_rest_ = depth.empty() && met_at_rest_ > 0 ? std::min(met, grown_rest) : met;
  }
  close_up();
  watch_paired_edges(scene, motion);
  changes_.clear();
  if (!depth.empty()) open_all(scene, motion);
}

void FeaturePairs::watch_paired_edges(const Scene& scene, FeatureMotion& motion) {
  paired_.assign(scene.features.edge.size(), 0);
  for (const PairRecord& pair : edge_edge.records())
    if (pair.spacing != Spacing::none) at(paired_, pair.first) = at(paired_, pair.second) = 1;
  for (int e : scene.features.edge_of_round)
    if (e >= 0) {
      at(paired_, e) = 1;
      motion.watch_edge(scene.features, e);
    }
  motion.watch_only(paired_);
}

void FeaturePairs::close_up() {
  const auto close = [&](PairList& list, Parents parents) {
    std::vector<int> number;
    list.close_up([&](std::size_t from, std::size_t to) {
      number.resize(from + 1, -1);
      number[from] = static_cast<int>(to);
    });
    if (number.empty()) return;
    const auto renumber = [&](int parent) {
      if (parent == no_parent || parents_of(parent) != parents) return parent;
      return parent_number(parents, index(number[place_of_parent(parent)]));
    };
    node_face.renumber_parents(renumber);
    edge_edge.renumber_parents(renumber);
  };
  close(face_face, Parents::faces);
  close(round_face, Parents::rounds);
  node_face.close_up();
  edge_edge.close_up();
}

void FeaturePairs::change(std::span<const int> nodes, std::span<const int> faces, std::span<const int> edges,
                          std::span<const int> grown) {
  if (reach_.empty()) {
    changes_.all = true;
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
  faces_.box.find(
      boxes, team, apart, no_limit, false, [](std::size_t, int) { return true; },
      [&](std::size_t i, int f, bool) { found.emplace_back(i, f); });
  return found;
}

// Nodes stand for all features at them, what has changed for all faces at it.
void FeaturePairs::mark_changes(const Scene& scene) {
  constexpr std::uint8_t both = Flags::leaves | Flags::is_new;
  node_flag_.assign(reach_.size(), 0);
  for (int s : changes_.node) at(node_flag_, s) |= both;
  for (int f : changes_.face) at(faces_.flag, f) |= both;
  for (int e : changes_.edge) {
    if (!rounds_.flag.empty()) at(rounds_.flag, e) |= both;
    for (int f : at(scene.features.edge, e).face)
      if (f >= 0) at(faces_.flag, f) |= both;
  }
  if (!debris_.flag.empty())
    for (int s : changes_.node) at(debris_.flag, s) |= both;
}

// \returns whether they are few
bool FeaturePairs::collect_leaving(const Scene& scene, const FeatureMotion& motion, ThreadTeam& team) {
  const Surface& surface = scene.surface;
  mark_changes(scene);
  std::size_t count = 0;
  for (std::size_t s = 0; s < reach_.size(); ++s)
    if (surface.node[s] >= 0 && (node_flag_[s] != 0 || !is_inside(s, motion, steps_of_notice))) {
      node_flag_[s] |= Flags::leaves;
      ++count;
    }
  const auto few = static_cast<double>(reach_.size()) * most_leaving;
  if (static_cast<double>(count + faces_.box.changed() + rounds_.box.changed() + debris_.box.changed()) > few)
    return false;
  flat_.take_over(scene.features, motion, Flags::bends, faces_.flag, team);
  const auto collect = [&](SearchedBoxes& boxes, int i, const auto& nodes) {
    for (int node : nodes) at(boxes.flag, i) |= at(node_flag_, node);
    if ((boxes.flag_of(i) & Flags::leaves) != 0) boxes.leaving.push_back(i);
  };
  for (int f = 0; f < static_cast<int>(surface.face.size()); ++f)
    if (at(surface.face, f).alive()) collect(faces_, f, at(scene.features.face_node, f));
  for (int e : scene.features.edge_of_round)
    if (e >= 0) collect(rounds_, e, at(scene.features.edge_node, e));
  std::sort(rounds_.leaving.begin(), rounds_.leaving.end());
  for (int s : debris_node_) collect(debris_, s, std::array{s});
  return true;
}

// All leave, with new boxes.
void FeaturePairs::start_over(const Scene& scene, FeatureMotion& motion, ThreadTeam& team) {
  motion.restart(scene.features, scene.surface, team);
  flat_.forget(scene.features, !scene.depth.bends_faces);
  reach_.assign(scene.surface.slaves(), empty_box);
  for (std::size_t s = 0; s < reach_.size(); ++s)
    if (scene.surface.node[s] >= 0) place(s, scene, motion);
  for (SearchedBoxes* boxes : {&faces_, &rounds_, &debris_}) {
    boxes->leaving.clear();
    boxes->box.start(boxes->flag.size());
    boxes->flag.assign(boxes->flag.size(), Flags::leaves | Flags::is_new);
  }
  for (int f = 0; f < static_cast<int>(scene.surface.face.size()); ++f)
    if (at(scene.surface.face, f).alive()) faces_.leaving.push_back(f);
  for (int e : scene.features.edge_of_round)
    if (e >= 0) rounds_.leaving.push_back(e);
  std::sort(rounds_.leaving.begin(), rounds_.leaving.end());
  measure_radii(scene);
  for (int f : faces_.leaving) faces_.box.set(index(f), face_box(scene, f));
  for (int e : rounds_.leaving) rounds_.box.set(index(e), round_box(scene, e));
  if (!debris_.flag.empty()) debris_.leaving = debris_node_;
  for (int s : debris_.leaving) debris_.box.set(index(s), debris_box(scene, s));
  for (SearchedBoxes* boxes : {&faces_, &rounds_, &debris_}) boxes->box.build(team);
  for (const auto& [list, kept] :
       {std::pair(&node_face, &kept_.node_face), std::pair(&edge_edge, &kept_.edge_edge)}) {
    for (const PairRecord& pair : list->records()) kept->add(pair, kept_.young);
    kept->sort();
  }
  for (PairList* list : {&face_face, &round_face, &node_face, &edge_edge}) list->clear();
}

void FeaturePairs::lay_boxes_of_leaving(const Scene& scene, const FeatureMotion& motion) {
  for (std::size_t s = 0; s < reach_.size(); ++s)
    if ((node_flag_[s] & Flags::leaves) != 0 && scene.surface.node[s] >= 0) place(s, scene, motion);
  measure_radii(scene);
  for (int f : faces_.leaving) faces_.leave(f, face_box(scene, f));
  for (int e : rounds_.leaving) rounds_.leave(e, round_box(scene, e));
  for (int s : debris_.leaving) debris_.leave(s, debris_box(scene, s));
  for (int s : changes_.node)
    if (!debris_.flag.empty() && !std::binary_search(debris_node_.begin(), debris_node_.end(), s))
      debris_.leave(s, empty_box);
  for (int f : changes_.face)
    if (!at(scene.surface.face, f).alive()) faces_.leave(f, empty_box);
  for (int e : changes_.edge)
    if (!rounds_.flag.empty() && !at(scene.features.edge, e).alive()) rounds_.leave(e, empty_box);
}

}  // namespace brio
