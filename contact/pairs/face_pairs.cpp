// Pairs of faces, of beams, particles and debris with faces, and of beams and particles, by their boxes.

#include <algorithm>

#include "contact/pairs/feature_pairs.hpp"
#include "contact/surface/exclusion.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using Flags = SearchedBoxes::Change;

/// PairRecord::one_piece of pairs all of whose features are of one piece, and of those that never meet: no
/// pair has these bits.
constexpr std::uint8_t all_one_piece = 0xff, never = 0x0f;

}  // namespace

// Of what leaves, with all whose boxes it meets. Pairs whose boxes have met before are listed.
void FeaturePairs::add_pairs(const Scene& scene, FeatureMotion& motion, ThreadTeam& team) {
  MotionGroups& groups = motion.groups;
  const auto is_listed = [](const SearchedBoxes& a, int i, const SearchedBoxes& b, int j) {
    return ((a.flag_of(i) | b.flag_of(j)) & Flags::is_new) == 0 && a.last_box(i).overlaps(b.last_box(j));
  };
  const auto leaves = [](const SearchedBoxes& boxes, int i) {
    return (boxes.flag_of(i) & Flags::leaves) != 0;
  };
  const auto find_in = [&](SearchedBoxes& others, const SearchedBoxes& own, auto none, const auto& judge,
                           const auto& add) {
    if (own.leaving.empty() || others.box.size() == 0) return;
    query_.clear();
    for (int i : own.leaving) query_.push_back(own.box.of(i));
    others.box.find(
        query_, team, counts, most_pairs_, none,
        [&](std::size_t i, int other) {
          return is_listed(own, own.leaving[i], others, other) ? none : judge(own.leaving[i], other);
        },
        [&](std::size_t i, int other, auto judgement) { add(own.leaving[i], other, judgement); });
  };
  for (PairList* list : {&face_face, &round_face, &node_face, &edge_edge}) list->begin_changes();

  const auto node_of_face = [&](int f) { return at(scene.features.face_node, f)[0]; };
  const auto node_of_edge = [&](int e) { return at(scene.features.edge_node, e)[0]; };
  const auto add = [&](PairList& list, const auto& node_of_first, int first, int second,
                       std::uint8_t one_piece) {
    list.add({.first = first,
              .second = second,
              .relation = groups.relate(node_of_first(first), node_of_face(second)),
              .spacing = one_piece == all_one_piece ? Spacing::skins : Spacing::radii,
              .one_piece = one_piece});
  };
  for (int f : faces_.leaving)
    if ((faces_.flag_of(f) & Flags::is_new) != 0 && owns_opposite_sides(scene, f))
      add(face_face, node_of_face, f, f, all_one_piece);
  find_in(
      faces_, faces_, never,
      [&](int f, int g) {
        if (f == g || (g < f && leaves(faces_, g))) return never;
        return one_piece_of_faces(scene, std::min(f, g), std::max(f, g));
      },
      [&](int f, int g, std::uint8_t one_piece) {
        add(face_face, node_of_face, std::min(f, g), std::max(f, g), one_piece);
      });
  const auto add_debris = [&](int s, int f, Spacing spacing) {
    node_face.add(
        {.first = s, .second = f, .relation = groups.relate(s, node_of_face(f)), .spacing = spacing});
  };
  find_in(
      faces_, debris_, Spacing::none, [&](int s, int f) { return node_face_spacing(scene, s, f); },
      add_debris);
  find_in(
      debris_, faces_, Spacing::none,
      [&](int f, int s) { return leaves(debris_, s) ? Spacing::none : node_face_spacing(scene, s, f); },
      [&](int f, int s, Spacing spacing) { add_debris(s, f, spacing); });
  const auto add_round = [&](int e, int f, std::uint8_t one_piece) {
    add(round_face, node_of_edge, e, f, one_piece);
  };
  find_in(
      faces_, rounds_, never, [&](int e, int f) { return one_piece_of_round(scene, e, f); }, add_round);
  find_in(
      rounds_, faces_, never,
      [&](int f, int e) { return leaves(rounds_, e) ? never : one_piece_of_round(scene, e, f); },
      [&](int f, int e, std::uint8_t one_piece) { add_round(e, f, one_piece); });
  find_in(
      rounds_, rounds_, Spacing::none,
      [&](int e, int other) {
        if (e == other || (other < e && leaves(rounds_, other))) return Spacing::none;
        return edge_edge_spacing(scene, std::min(e, other), std::max(e, other));
      },
      [&](int e, int other, Spacing spacing) {
        const int first = std::min(e, other), second = std::max(e, other);
        pair_edges(scene, motion,
                   {.first = first,
                    .second = second,
                    .relation = groups.relate(node_of_edge(first), node_of_edge(second)),
                    .spacing = spacing});
      });
}

namespace {

// Whether rules or a common rigid body keep all features of both apart.
template <std::size_t Count>
bool never_meet(const Surface& surface, const std::array<int, Count>& slaves, int part, const Face& face) {
  std::array<int, Count> node;
  for (std::size_t k = 0; k < Count; ++k) node[k] = at(surface.node, slaves[k]);
  const int rigid = surface.rigid_body_of_all(node);
  if (rigid >= 0 && rigid == surface.rigid_body_of_all(face.node)) return true;
  if (!surface.pairs.parts_apart(part, face.part)) return false;
  const auto all_apart = [&](const auto& nodes, int from) {
    return std::all_of(nodes.begin(), nodes.end(), [&](int n) { return surface.pairs.apart(n, from); });
  };
  return all_apart(node, face.part) && all_apart(face.node, part);
}

template <std::size_t Count>
unsigned excluded_corners(const Lists& excluded, const std::array<int, Count>& slaves, int face) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < Count; ++k) bits |= unsigned{is_excluded(excluded, slaves[k], face)} << k;
  return bits;
}

}  // namespace

std::uint8_t FeaturePairs::one_piece_of_faces(const Scene& scene, int first, int second) const {
  const Face &a = at(scene.surface.face, first), &b = at(scene.surface.face, second);
  const auto &nodes = at(scene.features.face_node, first), &others = at(scene.features.face_node, second);
  if (never_meet(scene.surface, nodes, a.part, b)) return never;
  if (!scene.surface.tied.one_piece(a.body, b.body)) return 0;
  const auto bits = static_cast<std::uint8_t>(excluded_corners(scene.excluded, nodes, second) |
                                              excluded_corners(scene.excluded, others, first) << 4);
  return bits == never ? 0 : bits;
}

std::uint8_t FeaturePairs::one_piece_of_round(const Scene& scene, int edge, int f) const {
  const EdgeFeature& round = at(scene.features.edge, edge);
  const Face& face = at(scene.surface.face, f);
  if (never_meet(scene.surface, round.node, round.part, face)) return never;
  if (!scene.surface.tied.one_piece(round.body, face.body)) return 0;
  // A beam with such a node is of one piece with all edges of the face: what is left is its other node.
  const unsigned bits = excluded_corners(scene.excluded, round.node, f);
  constexpr unsigned corners_of_face = 0xf0;
  return bits == 0 ? 0 : bits == 3 ? all_one_piece : static_cast<std::uint8_t>(bits | corners_of_face);
}

}  // namespace brio
