#include "contact/start/sided_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <set>
#include <tuple>

#include "contact/start/sided_look.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Closest points that are this much farther than the closest, over the smallest edge, are as close.
constexpr double equally_near = 1e-6;
/// From where a node that has come out looks back, over the smallest edge.
constexpr double outside_share = 1e-2;
constexpr int most_doublings = 40;

/// Nodes against faces.
class SidedNodePairs {
 public:
  SidedNodePairs(const SidedLook& look, const FeaturePairs& pairs, double band, std::vector<SidedPair>& found)
      : look_(look),
        features_(look.features),
        surface_(look.surface),
        list_(pairs.node_face),
        band_(band),
        found_(found),
        coincident_(coincident_share * look.features.smallest_edge) {}

  void run() {
    struct OfNode {
      int node, body;
      bool shell;
      int face, pair;
      auto operator<=>(const OfNode&) const = default;
    };
    std::vector<OfNode> order;
    order.reserve(list_.size());
    for (std::size_t p = 0; p < list_.size(); ++p) {
      const int f = list_.second(p);
      order.push_back({list_.first(p), face(f).body, face(f).shell, f, static_cast<int>(p)});
    }
    std::sort(order.begin(), order.end());
    const auto is_same_group = [](const OfNode& a, const OfNode& b) {
      return a.node == b.node && a.body == b.body && a.shell == b.shell;
    };
    std::vector<int> group;
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      group.clear();
      for (; end < order.size() && is_same_group(order[begin], order[end]); ++end)
        group.push_back(order[end].pair);
      look_at(group);
    }
  }

 private:
  const Face& face(int f) const { return surface_.face[index(f)]; }
  int face_of(int pair) const { return list_.second(index(pair)); }

  // Pairs of one node with faces of one body, of solids or of shells.
  void look_at(std::span<const int> group) {
    const int s = list_.first(index(group.front()));
    const Face& any = face(face_of(group.front()));
    const Vector3d x = look_.at(s);
    if (any.shell || any.body == surface_.body[index(s)]) {
      for (int pair : group) look_by_distance(pair, s, x);
      return;
    }
    struct Near {
      int pair;
      ClosestPoint point;
    };
    std::vector<Near> near;
    double least = infinity;
    for (int pair : group) {
      const Face& other = face(face_of(pair));
      if (look_.surely_farther(s, other, 0.5 * (look_.depth.of(s) + look_.depth.of(surface_, other))))
        continue;
      near.push_back({pair, closest_point_on_quad(x, look_.corners(face(face_of(pair))))});
      least = std::min(least, near.back().point.squared_distance);
    }
    if (near.empty()) return;
    const double depth = std::sqrt(least);
    const auto closest = std::find_if(near.begin(), near.end(),
                                      [&](const Near& one) { return one.point.squared_distance == least; });
    const bool coincides = depth <= coincident_;
    if (!coincides && is_outside(surface_, look_.nodes, face_of(closest->pair), closest->point)) {
      for (const Near& one : near) look_by_distance(one.pair, s, x);
      return;
    }
    Directions out;
    for (const Near& one : near) {
      if (std::sqrt(one.point.squared_distance) > depth + equally_near * features_.smallest_edge) continue;
      if (!coincides) {
        out.add(-normalized(one.point.separation));
      } else if (look_.is_before(s, one.point.normal)) {
        out.add(one.point.normal);
      }
    }
    Vector3d way = out.mean();
    if (is_zero(way) && coincides) way = between_surfaces(s, face_of(closest->pair), closest->point);
    if (is_zero(way)) return;
    for (const Near& one : near) look_from_outside(one.pair, s, x, way, coincides ? 0 : depth);
  }

  // Where the surfaces lie in each other's curves: the mean of both normals.
  Vector3d between_surfaces(int s, int f, const ClosestPoint& point) const {
    const Vector3d theirs = pseudo_normal(surface_, look_.nodes, f, point);
    const Vector3d own = vertex_normal(surface_, look_.nodes, s);
    const Vector3d way = unit_or(theirs - own, Vector3d{});
    return dot(way, theirs) > 0.3 ? way : Vector3d{};
  }

  void look_from_outside(int pair, int s, const Vector3d& x, const Vector3d& way, double depth) {
    const int f = face_of(pair);
    const FaceVertices at = look_.corners(face(f));
    double beyond = depth + outside_share * features_.smallest_edge;
    for (int doubling = 0; doubling < most_doublings; ++doubling, beyond *= 2) {
      const HullPoint seen = closest_on_face(x + beyond * way, at, is_spaced(pair));
      if (!(seen.squared_distance > 0)) continue;
      const Vector3d normal = normalized(seen.offset);
      const Vector3d foot = x + beyond * way - seen.offset;
      add(pair, s, seen, foot, normal, dot(normal, x - foot), false);
      return;
    }
  }

  void look_by_distance(int pair, int s, const Vector3d& x) {
    const int f = face_of(pair);
    const double reach = reach_of(pair, s, f);
    if (look_.surely_farther(s, face(f), reach + band_)) return;
    const FaceVertices at = look_.corners(face(f));
    const HullPoint seen = closest_on_face(x, at, is_spaced(pair));
    const double distance = std::sqrt(seen.squared_distance);
    if (distance > reach + band_) return;
    const Vector3d across = cross(at[2] - at[0], at[3] - at[1]);
    const bool own = face(f).body == surface_.body[index(s)];
    if (distance <= coincident_) {
      const Vector3d way = look_.side_of(s, face(f), normalized(across));
      if (!is_zero(way)) look_from_outside(pair, s, x, way, 0);
      return;
    }
    // The inner side of the own body is no surface.
    if (own && !face(f).shell && dot(seen.offset, across) < 0) return;
    add(pair, s, seen, x - seen.offset, seen.offset / distance, distance, true);
  }

  bool is_spaced(int pair) const { return list_.has_radii(index(pair)); }
  double reach_of(int pair, int s, int f) const {
    return is_spaced(pair) ? features_.node_radius[index(s)] + features_.face_radius[index(f)]
                           : 2 * features_.skin;
  }

  void add(int pair, int s, const HullPoint& seen, const Vector3d& foot, const Vector3d& normal,
           double distance, bool is_apart) {
    const int f = face_of(pair);
    const double reach = reach_of(pair, s, f);
    if (distance - reach > band_) return;
    const Face& other = face(f);
    SidedPair one;
    if (!look_.is_minimum(f, seen.weights, foot, normal, one.support)) return;
    Contact& contact = one.contact;
    contact.slave = s;
    contact.face = f;
    contact.body = other.body;
    contact.node[0] = s;
    contact.weight[0] = 1;
    for (std::size_t k = 0; k < 4; ++k) {
      contact.node[k + 1] = surface_.slave(other.node[k]);
      contact.weight[k + 1] = -seen.weights[k];
    }
    contact.normal = normal;
    contact.gap = distance - reach;
    one.distance = distance;
    one.skin = is_spaced(pair) ? look_.skin_in(features_.node_radius[index(s)]) +
                                     look_.skin_in(features_.face_radius[index(f)])
                               : 2 * features_.skin;
    const double edge = shortest_edge(look_.nodes, other);
    one.scale = reach - one.skin > 0 ? std::min(edge, reach - one.skin) : edge;
    one.is_apart = is_apart;
    one.spaced = is_spaced(pair);
    one.feature = {s, f};
    one.part = {look_.part_of(s), other.part};
    found_.push_back(one);
  }

  const SidedLook& look_;
  const SurfaceFeatures& features_;
  const Surface& surface_;
  const PairList& list_;
  double band_;
  std::vector<SidedPair>& found_;
  double coincident_;
};

// In an order that depends on the surface alone; of pairs with the same closest points the nearest.
void keep_one_of_each(std::vector<SidedPair>& found, std::size_t begin) {
  const auto first = found.begin() + static_cast<std::ptrdiff_t>(begin);
  std::sort(first, found.end(), [](const SidedPair& a, const SidedPair& b) {
    return std::tuple(a.contact.slave, a.support, a.contact.gap, a.feature) <
           std::tuple(b.contact.slave, b.support, b.contact.gap, b.feature);
  });
  found.erase(std::unique(first, found.end(),
                          [](const SidedPair& a, const SidedPair& b) {
                            return a.contact.slave == b.contact.slave && a.support == b.support;
                          }),
              found.end());
}

// Overlaps of edges wait until nodes are out.
void leave_out_edges_beside_nodes(const Surface& surface, double coincident, std::vector<SidedPair>& found) {
  const auto bodies = [&](const SidedPair& pair) -> std::pair<int, int> {
    return std::minmax<int>(surface.body[index(pair.contact.node[0])], static_cast<int>(pair.contact.body));
  };
  std::set<std::pair<int, int>> waiting;
  for (const SidedPair& pair : found)
    if (pair.contact.face >= 0 && pair.distance < -coincident) waiting.insert(bodies(pair));
  std::erase_if(found, [&](const SidedPair& pair) {
    return pair.contact.face < 0 && pair.distance < -coincident && waiting.contains(bodies(pair));
  });
}

}  // namespace

void find_sided_pairs(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes,
                      const FeaturePairs& pairs, const SearchedDepth& depth, double band,
                      std::vector<SidedPair>& found) {
  found.clear();
  const SidedLook look(features, surface, nodes, depth);
  SidedNodePairs(look, pairs, band, found).run();
  keep_one_of_each(found, 0);
  const std::size_t edges = found.size();
  find_sided_edges(look, pairs, band, found);
  keep_one_of_each(found, edges);
  leave_out_edges_beside_nodes(surface, coincident_share * features.smallest_edge, found);
}

}  // namespace brio
