#include "contact/detection/crossing_guard.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "contact/detection/crossing_check.hpp"
#include "contact/pairs/pair_packs.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Longest direction that is kept in single precision.
constexpr double longest_direction = 1 + rounding_of_direction;

/// Passes over a range of pairs of one kind: along the direction that they had, along those of their closest
/// points, and the exact check of the rest.
template <class Kind>
class Look {
  using Pairs = typename Kind::Pairs;
  using Points = typename Kind::Points;

 public:
  Look(const Kind& kind, const CrossingCheck& check)
      : kind_(kind),
        check_(check),
        start_rows_(kind.motion.node.data()->start),
        end_rows_(kind.motion.node.data()->end),
        extent_(2 * kind.motion.magnitude()) {}

  void look(const std::vector<int>& pairs, std::size_t begin, std::size_t end,
            CrossingGuard::Range& range) const {
    range.hits.clear();
    range.certified = range.renewed = range.checked = 0;
    PairsOfRange uncertain;
    for (std::size_t i = begin; i < end; ++i) {
      prefetch_pairs(kind_, pairs.data(), i, end);
      certify(OnePair<Kind>(kind_, pairs[i]), uncertain, range);
    }
    std::array<int, pairs_a_range> left;
    int* last = left.data();
    renew<false>(uncertain, range, last);
    renew<true>(uncertain, range, last);
    std::sort(left.data(), last);
    for (const int* pair = left.data(); pair != last; ++pair) check(index(*pair), range);
  }

 private:
  BRIO_INLINE MaskOf<Pack> separates(const Vector3<Pack>& d, const Points& start, const Points& end,
                                     Pack floor) const {
    return separation_within({Pack(extent_), Pack(extent_), Pack(extent_)}, d, start.first, end.first,
                             start.second, end.second)
        .exceeds(Pack(longest_direction) * floor);
  }

  // Edges that are points and of one piece are not kept apart at all.
  template <class Pairs>
  Pack floor_of(const Pairs& pack, unsigned& lanes) const {
    const MaskOf<Pack> keep_radii = have_spacing(Spacing::radii, kind_.list, pack);
    const Pack radii = where(keep_radii, radii_of(kind_, pack), Pack(0.0));
    Pack floor = least_distance(kind_.features, radii);
    unsigned points = 0;
    if constexpr (Pairs::first_points > 1)
      for (int lane = 0; lane < pack_size; ++lane)
        if (pack.node[0][lane] == pack.node[1][lane] || pack.node[2][lane] == pack.node[3][lane])
          points |= 1U << lane;
    if (points == 0) return floor;
    for_lanes(points, [&](int lane) { floor.set(lane, floor_of_points * radii[lane]); });
    lanes &= ~points | lane_bits(keep_radii);
    return floor;
  }

  BRIO_INLINE void certify(const OnePair<Kind>& one, PairsOfRange& uncertain,
                           CrossingGuard::Range& range) const {
    const Vector3d d = one.direction();
    const auto start = one.points(start_rows_), end = one.points(end_rows_);
    const bool keeps_radii = one.record.spacing == Spacing::radii, of_points = is_of_points(one);
    if (of_points && !keeps_radii) return;
    const double radii = keeps_radii ? one.radii() : 0;
    const double floor = of_points ? floor_of_points * radii : least_distance(kind_.features, radii);
    if (separation_within({extent_, extent_, extent_}, d, start.first, end.first, start.second, end.second)
            .exceeds(longest_direction * floor))
      ++range.certified;
    else
      uncertain.add(kind_.list, static_cast<int>(one.pair));
  }
  static bool is_of_points(const OnePair<Kind>& one) {
    if constexpr (Pairs::first_points == 1) return false;
    const auto& a = one.kind.first_nodes(one.a);
    const auto& b = one.kind.second_nodes(one.b);
    return a.front() == a.back() || b.front() == b.back();
  }

  // Whether the direction of the closest points at the start, at the end, or their mean separates them.
  template <bool Spaced>
  void renew(const PairsOfRange& uncertain, CrossingGuard::Range& range, int*& last) const {
    const std::size_t count = uncertain.count[Spaced ? 1 : 0];
    for (std::size_t i = 0; i < count; i += pack_size) {
      const Pairs pack = pack_of(kind_, uncertain.pair[Spaced ? 1 : 0].data(), i,
                                 std::min<std::size_t>(count, i + pack_size));
      const Points start = points_of(pack, start_rows_), end = points_of(pack, end_rows_);
      const auto at_start = kind_.closest(start, Spaced), at_end = kind_.closest(end, Spaced);
      unsigned lanes = pack.lanes();
      const Pack floor = min(floor_of(pack, lanes), Pack(floor_at_start) * sqrt(at_start.squared_distance));
      const Vector3<Pack> first = normalized(at_start.offset), second = normalized(at_end.offset);
      unsigned left = lanes;
      for (const Vector3<Pack>& wanted : {first, second, normalized(first + second)}) {
        const Vector3<Pack> direction = rounded_to_float(wanted);
        const unsigned certain = lane_bits(separates(direction, start, end, floor)) & left;
        store_directions(kind_.list, pack, certain, direction);
        left &= ~certain;
        if (left == 0) break;
      }
      range.renewed += static_cast<std::uint64_t>(__builtin_popcount(lanes & ~left));
      for_lanes(left, [&](int lane) { *last++ = pack.pair[lane]; });
    }
  }

  void check(std::size_t pair, CrossingGuard::Range& range) const {
    ++range.checked;
    std::optional<Hit> hit;
    if constexpr (Pairs::first_points == 1)
      hit = check_.node_and_face(pair);
    else
      hit = check_.edge_and_edge(pair);
    if (hit) range.hits.push_back(*hit);
  }

  const Kind& kind_;
  const CrossingCheck& check_;
  const double* start_rows_;
  const double* end_rows_;
  double extent_;
};

template <class Kind>
void look_at_kind(CrossingGuard& guard, const Kind& kind, const CrossingCheck& check,
                  const std::vector<int>& pairs, ThreadTeam& team) {
  if (pairs.empty()) return;
  const std::size_t ranges = (pairs.size() + pairs_a_range - 1) / pairs_a_range;
  if (guard.range.size() < ranges) guard.range.resize(ranges);
  const Look<Kind> look(kind, check);
  team.for_ranges(pairs.size(), pairs_a_range, [&](std::size_t begin, std::size_t end) {
    look.look(pairs, begin, end, guard.range[begin / pairs_a_range]);
  });
  for (std::size_t r = 0; r < ranges; ++r) {
    const CrossingGuard::Range& range = guard.range[r];
    guard.hits.insert(guard.hits.end(), range.hits.begin(), range.hits.end());
    guard.certified += range.certified;
    guard.renewed += range.renewed;
    guard.checked += range.checked;
  }
}

}  // namespace

void find_hits(CrossingGuard& guard, const Proximity& proximity, const SurfaceFeatures& features,
               const Surface& surface, const ContactOptions& options, FeaturePairs& pairs,
               const FeatureMotion& motion, std::span<const Contact> constraints, ThreadTeam& team) {
  guard.hits.clear();
  const CrossingCheck check(features, surface, options, pairs, motion, constraints);
  look_at_kind(guard, NodesAndFaces{features, motion, pairs.node_face}, check, proximity.node_face, team);
  look_at_kind(guard, EdgesAndEdges{features, motion, pairs.edge_edge}, check, proximity.edge_edge, team);
  // The order of pairs is that of searches.
  const auto features_of = [&](const Hit& hit) {
    const PairList& list = hit.kind == PairKind::node_face ? pairs.node_face : pairs.edge_edge;
    return std::tuple(hit.kind, list.first(hit.pair), list.second(hit.pair));
  };
  std::ranges::sort(guard.hits, {}, features_of);
  guard.found += guard.hits.size();
}

}  // namespace brio
