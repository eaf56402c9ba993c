#include "contact/detection/proximity.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "contact/detection/proximity_filter.hpp"
#include "contact/pairs/pair_packs.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

// Of unit length but for rounding to single precision, or zero.
template <class Points>
Vector3d between_middles(const Points& at) {
  const auto middle = [](const auto& points) {
    Vector3d sum = points[0];
    for (std::size_t k = 1; k < points.size(); ++k) sum = sum + points[k];
    return 1.0 / static_cast<double>(points.size()) * sum;
  };
  const Vector3d d = middle(at.first) - middle(at.second);
  const double inverse = std::sqrt(inverse_or_zero(dot(d, d)));
  const auto rounded = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  return {rounded(inverse * d.x), rounded(inverse * d.y), rounded(inverse * d.z)};
}

/// Passes over a range of active pairs of one kind.
template <class Kind>
class Finder {
 public:
  Finder(const Kind& kind, const ProximityFilter& filter)
      : kind_(kind),
        filter_(filter),
        rows_(kind.motion.node.data()->start),
        end_rows_(kind.motion.node.data()->end),
        band_(proximity_band * kind.features.smallest_edge),
        least_square_(square(no_distance * kind.features.smallest_edge)) {}

  // Active pairs of the range that are not near are dropped: the others close up from its beginning.
  void find(std::vector<int>& active, std::size_t begin, std::size_t end, Proximity::Range& range) const {
    PairsOfRange near;
    std::size_t last = begin;
    for (std::size_t i = begin; i < end; ++i) {
      prefetch_pairs(kind_, active.data(), i, end);
      if (!is_near(OnePair<Kind>(kind_, active[i]))) continue;
      near.add(kind_.list, active[i]);
      active[last++] = active[i];
    }
    range.found.clear();
    range.closest_points = last - begin;
    find_closest<false>(near, range.found);
    find_closest<true>(near, range.found);
  }

 private:
  // Whether its stored direction does not separate it by enough. Of a pair that has been as near as the band
  // the direction is not asked: it would be answered so in every step of a contact.
  BRIO_INLINE bool is_near(const OnePair<Kind>& one) const {
    Vector3d direction = one.direction();
    const bool is_known = !(dot(direction, direction) < 0.5);
    if (is_known && one.record.spacing != Spacing::waiting && kind_.list.wake[one.pair] <= one.path())
      return true;
    const auto at = one.points(rows_);
    if (!is_known) {
      direction = between_middles(at);
      kind_.list.set_direction(one.pair, direction.x, direction.y, direction.z);
    }
    const double apart = (1 - rounding_of_direction) * height_between(direction, at.first, at.second);
    const Spacing spacing = one.record.spacing;
    // Waiting pairs are examined as if they did not wait, so that they are found disjoint before contact.
    const double reach = spacing == Spacing::skins ? 2 * kind_.features.skin : one.radii();
    const double wake = one.path() + apart - reach - band_;
    kind_.list.wake[one.pair] = wake;
    if (spacing == Spacing::waiting && apart > reach) kind_.list.end_wait(one.pair);
    return !(wake > one.ahead());
  }

  static BRIO_INLINE Pack reach_to_wake(const PackOfWays& ways) {
    return where(ways.waits, ways.radii, ways.reach);
  }
  BRIO_INLINE void end_wait(const typename Kind::Pairs& pack, MaskOf<Pack> apart) const {
    for_lanes(lane_bits(apart) & pack.lanes(),
              [&](int lane) { kind_.list.end_wait(index(pack.pair[lane])); });
  }

  template <bool Spaced>
  void find_closest(const PairsOfRange& near, std::vector<FoundContact>& found) const {
    const std::size_t count = near.count[Spaced ? 1 : 0];
    for (std::size_t i = 0; i < count; i += pack_size) {
      const auto pack =
          pack_of(kind_, near.pair[Spaced ? 1 : 0].data(), i, std::min<std::size_t>(count, i + pack_size));
      PackOfWays ways = ways_of(kind_, pack);
      const auto points = points_of(pack, rows_);
      const auto closest = kind_.closest(points, Spaced);
      const Pack distance = sqrt(closest.squared_distance);
      const Pack at_end = where(ways.waits, Pack(0.0), kind_.path_at_end(pack, points, closest));
      const Pack left = max(distance - reach_to_wake(ways) - Pack(band_), at_end);
      if (!Spaced) {
        const MaskOf<Pack> apart = ways.waits & (distance > ways.radii);
        end_wait(pack, apart);
        ways.reach = where(apart, ways.radii, ways.reach);
      }
      store_wakes(kind_.list, pack, pack.lanes(), ways.path + left);
      const MaskOf<Pack> has_direction = closest.squared_distance > Pack(least_square_);
      const Pack length = sqrt(dot(closest.offset, closest.offset));
      const Vector3<Pack> normal = (Pack(1.0) / where(has_direction, length, Pack(1.0))) * closest.offset;
      const unsigned lanes = lane_bits(has_direction) & pack.lanes();
      store_directions(kind_.list, pack, lanes, normal);
      const unsigned wanted = lanes & candidates(closest);
      if (wanted == 0) continue;
      const Pack approach = Pack(approach_factor) * longest_approach(points, points_of(pack, end_rows_));
      for_lanes(lane_bits(!(left > approach)) & wanted, [&](int lane) {
        filter(closest, lane, pack.pair[lane], {normal.x[lane], normal.y[lane], normal.z[lane]}, length[lane],
               ways.reach[lane], found);
      });
    }
  }

  // Of any point of one feature towards any of the other in this step: in any frame, and no more than the
  // predicted paths.
  static BRIO_INLINE Pack longest_approach(const typename Kind::Points& start,
                                           const typename Kind::Points& end) {
    Pack square(0.0);
    for (std::size_t k = 0; k < start.first.size(); ++k)
      for (std::size_t l = 0; l < start.second.size(); ++l) {
        const Vector3<Pack> relative = (end.first[k] - start.first[k]) - (end.second[l] - start.second[l]);
        square = max(square, dot(relative, relative));
      }
    return sqrt(square);
  }

  // Without those that the filter rejects at once: edges of faces that are nearest at their ends.
  unsigned candidates(const ClosestNodeFace&) const { return first_lanes(pack_size); }
  unsigned candidates(const ClosestOnSegments<Pack>& closest) const {
    if (!kind_.features.all_of_faces) return first_lanes(pack_size);
    const auto is_inside = [](Pack at) { return (at > Pack(no_weight)) & (at < Pack(1 - no_weight)); };
    return lane_bits(is_inside(closest.on_a) & is_inside(closest.on_b));
  }

  void filter(const ClosestNodeFace& closest, int lane, int pair, const Vector3d& normal, double distance,
              double reach, std::vector<FoundContact>& found) const {
    const std::array<Pack, 4>& w = closest.weights;
    filter_.node_and_face({pair, {w[0][lane], w[1][lane], w[2][lane], w[3][lane]}, normal, distance, reach},
                          found);
  }
  void filter(const ClosestOnSegments<Pack>& closest, int lane, int pair, const Vector3d& normal,
              double distance, double reach, std::vector<FoundContact>& found) const {
    filter_.edge_and_edge({pair, {closest.on_a[lane], closest.on_b[lane]}, normal, distance, reach}, found);
  }

  const Kind& kind_;
  const ProximityFilter& filter_;
  const double* rows_;
  const double* end_rows_;
  double band_;
  double least_square_;
};

// Lists of what ranges have found, by node or edge.
void list_found(Proximity& proximity, std::size_t ranges) {
  proximity.found.clear();
  proximity.before.clear();
  proximity.features.clear();
  for (std::size_t r = 0; r < ranges; ++r) {
    for (const FoundContact& entry : proximity.range[r].found) {
      const Contact& contact = entry.contact;
      const int feature = contact.of_edges() ? contact.slave - first_edge_slave : contact.slave;
      int& last = proximity.last_found[index(feature)];
      proximity.before.push_back(last);
      last = static_cast<int>(proximity.found.size());
      proximity.features.insert(feature);
      proximity.found.push_back(&entry);
    }
    proximity.closest_points += proximity.range[r].closest_points;
  }
}

// In an order that depends on the surface alone, none twice.
void choose(Proximity& proximity, std::size_t feature, Proximity::Chosen& chosen) {
  std::vector<const FoundContact*>& found = chosen.found;
  found.clear();
  for (int i = std::exchange(proximity.last_found[feature], -1); i >= 0; i = proximity.before[index(i)])
    found.push_back(proximity.found[index(i)]);
  std::sort(found.begin(), found.end(), [](const FoundContact* a, const FoundContact* b) {
    return std::tuple(a->support, !a->in_plane, a->contact.face, a->contact.node) <
           std::tuple(b->support, !b->in_plane, b->contact.face, b->contact.node);
  });
  for (std::size_t i = 0; i < found.size(); ++i)
    if (i == 0 || found[i]->support != found[i - 1]->support) chosen.contacts.push_back(found[i]);
}

// From that place among the contacts on. \returns the end of their places
std::size_t take_over(Proximity& proximity, std::size_t ranges, std::size_t begin, ThreadTeam& team,
                      std::vector<Contact>& contacts) {
  list_found(proximity, ranges);
  proximity.chosen.resize(proximity.features.ranges());
  for (Proximity::Chosen& one : proximity.chosen) one.contacts.clear();
  proximity.features.for_each(team, [&](std::size_t range, std::size_t feature) {
    choose(proximity, feature, proximity.chosen[range]);
  });
  std::size_t end = begin;
  for (Proximity::Chosen& one : proximity.chosen) {
    one.begin = end;
    end += one.contacts.size();
  }
  if (contacts.size() < end) contacts.resize(end);
  team.for_each(proximity.chosen.size(), [&](std::size_t range) {
    const Proximity::Chosen& one = proximity.chosen[range];
    for (std::size_t i = 0; i < one.contacts.size(); ++i) contacts[one.begin + i] = one.contacts[i]->contact;
  });
  return end;
}

// What the ranges have kept, without gaps.
void close_up(const Proximity& proximity, std::size_t ranges, std::vector<int>& active) {
  auto last = active.begin();
  for (std::size_t r = 0; r < ranges; ++r) {
    const auto first = active.begin() + static_cast<std::ptrdiff_t>(r * pairs_a_range);
    last = std::copy_n(first, proximity.range[r].closest_points, last);
  }
  active.erase(last, active.end());
}

// Constraints from that place on. \returns the end of their places
template <class Kind>
std::size_t find_of_kind(Proximity& proximity, const Kind& kind, const ProximityFilter& filter,
                         std::vector<int>& active, std::size_t first, ThreadTeam& team,
                         std::vector<Contact>& contacts) {
  if (active.empty()) return first;
  const std::size_t ranges = (active.size() + pairs_a_range - 1) / pairs_a_range;
  while (proximity.range.size() < ranges) proximity.range.emplace_back().found.reserve(pairs_a_range / 8);
  const Finder<Kind> finder(kind, filter);
  team.for_ranges(active.size(), pairs_a_range, [&](std::size_t begin, std::size_t end) {
    finder.find(active, begin, end, proximity.range[begin / pairs_a_range]);
  });
  proximity.looked_at += active.size();
  close_up(proximity, ranges, active);
  return take_over(proximity, ranges, first, team, contacts);
}

}  // namespace

// Of both nodes less than the band: pairs that are not near cannot meet within the limits.
double allowed_surplus(const SurfaceFeatures& features) {
  constexpr double share_of_band = 0.25;
  static_assert(2 * share_of_band < 1);
  return share_of_band * proximity_band * features.smallest_edge;
}

void select_active(Proximity& proximity, const SurfaceFeatures& features, const Surface& surface,
                   const Lists& excluded, const ContactOptions& options, FeaturePairs& pairs,
                   FeatureMotion& motion, ThreadTeam& team) {
  const double surplus = 2 * allowed_surplus(features);
  pairs.open_near(features, surface, excluded, options, motion, surplus, team);
  select_active_pairs(proximity.node_face_blocks, pairs.node_face, motion.of_node, motion.of_face, motion,
                      surplus, team, proximity.node_face);
  select_active_pairs(proximity.edge_edge_blocks, pairs.edge_edge, motion.of_edge, motion.of_edge, motion,
                      surplus, team, proximity.edge_edge);
}

void find_proximities(Proximity& proximity, const SurfaceFeatures& features, const Surface& surface,
                      const Lists& excluded, const ContactOptions& options, FeaturePairs& pairs,
                      const FeatureMotion& motion, ThreadTeam& team, std::span<const Contact> last,
                      std::vector<Contact>& contacts) {
  const std::size_t most = std::max(motion.node.size(), features.edge_node.size());
  proximity.last_found.resize(most, -1);
  proximity.features.resize(most);
  const ProximityFilter filter(features, surface, excluded, options, pairs, motion, last);
  const NodesAndFaces nodes_and_faces{features, motion, pairs.node_face};
  std::size_t end = find_of_kind(proximity, nodes_and_faces, filter, proximity.node_face, 0, team, contacts);
  const EdgesAndEdges edges_and_edges{features, motion, pairs.edge_edge};
  end = find_of_kind(proximity, edges_and_edges, filter, proximity.edge_edge, end, team, contacts);
  contacts.resize(end);
}

}  // namespace brio
