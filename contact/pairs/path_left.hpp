#pragma once
/// Path that is left to pairs of faces, or of beams or particles with faces, until their features may come
/// near.

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "contact/pairs/feature_distance.hpp"
#include "contact/pairs/pair_packs.hpp"
#include "src/base/index.hpp"

namespace brio {

/// A direction is kept as long as it separates a pair for so many steps like this one.
inline constexpr double steps_to_keep = 4;

/// Pairs of faces, or of beams or particles with faces, as passes over pairs take them (pair_packs.hpp).
template <Parents Of>
struct ParentPairs {
  static constexpr Parents parents = Of;
  static constexpr bool of_faces = Of == Parents::faces;
  using Pairs = PackOfPairs<of_faces ? 4 : 2, 4>;
  using Points = PackOfPoints<Pairs::first_points, Pairs::second_points>;
  const SurfaceFeatures& features;
  const FeatureMotion& motion;
  PairList& list;
  const std::vector<double>& radius_of_first;
  const std::vector<double>& radius_of_face;

  const PathAndAhead& first_ways() const { return of_faces ? motion.of_face : motion.of_edge; }
  const PathAndAhead& second_ways() const { return motion.of_face; }
  const std::vector<double>& first_radii() const { return radius_of_first; }
  const std::vector<double>& second_radii() const { return radius_of_face; }
  const auto& first_nodes(int first) const {
    if constexpr (of_faces)
      return at(features.face_node, first);
    else
      return at(features.edge_node, first);
  }
  const std::array<int, 4>& second_nodes(int face) const { return at(features.face_node, face); }
};
using FacesAndFaces = ParentPairs<Parents::faces>;
using RoundsAndFaces = ParentPairs<Parents::rounds>;

/// By the direction that is kept; where none is, no number is less.
template <class Kind>
double left_along_direction(const OnePair<Kind>& one, const typename OnePair<Kind>::Points& at, double band) {
  const Vector3d direction = one.direction();
  if (dot(direction, direction) < 0.5) return -infinity;
  const double reach = one.record.spacing == Spacing::skins ? 2 * one.kind.features.skin : one.radii();
  return (1 - rounding_of_direction) * height_between(direction, at.first, at.second) - reach - band;
}

template <class Kind>
DistanceBound<double> distance_of_features(const OnePair<Kind>& one,
                                           const typename OnePair<Kind>::Points& at) {
  if constexpr (Kind::of_faces)
    if (one.a == one.b) return distance_of_opposite_sides(at.first);
  return CommonCorners(one, at).distance();
}

/// By the distance of what has no common node; its direction is kept.
template <class Kind>
double left_by_distance(const OnePair<Kind>& one, const typename OnePair<Kind>::Points& at, double band) {
  const DistanceBound<double> bound = distance_of_features(one, at);
  one.kind.list.set_direction(one.pair, bound.direction.x, bound.direction.y, bound.direction.z);
  const double skins = 2 * one.kind.features.skin;
  if (one.record.spacing == Spacing::skins) return bound.distance - skins - band;
  if (one.record.one_piece == 0) return bound.distance - one.radii() - band;
  // What is of one piece is nearer than the radii of what is not.
  const double left = bound.distance - skins - band;
  return left > 0 ? std::min(left, distance_of_pieces(at, one.record.one_piece) - one.radii() - band) : left;
}

/// From the start of this step. \param ahead of this step
template <class Kind>
double path_left(const OnePair<Kind>& one, double band, double ahead) {
  const auto at = one.points(one.kind.motion.node.data()->start);
  const double left = left_along_direction(one, at, band);
  return left > steps_to_keep * ahead ? left : left_by_distance(one, at, band);
}

/// The same of many pairs; of those without common nodes, which are most, distances are found eight at once.
template <class Kind>
class PathsLeft {
 public:
  PathsLeft(const Kind& kind, double band, double surplus)
      : kind_(kind), rows_(kind.motion.node.data()->start), band_(band), surplus_(surplus) {}

  /// Sets when the pairs of a range have to be examined. Those that may come near in this step close up from
  /// its beginning. \returns how many
  std::size_t keep_near(std::span<int> pairs) const {
    Range range;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      prefetch_pairs(kind_, pairs.data(), i, pairs.size());
      look(OnePair<Kind>(kind_, pairs[i]), i, range);
    }
    look_at<false>(range);
    look_at<true>(range);
    std::size_t near = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      kind_.list.wake[index(pairs[i])] = range.path[i] + range.left[i];
      if (!(range.left[i] > range.ahead[i])) pairs[near++] = pairs[i];
    }
    return near;
  }

 private:
  struct Range {
    std::array<double, pairs_a_range> path, ahead, left;
    /// Pairs whose distances are to be found, and their places: of those with one measure, and of those that
    /// are of one piece in part.
    std::array<std::array<int, pairs_a_range>, 2> pair, place;
    std::array<std::size_t, 2> count{};
  };

  static bool have_common_corner(const OnePair<Kind>& one) {
    bool found = false;
    for (int node : one.kind.first_nodes(one.a))
      for (int other : one.kind.second_nodes(one.b)) found |= node == other;
    return found;
  }

  BRIO_INLINE void look(const OnePair<Kind>& one, std::size_t i, Range& range) const {
    range.path[i] = one.path();
    range.ahead[i] = one.ahead() - range.path[i] + surplus_;
    const auto at = one.points(rows_);
    double left = left_along_direction(one, at, band_);
    if (!(left > steps_to_keep * range.ahead[i])) {
      if (!have_common_corner(one)) {
        const std::size_t kind = one.record.one_piece != 0 && one.record.spacing != Spacing::skins ? 1 : 0;
        range.pair[kind][range.count[kind]] = static_cast<int>(one.pair);
        range.place[kind][range.count[kind]++] = static_cast<int>(i);
        return;
      }
      left = left_by_distance(one, at, band_);
    }
    range.left[i] = left;
  }

  template <bool InPart>
  void look_at(Range& range) const {
    constexpr std::size_t kind = InPart ? 1 : 0;
    for (std::size_t i = 0; i < range.count[kind]; i += pack_size) {
      const auto pack =
          pack_of(kind_, range.pair[kind].data(), i, std::min<std::size_t>(range.count[kind], i + pack_size));
      const auto points = points_of(pack, rows_);
      const DistanceBound<Pack> bound = distance_bound(PackOfCorners<first_points>{points.first},
                                                       PackOfCorners<second_points>{points.second});
      store_directions(kind_.list, pack, pack.lanes(), bound.direction);
      const Pack radii = radii_of(kind_, pack), skins(2 * kind_.features.skin);
      const Pack reach =
          InPart ? skins : Pack(where(have_spacing(Spacing::skins, kind_.list, pack), skins, radii));
      Pack left = bound.distance - reach - Pack(band_);
      if constexpr (InPart) left = min(left, distance_of_pieces(pack, points) - radii - Pack(band_));
      for_lanes(pack.lanes(),
                [&](int lane) { at(range.left, range.place[kind][i + index(lane)]) = left[lane]; });
    }
  }

  // Of what is not of one piece (distance_of_pieces of one pair): corners that are stand where one is that is
  // not.
  Pack distance_of_pieces(const typename Kind::Pairs& pack, const typename Kind::Points& points) const {
    typename Kind::Pairs kept = pack;
    Pack least_of_first(0.0), least_of_second(0.0);
    for (int lane = 0; lane < pack_size; ++lane) {
      const unsigned bits = kind_.list[index(pack.pair[lane])].one_piece;
      if (!keep(kept, lane, 0, first_points, bits)) least_of_first.set(lane, infinity);
      if (!keep(kept, lane, first_points, second_points, bits >> 4)) least_of_second.set(lane, infinity);
    }
    const auto kept_at = points_of(kept, rows_);
    const Pack first = distance_bound(PackOfCorners<first_points>{kept_at.first},
                                      PackOfCorners<second_points>{points.second})
                           .distance,
               second = distance_bound(PackOfCorners<second_points>{kept_at.second},
                                       PackOfCorners<first_points>{points.first})
                            .distance;
    return min(max(first, least_of_first), max(second, least_of_second));
  }
  // \returns whether any corner is kept
  static bool keep(typename Kind::Pairs& pack, int lane, std::size_t begin, std::size_t corners,
                   unsigned left_out) {
    const unsigned kept = ~left_out & first_lanes(static_cast<int>(corners));
    if (kept == 0) return false;
    const int node = pack.node[begin + index(std::countr_zero(kept))][lane];
    for (std::size_t k = 0; k < corners; ++k)
      if ((left_out >> k & 1U) != 0) pack.node[begin + k][lane] = node;
    return true;
  }

  static constexpr std::size_t first_points = Kind::Pairs::first_points,
                               second_points = Kind::Pairs::second_points;
  const Kind& kind_;
  const double* rows_;
  double band_, surplus_;
};

}  // namespace brio
