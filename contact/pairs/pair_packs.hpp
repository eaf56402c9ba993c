#pragma once
/// Eight pairs of features side by side, of nodes and faces or of edges and edges: their points, the sums of
/// their radii, paths and looks ahead, the direction between them, and their closest points.
///
/// A pass over pairs goes through lists of them by eights: the last eight may be fewer, and repeats the last
/// pair in the lanes that are left over, which nothing is stored for.

#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "contact/features/gather.hpp"
#include "contact/geometry/closest_on_hull.hpp"
#include "contact/geometry/closest_on_segments.hpp"
#include "contact/geometry/separation.hpp"
#include "contact/pairs/feature_pairs.hpp"
#include "src/base/index.hpp"

namespace brio {

/// In single precision, in which directions are kept.
BRIO_INLINE Pack rounded_to_float(Pack a) {
  Row8 wide[2];
  widen_pair(narrow_pair(a.v, a.v), wide);
  return Pack(wide[0]);
}
BRIO_INLINE Vector3<Pack> rounded_to_float(const Vector3<Pack>& a) {
  return {rounded_to_float(a.x), rounded_to_float(a.y), rounded_to_float(a.z)};
}
/// Zero where the length is zero.
BRIO_INLINE Vector3<Pack> normalized(const Vector3<Pack>& a) { return sqrt(inverse_or_zero(dot(a, a))) * a; }

/// Which pairs, and the slave indices of their points.
template <std::size_t First, std::size_t Second>
struct PackOfPairs {
  static constexpr std::size_t first_points = First, second_points = Second;
  int pair[pack_size];
  int a[pack_size], b[pack_size];  ///< the features
  alignas(32) int node[First + Second][pack_size];
  int count;

  unsigned lanes() const { return first_lanes(count); }
};

/// Points of both features at one time, of one pair or of eight.
template <class T, std::size_t First, std::size_t Second>
struct PointsOfPair {
  std::array<Vector3<T>, First> first;
  std::array<Vector3<T>, Second> second;
};
template <std::size_t First, std::size_t Second>
using PackOfPoints = PointsOfPair<Pack, First, Second>;

template <std::size_t First, std::size_t Second>
BRIO_INLINE PackOfPoints<First, Second> points_of(const PackOfPairs<First, Second>& pack,
                                                  const double* rows) {
  constexpr std::size_t stride = sizeof(NodeMotion64) / sizeof(double);
  PackOfPoints<First, Second> points;
  for (std::size_t k = 0; k < First; ++k) points.first[k] = gather_points<Pack>(rows, stride, pack.node[k]);
  for (std::size_t k = 0; k < Second; ++k)
    points.second[k] = gather_points<Pack>(rows, stride, pack.node[First + k]);
  return points;
}

struct ClosestNodeFace {
  Vector3<Pack> offset;         ///< node minus the point of these weights
  std::array<Pack, 4> weights;  ///< of the corners
  Pack squared_distance;        ///< to the closest point
};

/// Nodes and faces: what the passes ask of a kind of pairs.
struct NodesAndFaces {
  using Pairs = PackOfPairs<1, 4>;
  using Points = PackOfPoints<1, 4>;
  using Closest = ClosestNodeFace;
  const SurfaceFeatures& features;
  const FeatureMotion& motion;
  PairList& list;

  const PathAndAhead& first_ways() const { return motion.of_node; }
  const PathAndAhead& second_ways() const { return motion.of_face; }
  const std::vector<double>& first_radii() const { return features.node_radius; }
  const std::vector<double>& second_radii() const { return features.face_radius; }
  static std::array<int, 1> first_nodes(int node) { return {node}; }
  const std::array<int, 4>& second_nodes(int face) const { return features.face_node[index(face)]; }
  /// Of the hull of the face, or among neighbours of one piece of its two triangles (hull_point.hpp). A face
  /// that bends by a tenth of a skin counts as flat, so that weights do not leap as what rests on it quivers.
  BRIO_INLINE Closest closest(const Points& at, bool as_hull) const {
    const std::array<Vector3<Pack>, 4>& v = at.second;
    if (as_hull) {
      const ClosestOnHull<Pack> found = closest_on_hull<Pack>(at.first[0], v, Pack(0.1 * features.skin));
      Vector3<Pack> offset = found.weights[0] * (at.first[0] - v[0]);
      for (std::size_t k = 1; k < 4; ++k) offset = offset + found.weights[k] * (at.first[0] - v[k]);
      return {offset, found.weights, found.squared_distance};
    }
    const ClosestOnTriangle<Pack> p = closest_on_triangle(at.first[0], v[0], v[1], v[2]);
    const ClosestOnTriangle<Pack> q = closest_on_triangle(at.first[0], v[0], v[2], v[3]);
    const MaskOf<Pack> is_triangle = (v[2].x == v[3].x) & (v[2].y == v[3].y) & (v[2].z == v[3].z);
    const MaskOf<Pack> is_q = (!is_triangle) & (q.squared_distance < p.squared_distance);
    const Pack zero(0.0);
    return {where<Pack>(is_q, q.offset, p.offset),
            {where(is_q, q.weights[0], p.weights[0]), where(is_q, zero, p.weights[1]),
             where(is_q, q.weights[1], p.weights[2]), where(is_q, q.weights[2], zero)},
            where(is_q, q.squared_distance, p.squared_distance)};
  }
  BRIO_INLINE Pack path_at_end(const Pairs&, const Points&, const Closest&) const { return Pack(0.0); }
};

/// Edges and edges.
struct EdgesAndEdges {
  using Pairs = PackOfPairs<2, 2>;
  using Points = PackOfPoints<2, 2>;
  using Closest = ClosestOnSegments<Pack>;
  const SurfaceFeatures& features;
  const FeatureMotion& motion;
  PairList& list;

  const PathAndAhead& first_ways() const { return motion.of_edge; }
  const PathAndAhead& second_ways() const { return motion.of_edge; }
  const std::vector<double>& first_radii() const { return features.edge_radius; }
  const std::vector<double>& second_radii() const { return features.edge_radius; }
  const std::array<int, 2>& first_nodes(int edge) const { return features.edge_node[index(edge)]; }
  const std::array<int, 2>& second_nodes(int edge) const { return first_nodes(edge); }
  BRIO_INLINE Closest closest(const Points& at, bool /*as_hull*/) const {
    return closest_on_segments(at.first[0], at.first[1], at.second[0], at.second[1]);
  }
  /// Sum of both paths for which sides of faces that are closest at an end stay so: there a node keeps the
  /// distance. At an end x of one edge with direction u out of it, and y the closest point of the other, that
  /// is so while (x - y) . u is positive. A path s changes it by no more than 2 s, as closest points of
  /// segments move no more than what they are closest to, and by |x - y| 2 s / length as u turns.
  BRIO_INLINE Pack path_at_end(const Pairs& pack, const Points& at, const Closest& closest) const {
    const Pack distance = sqrt(closest.squared_distance);
    const auto path = [&](const auto& edge, Pack where_on, Pack sign) {
      const Vector3<Pack> along = edge[1] - edge[0];
      const Pack inverse = sqrt(inverse_or_zero(dot(along, along)));
      const Pack slope = sign * inverse * dot(closest.offset, along);
      const Pack outward =
          where(where_on <= Pack(0.0), slope, where(where_on >= Pack(1.0), -slope, Pack(0.0)));
      return outward / (Pack(2.0) + Pack(2.0) * inverse * distance);
    };
    const Pack longest =
        max(path(at.first, closest.on_a, Pack(1.0)), path(at.second, closest.on_b, Pack(-1.0)));
    const Pack resolution(1e-9 * features.smallest_edge);
    Pack sure = max(longest - resolution, Pack(0.0));
    if (!features.all_of_faces)
      for (int lane = 0; lane < pack_size; ++lane)
        if (!features.edge[index(pack.a[lane])].of_face() || !features.edge[index(pack.b[lane])].of_face())
          sure.set(lane, 0);
    return sure;
  }
};

/// The pairs at places begin to end of a list, at most eight.
template <class Kind>
BRIO_INLINE typename Kind::Pairs pack_of(const Kind& kind, const int* pairs, std::size_t begin,
                                         std::size_t end) {
  typename Kind::Pairs pack;
  for (std::size_t lane = 0; lane < pack_size; ++lane) {
    const int pair = pairs[begin + lane < end ? begin + lane : end - 1];
    pack.pair[lane] = pair;
    pack.a[lane] = kind.list.first(index(pair));
    pack.b[lane] = kind.list.second(index(pair));
    const auto& first = kind.first_nodes(pack.a[lane]);
    const auto& second = kind.second_nodes(pack.b[lane]);
    for (std::size_t k = 0; k < first.size(); ++k) pack.node[k][lane] = first[k];
    for (std::size_t k = 0; k < second.size(); ++k) pack.node[first.size() + k][lane] = second[k];
  }
  pack.count = static_cast<int>(std::min<std::size_t>(pack_size, end - begin));
  return pack;
}

template <class Pairs>
BRIO_INLINE MaskOf<Pack> have_spacing(Spacing spacing, const PairList& list, const Pairs& pack) {
  const auto lane = [&](std::size_t l) -> std::int64_t {
    return list.spacing(index(pack.pair[l])) == spacing ? -1 : 0;
  };
  return {wide_of<std::int64_t>(lane(0), lane(1), lane(2), lane(3), lane(4), lane(5), lane(6), lane(7))};
}
/// What is known of the pairs besides their points.
struct PackOfWays {
  Pack radii;
  MaskOf<Pack> waits;
  Pack reach;  ///< distance at which they touch
  Pack path;   ///< sum of both features and their groups' relation
};

template <class Kind>
BRIO_INLINE Pack radii_of(const Kind& kind, const typename Kind::Pairs& pack) {
  return gather_numbers(kind.first_radii().data(), pack.a) +
         gather_numbers(kind.second_radii().data(), pack.b);
}
template <class Kind>
BRIO_INLINE PackOfWays ways_of(const Kind& kind, const typename Kind::Pairs& pack) {
  PackOfWays ways;
  ways.radii = radii_of(kind, pack);
  ways.waits = have_spacing(Spacing::waiting, kind.list, pack);
  ways.reach = where(have_spacing(Spacing::radii, kind.list, pack), ways.radii, Pack(2 * kind.features.skin));
  const PathAndAhead &first = kind.first_ways(), &second = kind.second_ways();
  int relation[pack_size];
  for (std::size_t lane = 0; lane < pack_size; ++lane)
    relation[lane] = kind.list[index(pack.pair[lane])].relation;
  const PathAndAhead& frames = kind.motion.groups.relation;
  ways.path = gather_numbers(first.path.data(), pack.a) + gather_numbers(second.path.data(), pack.b) +
              gather_numbers(frames.path.data(), relation);
  return ways;
}

template <class Pairs>
BRIO_INLINE void store_directions(PairList& list, const Pairs& pack, unsigned lanes, const Vector3<Pack>& d) {
  for_lanes(lanes, [&](int lane) {
    const auto pair = index(pack.pair[lane]);
    list.set_direction(pair, d.x[lane], d.y[lane], d.z[lane]);
  });
}
template <class Pairs>
BRIO_INLINE void store_wakes(PairList& list, const Pairs& pack, unsigned lanes, Pack wake) {
  double* to = list.wake.data();
  if (lanes == first_lanes(pack_size)) {
    for (int lane = 0; lane < pack_size; ++lane) to[pack.pair[lane]] = wake[lane];
  } else {
    for_lanes(lanes, [&](int lane) { to[pack.pair[lane]] = wake[lane]; });
  }
}

/// One pair. What takes but a few operations on some points is done pair by pair: to put lanes together would
/// cost more.
template <class Kind>
struct OnePair {
  static constexpr std::size_t first_points = Kind::Pairs::first_points,
                               second_points = Kind::Pairs::second_points;
  using Points = PointsOfPair<double, first_points, second_points>;

  OnePair(const Kind& of, int number)
      : kind(of), pair(index(number)), record(kind.list[pair]), a(record.first), b(record.second) {}

  Points points(const double* rows) const {
    constexpr std::size_t stride = sizeof(NodeMotion64) / sizeof(double);
    const auto at = [&](int node) { return vector_at(rows + stride * index(node)); };
    const auto& first = kind.first_nodes(a);
    const auto& second = kind.second_nodes(b);
    Points points;
    for (std::size_t k = 0; k < first_points; ++k) points.first[k] = at(first[k]);
    for (std::size_t k = 0; k < second_points; ++k) points.second[k] = at(second[k]);
    return points;
  }
  double radii() const { return of_a(kind.first_radii()) + of_b(kind.second_radii()); }
  double path() const {
    return of_a(kind.first_ways().path) + of_b(kind.second_ways().path) + of_frames(frames().path);
  }
  double ahead() const {
    return of_a(kind.first_ways().ahead) + of_b(kind.second_ways().ahead) + of_frames(frames().ahead);
  }
  Vector3d direction() const {
    const auto& d = record.direction;
    return {d[0], d[1], d[2]};
  }

  const Kind& kind;
  std::size_t pair;
  const PairRecord& record;
  int a, b;  ///< the features

 private:
  const PathAndAhead& frames() const { return kind.motion.groups.relation; }
  double of_a(const std::vector<double>& all) const { return all[index(a)]; }
  double of_b(const std::vector<double>& all) const { return all[index(b)]; }
  double of_frames(const std::vector<double>& all) const { return all[index(record.relation)]; }
};

/// In a pass over a list of pairs, at place i: brings what later places read into the cache, since the
/// features of a pair and their nodes lie anywhere: records first, then the nodes of their features, then
/// positions.
template <class Kind>
BRIO_INLINE void prefetch_pairs(const Kind& kind, const int* pairs, std::size_t i, std::size_t end) {
  constexpr std::size_t to_nodes = 6, to_features = 12, to_records = 18;
  const auto record = [&](std::size_t place) -> const PairRecord& { return kind.list[index(pairs[place])]; };
  if (i + to_records < end) __builtin_prefetch(&record(i + to_records));
  if (i + to_features < end) {
    const PairRecord& pair = record(i + to_features);
    if constexpr (Kind::Pairs::first_points > 1) __builtin_prefetch(&kind.first_nodes(pair.first));
    __builtin_prefetch(&kind.second_nodes(pair.second));
    __builtin_prefetch(&kind.first_ways().path[index(pair.first)]);
    __builtin_prefetch(&kind.second_ways().path[index(pair.second)]);
  }
  if (i + to_nodes < end) {
    const PairRecord& pair = record(i + to_nodes);
    const auto fetch = [&](int node) { __builtin_prefetch(kind.motion.node.data() + index(node)); };
    for (int node : kind.first_nodes(pair.first)) fetch(node);
    for (int node : kind.second_nodes(pair.second)) fetch(node);
  }
}

/// Pairs that a pass takes at once: one task of a team of threads.
inline constexpr std::size_t pairs_a_range = 512;

/// Pairs of a range that go on to the next stage of a pass: those whose radii are kept apart and the others
/// apart, as their closest points are not of the same kind.
struct PairsOfRange {
  std::array<std::array<int, pairs_a_range>, 2> pair;
  std::array<std::size_t, 2> count{};

  void add(const PairList& list, int p) {
    const std::size_t kind = list.has_radii(index(p)) ? 1 : 0;
    pair[kind][count[kind]++] = p;
  }
};

}  // namespace brio
