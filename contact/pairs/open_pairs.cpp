// Opening and closing of pairs of faces, and of beams and particles with faces: their features.

#include <algorithm>

#include "contact/pairs/edge_pairs.hpp"
#include "contact/pairs/feature_pairs.hpp"
#include "contact/pairs/path_left.hpp"
#include "contact/surface/exclusion.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Distance beyond contact, over the mean edge, from which on a pair of faces is closed.
constexpr double distance_to_close = 0.1;
std::uint64_t key_of(int a, int b) {
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
}

bool is_open(const PairList& list, std::size_t pair) {
  return list.wake[pair] == infinity && list.spacing(pair) != Spacing::none;
}

/// What is nearer than its radii although all of the pair was of one piece waits.
Spacing spacing_under(const PairRecord& parent, Spacing spacing) {
  return spacing == Spacing::radii && parent.spacing == Spacing::skins ? Spacing::waiting : spacing;
}

/// What belongs to a face, or to a beam or particle: of nodes and sides that others share, those that it is
/// the first to have.
class OwnFeatures {
 public:
  OwnFeatures(const SurfaceFeatures& features, const Surface& surface, int face) {
    const auto& corners = at(features.face_node, face);
    const auto& faces_of = surface.faces_of;
    for (std::size_t k = 0; k < 4; ++k)
      if (faces_of.of(corners[k]).front() == face &&
          std::find(corners.begin(), corners.begin() + k, corners[k]) == corners.begin() + k)
        add_node(features, corners[k]);
    for (int e : at(features.edge_of_face, face))
      if (e >= 0 && at(features.edge, e).face[0] == face) edge_[edges_++] = e;
    for (int e : at(features.diagonal_of_face, face))
      if (e >= 0) edge_[edges_++] = e;
  }
  OwnFeatures(const SurfaceFeatures& features, const Surface& surface, const std::vector<int>& round_of_node,
              int round) {
    edge_[edges_++] = round;
    const auto& [a, b] = at(features.edge_node, round);
    for (int node : {a, b})
      if (surface.faces_of.of(node).empty() && at(round_of_node, node) == round &&
          (nodes_ == 0 || node_[0] != node))
        node_[nodes_++] = node;
  }
  std::span<const int> nodes() const { return {node_.data(), nodes_}; }
  std::span<const int> edges() const { return {edge_.data(), edges_}; }

 private:
  void add_node(const SurfaceFeatures& features, int node) {
    node_[nodes_++] = node;
    if (features.point_of_node.empty()) return;
    if (const int point = at(features.point_of_node, node); point >= 0) edge_[edges_++] = point;
  }

  std::array<int, 4> node_{};
  std::array<int, 10> edge_{};
  std::size_t nodes_ = 0, edges_ = 0;
};

OwnFeatures own_features(const SurfaceFeatures& features, const Surface& surface,
                         const std::vector<int>& round_of_node, Parents parents, int first) {
  return parents == Parents::faces ? OwnFeatures(features, surface, first)
                                   : OwnFeatures(features, surface, round_of_node, first);
}

}  // namespace

bool FeaturePairs::owns_opposite_sides(const Scene& scene, int face) {
  const std::array<int, 4>& sides = at(scene.features.edge_of_face, face);
  const auto owns = [&](std::size_t k) {
    return sides[k] >= 0 && at(scene.features.edge, sides[k]).face[0] == face;
  };
  return at(scene.features.diagonal_of_face, face)[0] >= 0 && ((owns(0) && owns(2)) || (owns(1) && owns(3)));
}

void FeaturePairs::open_near(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                             const ContactOptions& options, FeatureMotion& motion, double surplus,
                             ThreadTeam& team) {
  const Scene scene = scene_of(features, surface, excluded, options, {});
  for (PairList* list : {&node_face, &edge_edge}) list->begin_changes();
  open_kind(scene, FacesAndFaces{features, motion, face_face, face_radius_, face_radius_}, face_blocks_,
            surplus, motion, team);
  open_kind(scene, RoundsAndFaces{features, motion, round_face, round_radius_, face_radius_}, round_blocks_,
            surplus, motion, team);
  kept_.clear();
}

template <class Kind>
void FeaturePairs::open_kind(const Scene& scene, const Kind& kind, PairBlocks& blocks, double surplus,
                             FeatureMotion& motion, ThreadTeam& team) {
  PairList& list = kind.list;
  if (list.size() == 0) return;
  select_active_pairs(blocks, list, kind.first_ways(), kind.second_ways(), motion, surplus, team, awake_);
  if (awake_.empty()) return;
  near_.assign((awake_.size() + pairs_a_range - 1) / pairs_a_range, 0);
  const PathsLeft<Kind> paths(kind, scene.band, surplus);
  team.for_ranges(awake_.size(), pairs_a_range, [&](std::size_t begin, std::size_t end) {
    near_[begin / pairs_a_range] = paths.keep_near({&awake_[begin], end - begin});
  });
  for (std::size_t range = 0; range < near_.size(); ++range)
    for (std::size_t i = 0; i < near_[range]; ++i) {
      if (node_face.size() + edge_edge.size() > most_open_) throw TooManyNear();
      open(scene, Kind::parents, index(awake_[range * pairs_a_range + i]), motion);
    }
}

void FeaturePairs::open_all(const Scene& scene, FeatureMotion& motion) {
  for (PairList* list : {&node_face, &edge_edge}) list->begin_changes();
  for (std::size_t i = 0; i < face_face.size(); ++i) open(scene, Parents::faces, i, motion);
  for (std::size_t i = 0; i < round_face.size(); ++i) open(scene, Parents::rounds, i, motion);
  kept_.clear();
}

void FeaturePairs::open(const Scene& scene, Parents parents, std::size_t pair, FeatureMotion& motion) {
  MotionGroups& groups = motion.groups;
  PairList& list = parents == Parents::faces ? face_face : round_face;
  const PairRecord record = list[pair];
  const int parent = parent_number(parents, pair), a = record.first, b = record.second;
  list.wake[pair] = infinity;
  if (parents == Parents::faces) flat_.watch(scene.features, motion, a);
  flat_.watch(scene.features, motion, b);
  const auto add_nodes = [&](std::span<const int> slaves, int f) {
    for (int s : slaves)
      if (const Spacing spacing = node_face_spacing(scene, s, f); spacing != Spacing::none)
        node_face.add({.first = s,
                       .second = f,
                       .relation = groups.relate(s, at(scene.features.face_node, f)[0]),
                       .spacing = spacing_under(record, spacing),
                       .parent = parent});
  };
  const OwnFeatures second(scene.features, scene.surface, b);
  if (parents == Parents::faces && a == b) {
    const std::array<int, 4>& sides = at(scene.features.edge_of_face, a);
    for (std::size_t k = 0; k < 2; ++k)
      if (std::count(second.edges().begin(), second.edges().end(), sides[k]) +
              std::count(second.edges().begin(), second.edges().end(), sides[k + 2]) ==
          2)
        add_edges(scene, motion, record, parent, sides[k], sides[k + 2]);
    return;
  }
  const OwnFeatures first = own_features(scene.features, scene.surface, round_of_node_, parents, a);
  add_nodes(first.nodes(), b);
  if (parents == Parents::faces) add_nodes(second.nodes(), a);
  for (int e : first.edges())
    for (int other : second.edges()) add_edges(scene, motion, record, parent, e, other);
}

void FeaturePairs::add_edges(const Scene& scene, FeatureMotion& motion, const PairRecord& record, int parent,
                             int e, int other) {
  const int first = std::min(e, other), second = std::max(e, other);
  const Spacing spacing = edge_edge_spacing(scene, first, second);
  if (spacing == Spacing::none) return;
  pair_edges(scene, motion,
             {.first = first,
              .second = second,
              .relation = motion.groups.relate(at(scene.features.edge_node, first)[0],
                                               at(scene.features.edge_node, second)[0]),
              .spacing = spacing_under(record, spacing),
              .parent = parent});
}

void FeaturePairs::pair_edges(const Scene& scene, FeatureMotion& motion, const PairRecord& pair) {
  motion.watch_edge(scene.features, pair.first);
  motion.watch_edge(scene.features, pair.second);
  edge_edge.add(pair);
}

// Of open pairs with faces that bend: edges that flat shapes have hidden, those of them that are not paired
// yet.
void FeaturePairs::add_hidden(const Scene& scene, FeatureMotion& motion) {
  if (std::none_of(fate_.begin(), fate_.end(), [](const std::vector<PairFate>& fate) {
        return std::find(fate.begin(), fate.end(), PairFate::bends) != fate.end();
      }))
    return;
  edge_edge.begin_changes();
  bending_.clear();
  for (const PairRecord& pair : edge_edge.records())
    if (pair.parent != no_parent && fate_of(pair.parent) == PairFate::bends)
      bending_.push_back(key_of(pair.first, pair.second));
  std::sort(bending_.begin(), bending_.end());
  const auto joins = [&](int e) {
    const std::array<int, 2>& face = at(scene.features.edge, e).face;
    return std::any_of(face.begin(), face.end(),
                       [&](int f) { return f >= 0 && (faces_.flag_of(f) & SearchedBoxes::bends) != 0; });
  };
  for (const Parents parents : {Parents::faces, Parents::rounds}) {
    const std::vector<PairFate>& fate = fate_[index(parents)];
    for (std::size_t i = 0; i < fate.size(); ++i) {
      if (fate[i] != PairFate::bends) continue;
      const PairRecord record = (parents == Parents::faces ? face_face : round_face)[i];
      const OwnFeatures first = own_features(scene.features, scene.surface, round_of_node_, parents,
                                             record.first),
                        second(scene.features, scene.surface, record.second);
      for (int e : first.edges())
        for (int other : second.edges())
          if ((joins(e) || joins(other)) &&
              !std::binary_search(bending_.begin(), bending_.end(),
                                  key_of(std::min(e, other), std::max(e, other))))
            add_edges(scene, motion, record, parent_number(parents, i), e, other);
    }
  }
}

// Pairs of what has changed, or whose boxes part, are taken out. Of those that stay, open ones that leave
// their boxes and are far again are closed.
template <class Kind>
void FeaturePairs::drop_of_kind(const Scene& scene, const Kind& kind, const SearchedBoxes& firsts,
                                ThreadTeam& team) {
  constexpr std::size_t pairs_a_task = 1024;
  static_assert(pairs_a_task % PairList::block_size == 0);
  PairList& list = kind.list;
  std::vector<PairFate>& fate = fate_[index(Kind::parents)];
  fate.assign(list.size(), PairFate::stays);
  list.begin_changes();
  const double far = distance_to_close * scene.features.mean_edge;
  team.for_ranges(list.size(), pairs_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const unsigned flags = firsts.flag_of(list.first(i)) | faces_.flag_of(list.second(i));
      if (flags == 0 || list.spacing(i) == Spacing::none) continue;
      if (parts(firsts, list.first(i), faces_, list.second(i))) {
        fate[i] = PairFate::leaves;
      } else if (is_open(list, i)) {
        const OnePair<Kind> one(kind, static_cast<int>(i));
        const double left = path_left(one, scene.band, far / steps_to_keep);
        if (left > far) {
          list.reset_wake(i, one.path() + left);
          fate[i] = PairFate::closes;
        } else if ((flags & SearchedBoxes::bends) != 0 && one.a != one.b) {
          fate[i] = PairFate::bends;
        }
      }
    }
  });
}

bool FeaturePairs::parts(const SearchedBoxes& a, int i, const SearchedBoxes& b, int j) {
  const int flags = a.flag_of(i) | b.flag_of(j);
  return (flags & SearchedBoxes::leaves) != 0 &&
         ((flags & SearchedBoxes::is_new) != 0 || !a.box.of(i).overlaps(b.box.of(j)));
}

void FeaturePairs::drop_pairs(const Scene& scene, const FeatureMotion& motion, ThreadTeam& team) {
  drop_of_kind(scene, FacesAndFaces{scene.features, motion, face_face, face_radius_, face_radius_}, faces_,
               team);
  drop_of_kind(scene, RoundsAndFaces{scene.features, motion, round_face, round_radius_, face_radius_},
               rounds_, team);
  const auto leaves = [&](const PairRecord& pair, const SearchedBoxes& first, const SearchedBoxes& second) {
    return pair.parent == no_parent ? parts(first, pair.first, second, pair.second)
                                    : fate_of(pair.parent) >= PairFate::closes;
  };
  node_face.remove_if([&](std::size_t i) { return leaves(node_face[i], debris_, faces_); }, team,
                      [&](const PairRecord& pair) { kept_.node_face.add(pair, kept_.young); });
  edge_edge.remove_if([&](std::size_t i) { return leaves(edge_edge[i], rounds_, rounds_); }, team,
                      [&](const PairRecord& pair) { kept_.edge_edge.add(pair, kept_.young); });
  kept_.node_face.sort();
  kept_.edge_edge.sort();
  for (const auto& [list, parents] :
       {std::pair(&face_face, Parents::faces), std::pair(&round_face, Parents::rounds)})
    list->remove_if([&fate = fate_[index(parents)]](std::size_t i) { return fate[i] == PairFate::leaves; },
                    team, [](const PairRecord&) {});
}

void FeaturePairs::KeptPairs::add(const PairRecord& pair, const Young& young) {
  if (pair.spacing == Spacing::waiting) waiting.push_back(key_of(pair.first, pair.second));
  if (pair.spacing == Spacing::radii && !young.empty()) radii.push_back(key_of(pair.first, pair.second));
}

void FeaturePairs::KeptPairs::sort() {
  std::sort(radii.begin(), radii.end());
  std::sort(waiting.begin(), waiting.end());
}

// Of a pair of features that are not young: whether it was listed does not matter, as it has been apart if it
// was not.
Spacing FeaturePairs::KeptPairs::spacing_of_new(int a, int b, bool is_young) const {
  const auto is_in = [&](const std::vector<std::uint64_t>& keys) {
    return std::binary_search(keys.begin(), keys.end(), key_of(a, b));
  };
  return (is_young ? is_in(radii) : !is_in(waiting)) ? Spacing::radii : Spacing::waiting;
}

bool FeaturePairs::Young::contains(const SurfaceFeatures& features, int e) const {
  if (empty()) return false;
  const auto& [a, b] = at(features.edge_node, e);
  return all || is_in(edge, e) || is_in(node, a) || is_in(node, b);
}

// With a depth, whether boxes of a node and a face, or of two edges, meet: within a body they have none.
bool FeaturePairs::boxes_meet(const Scene& scene, int slave, int f) const {
  const Face& face = at(scene.surface.face, f);
  const bool same = face.body == at(scene.surface.body, slave);
  const auto grown_by = [&](double radius, double depth) {
    return radius + 0.5 * (scene.band + (same ? 0 : depth));
  };
  return grown(at(reach_, slave), grown_by(at(scene.features.node_radius, slave), scene.depth.of(slave)))
      .overlaps(grown(box_of(at(scene.features.face_node, f)),
                      grown_by(at(scene.features.face_radius, f), scene.depth.of(scene.surface, face))));
}
bool FeaturePairs::boxes_meet(const Scene& scene, const EdgeFeature& a, const EdgeFeature& b) const {
  const auto box = [&](const EdgeFeature& edge) {
    return grown(box_of(edge.node),
                 edge.radius + 0.5 * (scene.band + (a.body == b.body ? 0 : scene.depth.of(edge))));
  };
  return box(a).overlaps(box(b));
}

// None: they are not paired.
Spacing FeaturePairs::node_face_spacing(const Scene& scene, int slave, int f) const {
  const Face& face = at(scene.surface.face, f);
  if (face.has(at(scene.surface.node, slave)) || scene.surface.never_touch(slave, face)) return Spacing::none;
  if (!scene.depth.empty() && !boxes_meet(scene, slave, f)) return Spacing::none;
  if (is_excluded(scene.excluded, slave, f)) return Spacing::skins;
  const Young& young = kept_.young;
  if (young.is_in(young.grown, slave)) return Spacing::waiting;
  const double radii = at(scene.features.node_radius, slave) + at(scene.features.face_radius, f);
  if (radii <= 2 * scene.features.skin) return Spacing::radii;
  const bool is_young = young.all || young.is_in(young.node, slave) || young.is_in(young.face, f);
  return kept_.node_face.spacing_of_new(slave, f, is_young);
}

Spacing FeaturePairs::edge_edge_spacing(const Scene& scene, int first, int second) const {
  const EdgeFeature &a = at(scene.features.edge, first), &b = at(scene.features.edge, second);
  if (!scene.edges && a.of_face() && b.of_face()) return Spacing::none;
  if (!may_be_paired(scene.surface, a, b)) return Spacing::none;
  if (!scene.depth.empty() && !boxes_meet(scene, a, b)) return Spacing::none;
  const bool spaced = !are_of_one_piece(scene.features, scene.surface, scene.excluded, a, b);
  const bool only_skins = a.radius + b.radius <= 2 * scene.features.skin;
  const auto spacing_apart = [&] {
    if (only_skins) return Spacing::radii;
    const bool is_young =
        kept_.young.contains(scene.features, first) || kept_.young.contains(scene.features, second);
    return kept_.edge_edge.spacing_of_new(first, second, is_young);
  };
  const Spacing spacing = spaced ? spacing_apart() : Spacing::skins;
  // At the start nothing may be missing when such a face bends.
  const bool radii = spacing == Spacing::radii && scene.depth.empty();
  return flat_.pairs(scene.features, first, second, radii) ? spacing : Spacing::none;
}

}  // namespace brio
