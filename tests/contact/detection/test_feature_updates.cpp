// Features and pairs that follow deletions, against those collected and found anew.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "contact/features/flat_hull.hpp"
#include "contact/features/flatness.hpp"
#include "contact/geometry/closest_segments.hpp"
#include "contact/geometry/hull_point.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"

namespace brio::test {
namespace {

using EdgeName = std::tuple<int, int, EdgeKind>;

EdgeName name_of(const EdgeFeature& edge) { return {edge.node[0], edge.node[1], edge.kind}; }

auto content_of(const EdgeFeature& edge) {
  std::array<int, 2> face = edge.face;
  std::array<int, 4> wing = edge.wing;
  std::sort(face.begin(), face.end());
  std::sort(wing.begin(), wing.end());
  return std::tuple(face, wing, edge.part, edge.body, edge.round, edge.shell, edge.faces, edge.radius);
}

void expect_as_collected_anew(const ContactScene& scene) {
  const SurfaceFeatures& mended = scene.features;
  SurfaceFeatures anew = mended;
  collect(anew, scene.surface, scene.options);
  std::map<EdgeName, const EdgeFeature*> known;
  for (std::size_t e = 0; e < mended.edge.size(); ++e) {
    const EdgeFeature& edge = mended.edge[e];
    EXPECT_EQ(mended.edge_node[e], edge.node);
    EXPECT_EQ(mended.edge_radius[e], edge.radius);
    if (edge.alive()) {
      ASSERT_TRUE(known.try_emplace(name_of(edge), &edge).second) << "twice";
    }
  }
  ASSERT_EQ(known.size(), anew.edge.size());
  for (const EdgeFeature& edge : anew.edge) {
    ASSERT_EQ(known.count(name_of(edge)), 1U);
    ASSERT_EQ(content_of(*known.at(name_of(edge))), content_of(edge));
  }
  for (std::size_t f = 0; f < scene.surface.face.size(); ++f) {
    if (!scene.surface.face[f].alive()) continue;
    ASSERT_EQ(mended.face_node[f], anew.face_node[f]);
    ASSERT_EQ(mended.face_radius[f], anew.face_radius[f]);
    for (std::size_t k = 0; k < 4; ++k) {
      const int mine = mended.edge_of_face[f][k], other = anew.edge_of_face[f][k];
      ASSERT_EQ(mine < 0, other < 0);
      if (mine < 0) continue;
      ASSERT_EQ(name_of(mended.edge[index(mine)]), name_of(anew.edge[index(other)]));
    }
  }
  for (int s = 0; s < static_cast<int>(scene.surface.slaves()); ++s) {
    ASSERT_EQ(mended.node_radius[index(s)], anew.node_radius[index(s)]);
    const auto mine = mended.ring.of(s), other = anew.ring.of(s);
    ASSERT_TRUE(std::equal(mine.begin(), mine.end(), other.begin(), other.end())) << "ring of " << s;
  }
}

std::set<std::pair<int, int>> listed(const PairList& pairs) {
  std::set<std::pair<int, int>> found;
  for (const PairRecord& pair : pairs.records())
    if (pair.spacing != Spacing::none) found.insert({pair.first, pair.second});
  EXPECT_EQ(found.size(), pairs.size() - pairs.vacant()) << "no pair twice";
  return found;
}

// Where the nodes are now.
class Hidden {
 public:
  Hidden(const ContactScene& scene, const FeatureMotion& still) : features_(scene.features), still_(still) {}
  /// Whether one of the edges is a diagonal of a flat face, or a side at which two faces are flat that are
  /// not narrower than the other edge is long.
  bool operator()(int a, int b, bool radii) const { return hides(a, b, radii) || hides(b, a, radii); }

 private:
  bool hides(int flat, int other, bool radii) const {
    const EdgeFeature& edge = features_.edge[index(flat)];
    const auto is_flat = [&](const auto& corners) {
      double radius = HUGE_VAL;
      for (int f : edge.face)
        if (f >= 0) radius = std::min(radius, features_.face_radius[index(f)]);
      const double thickness = flat_thickness(features_, radius, radii ? Flatness::radii : Flatness::all);
      return flat_hull(corners).slack(thickness) > -1e-9 * features_.skin;
    };
    if (edge.is_diagonal()) {
      const std::array<int, 4>& corner = features_.face_node[index(edge.face[0])];
      return is_flat(std::array{at(corner[0]), at(corner[1]), at(corner[2]), at(corner[3])});
    }
    if (edge.kind != EdgeKind::side || edge.faces != 2) return false;
    std::array<Vector3d, 6> corners{at(edge.node[0]), at(edge.node[1])};
    double area = HUGE_VAL;
    for (std::size_t k = 0; k < 2; ++k) {
      std::size_t next = 2 + 2 * k;
      const std::array<int, 4>& corner = features_.face_node[index(edge.face[k])];
      for (int node : corner)
        if (node != edge.node[0] && node != edge.node[1] && next < 4 + 2 * k) corners[next++] = at(node);
      if (next == 3 + 2 * k) corners[next] = corners[next - 1];
      const Vector3d normal = cross(at(corner[2]) - at(corner[0]), at(corner[3]) - at(corner[1]));
      area = std::min(area, 0.5 * std::sqrt(dot(normal, normal)));
    }
    return is_flat(corners) && length(other) <= 1.05 * area / length(flat);
  }
  Vector3d at(int slave) const {
    const Vector3d x = still_.start(slave);
    return {x[0], x[1], x[2]};
  }
  double length(int e) const {
    const std::array<int, 2>& node = features_.edge_node[index(e)];
    return norm(still_.start(node[1]) - still_.start(node[0]));
  }

  const SurfaceFeatures& features_;
  const FeatureMotion& still_;
};

// What is near where the nodes are now is listed, but for what flat faces hide; nothing listed is dead.
void expect_no_pair_missing(const ContactScene& scene, const Nodes& nodes) {
  FeatureMotion still;
  FeaturePairs near;
  ThreadTeam team(1);
  still.predict(scene.features, scene.surface, nodes, 0, {}, team);
  ContactOptions options = scene.options;
  options.reach_buffer = 1e-6;
  const std::vector<double> no_depth(scene.surface.slaves(), 0);  // all whose boxes meet are paired
  near.find(scene.features, scene.surface, scene.excluded, options, still, team, {no_depth, true});
  const SurfaceFeatures& features = scene.features;
  const auto touches = [&](double squared_distance, double radii, bool spaced) {
    const double reach = (spaced ? radii : 2 * features.skin) + proximity_band * features.smallest_edge;
    return squared_distance < square((1 - 1e-9) * reach);
  };
  const auto all_nodes = listed(scene.pairs.node_face);
  for (const PairRecord& pair : near.node_face.records()) {
    const auto s = index(pair.first), f = index(pair.second);
    const std::array<int, 4>& corner = features.face_node[f];
    const bool spaced = pair.spacing == Spacing::radii;
    const HullPoint seen = closest_on_face(
        still.start(pair.first),
        {still.start(corner[0]), still.start(corner[1]), still.start(corner[2]), still.start(corner[3])},
        spaced);
    if (touches(seen.squared_distance, features.node_radius[s] + features.face_radius[f], spaced)) {
      EXPECT_EQ(all_nodes.count({pair.first, pair.second}), 1U);
    }
  }
  const auto all_edges = listed(scene.pairs.edge_edge);
  const Hidden hidden(scene, still);
  for (const PairRecord& pair : near.edge_edge.records()) {
    const bool radii = pair.spacing == Spacing::radii;
    if (hidden(pair.first, pair.second, radii)) continue;
    const auto segment = [&](int e) -> Segment {
      const std::array<int, 2>& node = features.edge_node[index(e)];
      return {still.start(node[0]), still.start(node[1])};
    };
    const ClosestSegments seen = closest_points_of_segments(segment(pair.first), segment(pair.second));
    const double both = features.edge_radius[index(pair.first)] + features.edge_radius[index(pair.second)];
    if (touches(seen.squared_distance, both, radii)) {
      EXPECT_EQ(all_edges.count({pair.first, pair.second}), 1U);
    }
  }
  for (const auto& [s, f] : all_nodes) {
    ASSERT_GE(scene.surface.node[index(s)], 0);
    ASSERT_TRUE(scene.surface.face[index(f)].alive());
  }
  for (const auto& [a, b] : all_edges) {
    ASSERT_TRUE(scene.features.edge[index(a)].alive());
    ASSERT_TRUE(scene.features.edge[index(b)].alive());
  }
}

// Elements of a block, of another that hits it, and of a sheet go in random order, one or many at once, until
// nothing is left but debris.
TEST(FeatureUpdates, AreAsCollectedAnewButForNumbers) {
  for (const double debris : {0.0, 0.01}) {
    for (const std::size_t at_once : {1U, 4U}) {
      SpringModel model;
      model.stiffness = 10;
      model.debris_radius = debris;
      model.add_box({4, 4, 3}, {0.8, 0.8, 0.6}, 1, shifted({0, 0, 0}));
      model.throw_from(model.add_box({3, 3, 2}, {0.6, 0.6, 0.4}, 1, shifted({0.13, 0.17, 0.65})),
                       {0.1, 0, -1});
      model.throw_from(model.add_sheet({4, 4}, {1, 1}, 0.05, 20, shifted({-0.1, -0.1, 1.15})), {0, 0.1, -2});
      ContactOptions options;
      model.start_erodible(options);
      std::vector<SurfaceElement> living;
      for (const auto& [part, count] : {std::pair(0, 48), std::pair(1, 18), std::pair(2, 16)})
        for (int e = 0; e < count; ++e) living.push_back({part, e});
      std::mt19937 random(11);
      std::shuffle(living.begin(), living.end(), random);
      std::size_t most_pairs = 0;
      const double dt = 2e-3;
      for (int i = 0; !living.empty(); ++i) {
        model.accelerate(dt);
        resolve(model.scene, model.nodes, dt, model.alone());
        ASSERT_NO_FATAL_FAILURE(expect_as_collected_anew(model.scene)) << "step " << i;
        ASSERT_NO_FATAL_FAILURE(expect_no_pair_missing(model.scene, model.nodes)) << "step " << i;
        most_pairs = std::max(most_pairs, model.scene.pairs.edge_edge.size());
        model.move(dt);
        if (i % 2 == 1) continue;
        const std::size_t count = std::min(at_once, living.size());
        model.erode(
            std::vector<SurfaceElement>(living.end() - static_cast<std::ptrdiff_t>(count), living.end()));
        living.resize(living.size() - count);
      }
      EXPECT_GT(most_pairs, 100U);
    }
  }
}

}  // namespace
}  // namespace brio::test
