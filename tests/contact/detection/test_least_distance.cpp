/// Pairs that end a step nearer than the least distance are hits, though they do not cross; those that begin
/// it nearer may lose a tenth of their distance.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "tests/contact/detection/reference_passes.hpp"

namespace brio {
namespace {

struct Approach {
  Vector3d offset;             ///< from the second feature to the first, at the start
  std::span<const int> first;  ///< slave nodes
};

/// A pair whose first feature is moved along its closest points.
class Pair {
 public:
  Pair(RandomScene& scene, const FeaturePairs& all, ThreadTeam& team)
      : scene_(scene), all_(all), team_(team) {}

  bool hits(PairKind kind, std::size_t pair, const Approach& approach, double left) {
    for (NodeRecord& node : scene_.nodes.record) std::fill_n(node.velocity, 3, 0.0);
    const Vector3d velocity = (left - 1) / scene_.dt * approach.offset;
    for (int slave : approach.first)
      std::copy_n(velocity.data(), 3, scene_.nodes.record[index(scene_.surface.node[index(slave)])].velocity);
    FeatureMotion motion;
    motion.predict(scene_.features, scene_.surface, scene_.nodes, scene_.dt, {}, team_);
    const CrossingCheck check(scene_.features, scene_.surface, scene_.options, all_, motion, {});
    return (kind == PairKind::node_face ? check.node_and_face(pair) : check.edge_and_edge(pair)).has_value();
  }

 private:
  RandomScene& scene_;
  const FeaturePairs& all_;
  ThreadTeam& team_;
};

// A quarter of the contact distance of solids, or 0.06 of that of pairs that keep their radii.
double distance_kept(const RandomScene& scene, Spacing spacing, double first, double second) {
  const double of_solids = 1e-3 * scene.features.smallest_edge;
  return spacing == Spacing::radii ? std::max(of_solids, 0.06 * (first + second)) : of_solids;
}

TEST(LeastDistance, IsKeptByEveryPair) {
  ThreadTeam team(1);
  Random random(5);
  std::map<std::pair<PairKind, Spacing>, int> judged;
  for (int s = 0; s < 30; ++s) {
    RandomScene scene({.sheets = 1, .cubes = 2, .beams = 0, .particles = 0}, random);
    const FeaturePairs all = all_pairs(scene, team);
    Pair one(scene, all, team);
    const auto judge = [&](PairKind kind, const PairList& list, std::size_t pair, const Approach& approach,
                           double floor) {
      const double distance = norm(approach.offset);
      if (distance < 1.2 * floor) return;
      EXPECT_TRUE(one.hits(kind, pair, approach, 0.98 * floor / distance)) << s << ' ' << pair;
      EXPECT_FALSE(one.hits(kind, pair, approach, 1.02 * floor / distance)) << s << ' ' << pair;
      ++judged[{kind, list.spacing(pair)}];
    };
    const auto start = [&](int slave) {
      return vector_at(scene.nodes.record[index(scene.surface.node[index(slave)])].position);
    };
    for (std::size_t i = 0; i < all.edge_edge.size(); i += 7) {
      const EdgeFeature &a = scene.features.edge[index(all.edge_edge.first(i))],
                        &b = scene.features.edge[index(all.edge_edge.second(i))];
      if (all.edge_edge.spacing(i) == Spacing::none) continue;
      const ClosestSegments closest = closest_points_of_segments({start(a.node[0]), start(a.node[1])},
                                                                 {start(b.node[0]), start(b.node[1])});
      judge(PairKind::edge_edge, all.edge_edge, i, {closest.offset, a.node},
            distance_kept(scene, all.edge_edge.spacing(i), a.radius, b.radius));
    }
    for (std::size_t i = 0; i < all.node_face.size(); i += 7) {
      if (all.node_face.spacing(i) == Spacing::none) continue;
      const std::array<int, 1> node{all.node_face.first(i)};
      const auto face = index(all.node_face.second(i));
      const std::array<int, 4>& corner = scene.features.face_node[face];
      const HullPoint closest = closest_on_face(
          start(node[0]), {start(corner[0]), start(corner[1]), start(corner[2]), start(corner[3])},
          all.node_face.has_radii(i));
      judge(PairKind::node_face, all.node_face, i, {closest.offset, node},
            distance_kept(scene, all.node_face.spacing(i), scene.features.node_radius[index(node[0])],
                          scene.features.face_radius[face]));
    }
  }
  for (const PairKind kind : {PairKind::node_face, PairKind::edge_edge})
    for (const Spacing spacing : {Spacing::skins, Spacing::radii})
      EXPECT_GT((judged[{kind, spacing}]), 100) << static_cast<int>(kind) << static_cast<int>(spacing);
}

TEST(LeastDistance, OfWhatIsNearerIsNineTenthsOfWhatItWas) {
  ThreadTeam team(1);
  Random random(6);
  RandomScene scene({.sheets = 0, .cubes = 2, .beams = 0, .particles = 0}, random);
  const FeaturePairs all = all_pairs(scene, team);
  const double floor = 1e-3 * scene.features.smallest_edge;
  int judged = 0;
  for (std::size_t i = 0; i < all.edge_edge.size(); ++i) {
    if (all.edge_edge.spacing(i) != Spacing::radii) continue;
    const EdgeFeature &a = scene.features.edge[index(all.edge_edge.first(i))],
                      &b = scene.features.edge[index(all.edge_edge.second(i))];
    RandomScene near = scene;
    const auto start = [&](int slave) {
      return vector_at(near.nodes.record[index(near.surface.node[index(slave)])].position);
    };
    const auto offset = [&] {
      return closest_points_of_segments({start(a.node[0]), start(a.node[1])},
                                        {start(b.node[0]), start(b.node[1])})
          .offset;
    };
    const Vector3d way = (0.5 * floor / norm(offset()) - 1) * offset();
    for (int slave : a.node)
      for (int axis = 0; axis < 3; ++axis)
        near.nodes.record[index(near.surface.node[index(slave)])].position[axis] += way[axis];
    Pair one(near, all, team);
    EXPECT_TRUE(one.hits(PairKind::edge_edge, i, {offset(), a.node}, 0.89)) << i;
    EXPECT_FALSE(one.hits(PairKind::edge_edge, i, {offset(), a.node}, 0.91)) << i;
    if (++judged == 40) break;
  }
  EXPECT_EQ(judged, 40);
}

}  // namespace
}  // namespace brio
