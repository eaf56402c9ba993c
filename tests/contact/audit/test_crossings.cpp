/// Scenes whose crossings are counted by hand, or by comparing everything with everything in exact
/// arithmetic.

#include <gtest/gtest.h>

#include <cmath>

#include "contact/ties/ties.hpp"
#include "src/base/index.hpp"
#include "tests/contact/audit/audit_scene.hpp"
#include "tests/contact/audit/exact_crossing.hpp"
#include "tests/contact/geometry/adversarial_queries.hpp"
#include "tests/rotation_about.hpp"

namespace brio::test {
namespace {

const Vector3d one{1, 1, 1};

Tensor<double> turned(double angle, const Vector3d& axis) { return rotation_about(angle, axis); }
const auto as_it_is = moved({0, 0, 0});

TEST(AuditCrossings, ApartOrTouchingThereIsNone) {
  AuditScene scene;
  scene.add_box({2, 2, 2}, one, as_it_is);
  scene.add_box({2, 2, 2}, one, moved({0.25, 0, 1}));         // on top, sides in one plane
  scene.add_box({2, 2, 2}, one, moved({1, 0, 0}));            // beside, every node on another
  scene.add_box({3, 3, 3}, one, moved({-1, -0.5, 1.0 / 3}));  // beside, nodes on faces
  scene.add_box({1, 1, 1}, one, moved({5, 0, 0}));
  scene.start();
  EXPECT_EQ(scene.found().missed(), 0);
}

// At places that have no short binary form, 1000 lengths away.
TEST(AuditCrossings, ATouchWithinRoundingIsNone) {
  const Tensor<double> turn = turned(0.7, {1, 2, 3});
  const auto placed = [&](const Vector3d& by) {
    return [by, turn](const Vector3d& x) -> Vector3d {
      return turn * (x + by) + Vector3d{1000.1, -700.3, 3.7};
    };
  };
  AuditScene scene;
  scene.add_box({2, 2, 2}, one, placed({0, 0, 0}));
  scene.add_box({2, 2, 2}, one, placed({0.25, 0, 1}));
  scene.add_box({2, 2, 2}, one, placed({1, 0, 0}));
  scene.start();
  EXPECT_EQ(scene.found().missed(), 0);
}

TEST(AuditCrossings, ACornerInAFaceIsThreePairs) {
  AuditScene scene;
  scene.add_box({1, 1, 1}, one, as_it_is);
  const Tensor<double> on_its_corner = rotation_about(std::acos(1 / std::sqrt(3.0)), cross(one, {0, 0, 1}));
  scene.add_box({1, 1, 1}, one, [&](const Vector3d& x) -> Vector3d {
    return on_its_corner * x + Vector3d{0.4, 0.45, 0.9};
  });
  scene.start();
  const Audit found = scene.found();
  EXPECT_EQ(found.crossings, 3) << "the sides of the corner with the top";
  EXPECT_EQ(found.deep_crossings, 0) << "0.1 deep, but for rounding";
  EXPECT_NEAR(found.deepest_crossing.depth, 0.1, 1e-12);
  EXPECT_EQ(found.deepest_crossing.node, 8);
  EXPECT_EQ(found.deepest_crossing.part, (std::array{1, 0}));
  EXPECT_EQ(found.swallowed, 0);
}

TEST(AuditCrossings, AnEdgeAcrossAFaceIsSixPairs) {
  AuditScene scene;
  scene.add_box({1, 1, 1}, one, as_it_is);
  const Tensor<double> on_its_edge = turned(std::numbers::pi / 4, {1, 0, 0});
  scene.add_box({1, 1, 1}, {3, 1, 1}, [&](const Vector3d& x) -> Vector3d {
    return on_its_edge * (x - Vector3d{1.1, 0, 0}) + Vector3d{0, 0.47, 0.8};
  });
  scene.start();
  const Audit found = scene.found();
  EXPECT_EQ(found.crossings, 6) << "both sides of the edge with the top and the two ends";
  EXPECT_EQ(found.deep_crossings, 6);
}

// Edges run in the planes of sides; nothing but diagonals passes through faces.
TEST(AuditCrossings, FindsWhatOnlyDiagonalsCross) {
  AuditScene scene;
  scene.add_box({1, 1, 1}, one, as_it_is);
  scene.add_box({1, 1, 1}, one, moved({0.3, 0, 0.875}));
  scene.start();
  EXPECT_EQ(scene.found().crossings, 2) << "an end of each with the top or bottom of the other";
  EXPECT_NEAR(scene.found().deepest_crossing.depth, 0.125, 1e-12);
}

// Equal cubes pushed into each other along an edge: nothing crosses anything in exact arithmetic.
TEST(AuditCrossings, FindsWhatLiesInAnotherWithoutACrossing) {
  AuditScene scene;
  scene.add_box({2, 2, 2}, one, as_it_is);
  scene.add_box({2, 2, 2}, one, moved({0, 0, 0.875}));
  scene.start();
  EXPECT_EQ(scene.found().crossings, 0);
  EXPECT_EQ(scene.found().swallowed, 1);
}

TEST(AuditCrossings, FindsBodiesThatAreSwallowed) {
  AuditScene scene;
  scene.add_box({3, 3, 3}, {3, 3, 3}, as_it_is);
  scene.add_box({1, 1, 1}, {0.5, 0.5, 0.5}, moved({1.2, 1.3, 1.1}));
  scene.add_box({1, 1, 1}, {0.5, 0.5, 0.5}, moved({3.2, 1.3, 1.1}));
  scene.add_sheet({1, 1}, {0.1, 0.1}, 1e-3, moved({0.4, 0.4, 0.4}));
  scene.add_beams({{2.5, 2.5, 2.5}, {2.6, 2.6, 2.6}}, 1e-3);
  scene.add_particles({{0.7, 2.3, 1.1}, {2.3, 0.7, 1.1}, {3.7, 0.7, 1.1}}, 1e-3);
  scene.start();
  const Audit found = scene.found();
  EXPECT_EQ(found.crossings, 0);
  EXPECT_EQ(found.swallowed, 5);
}

// In the hole of a solid nothing is swallowed.
TEST(AuditCrossings, AHoleIsOutside) {
  AuditScene scene;
  const auto ring = [](const Vector3d& x) -> Vector3d {
    return {(2 + x[0]) * std::cos(x[1]), (2 + x[0]) * std::sin(x[1]), x[2]};
  };
  scene.add_box({1, 24, 2}, {1, 6.2, 1}, ring);
  scene.add_box({1, 1, 1}, {0.5, 0.5, 0.5}, moved({-0.2, -0.3, 0.2}));
  scene.start();
  EXPECT_EQ(scene.found().missed(), 0);
  scene.place_all([&](const Vector3d& x) -> Vector3d {
    return std::hypot(x.x, x.y) < 1.5 ? 0.2 * x + Vector3d{2.51, 0.3, 0.4} : x;
  });
  EXPECT_EQ(scene.found().crossings, 0);
  EXPECT_EQ(scene.found().swallowed, 1) << "in the material";
}

TEST(AuditCrossings, CountsNothingBesideAFlakeTurnedInsideOut) {
  AuditScene scene;
  scene.add_box({1, 1, 1}, one, as_it_is);
  scene.add_box({1, 1, 1}, one, moved({0, 0, 1.3}));
  scene.start();
  for (int n = 0; n < 8; ++n) {
    const Vector3d x = scene.positions()[index(n)];
    scene.place(n, {x[0], x[1], 1 - x[2]});
  }
  EXPECT_EQ(scene.found().missed(), 0);
}

TEST(AuditCrossings, FindsAnElementThatIsInverted) {
  AuditScene scene;
  scene.add_box({1, 1, 1}, one, as_it_is);
  scene.start();
  EXPECT_EQ(scene.found().missed(), 0);
  scene.place(7, {0.4, 0.3, -0.5});  // the corner at (1, 1, 1): through the bottom
  EXPECT_EQ(scene.found().crossings, 3) << "the sides that meet in it, with the bottom";
}

// A strip bent to a loop whose ends pass through each other.
TEST(AuditCrossings, FindsAShellThatCrossesItself) {
  const auto bent = [](double turns) {
    return [turns](const Vector3d& x) -> Vector3d {
      const double angle = 2 * std::numbers::pi * turns * x[0];
      const double radius = 1 - 0.1 * x[0];
      return {radius * std::cos(angle), x[1] + 0.01 * x[0], radius * std::sin(angle)};
    };
  };
  AuditScene scene;
  scene.add_sheet({24, 3}, {1, 0.5}, 0.01, as_it_is);
  scene.start();
  const std::vector<Vector3d> flat = scene.positions();
  const auto place = [&](const AuditScene::Map& map) {
    for (int n = 0; n < scene.count(); ++n) scene.place(n, map(flat[index(n)]));
  };
  place(bent(0.9));
  EXPECT_EQ(scene.found().missed(), 0);
  place(bent(1.1));
  EXPECT_EQ(scene.found().missed(), 0) << "a spiral";
  place([&](const Vector3d& x) -> Vector3d {
    const Vector3d at = bent(1.1)(x);
    return x[0] > 0.95 ? Vector3d{1.3 * at[0], at[1], 1.3 * at[2]} : at;
  });
  EXPECT_EQ(scene.found().crossings, 5) << "a column of three faces with one that lies askew by a little";
}

TEST(AuditCrossings, FindsBeamsThroughShells) {
  AuditScene scene;
  scene.add_sheet({4, 4}, {4, 4}, 0.1, as_it_is);
  scene.add_beams({{0.3, 0.4, 2}, {0.3, 0.4, 1}, {0.6, 0.3, -1}}, 0.01);
  scene.add_beams({{2, 2, 1}, {2, 2, -1}}, 0.01);      // through a node
  scene.add_beams({{1.5, 1, 1}, {1.5, 1, -1}}, 0.01);  // through an edge
  scene.add_beams({{3.5, 4, 1}, {3.5, 4, -1}}, 0.01);  // on the rim: a touch of middle surfaces
  scene.add_beams({{3.5, 4.2, 1}, {3.5, 4.2, -1}}, 0.01);
  scene.start();
  EXPECT_EQ(scene.found().crossings, 1 + 4 + 2);
  EXPECT_EQ(scene.found().too_close, 4 + 1 + 1) << "edges of the node, the edge, the rim";
}

TEST(AuditCrossings, LeavesOutWhatNeverMeets) {
  const auto crossing = [](const std::function<void(AuditScene&)>& change) {
    AuditScene scene;
    scene.add_box({1, 1, 1}, one, as_it_is);
    scene.add_box({1, 1, 1}, {0.2, 0.3, 1}, moved({0.4, 0.35, 0.5}));
    scene.add_sheet({1, 1}, {3, 3}, 0.01, moved({-1, -1, 0.25}));
    change(scene);
    scene.start();
    return scene.found();
  };
  EXPECT_EQ(crossing([](AuditScene&) {}).crossings, 4 + 4);
  EXPECT_EQ(crossing([](AuditScene& s) { s.rules = {{.part = {0, 1}, .touch = false}}; }).crossings, 4);
  EXPECT_EQ(crossing([](AuditScene& s) { s.rules = {{.part = {2, 0}, .touch = false}}; }).crossings, 4);
  EXPECT_EQ(crossing([](AuditScene& s) {
              s.make_rigid(0, 0);
              s.make_rigid(1, 0);
            }).crossings,
            4);
  EXPECT_EQ(crossing([](AuditScene& s) {
              s.make_rigid(0, 0);
              s.make_rigid(1, 1);
            }).crossings,
            8);
  const Audit none = crossing([](AuditScene& s) {
    s.rules = {{.part = {0, 1}, .touch = false}, {.part = {2, 0}, .touch = false}};
  });
  EXPECT_EQ(none.missed(), 0) << "nor do they count as swallowed";
}

TEST(AuditCrossings, LeavesOutWhatATieHolds) {
  AuditScene scene;
  scene.add_box({1, 1, 1}, one, as_it_is);
  scene.add_box({1, 1, 1}, {0.2, 0.3, 1}, moved({0.4, 0.35, 0.98}));
  scene.start();
  EXPECT_EQ(scene.found().crossings, 4);
  Ties ties;
  for (int node = 8; node < 12; ++node) {
    TiedNode tied;
    tied.tie.node = node;
    tied.tie.corner = {4, 5, 7, 6};
    ties.node.push_back(tied);
  }
  number(ties, scene.nodes.size());
  exclude_tied_pairs(scene.scene, ties, {0});
  EXPECT_EQ(scene.found().missed(), 0);
}

// ---- everything with everything, exactly

bool intersect(const AuditScene& scene, const Face& own, const Face& other) {
  const auto x = [&](int node) { return scene.positions()[index(node)]; };
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < a; ++b) {
      if (own.node[a] == own.node[b] || other.has(own.node[a]) || other.has(own.node[b])) continue;
      const std::array segment{x(own.node[a]), x(own.node[b])};
      for (const auto& [p, q, r] : {std::array{0, 1, 2}, std::array{0, 2, 3}})
        if (judge_crossing(segment,
                           {x(other.node[index(p)]), x(other.node[index(q)]), x(other.node[index(r)])})
                .crosses({}))
          return true;
    }
  return false;
}

std::int64_t by_brute_force(const AuditScene& scene) {
  const std::vector<Face>& face = scene.scene.surface.face;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < face.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (intersect(scene, face[i], face[j]) || intersect(scene, face[j], face[i])) ++count;
  return count;
}

// Boxes and sheets thrown on a heap, every node then moved at random: crossings of all kinds, own ones too.
AuditScene heap(std::uint64_t seed) {
  Random random(seed);
  AuditScene scene;
  const auto anyhow = [&](int) {
    const Tensor<double> turn = turned(random.uniform(0, 6), random.vector(1));
    const Vector3d to = random.vector(1.2);
    return [turn, to](const Vector3d& x) -> Vector3d { return turn * x + to; };
  };
  for (int i = 0; i < 6; ++i) scene.add_box({2, 1, 2}, {0.8, 0.3, 0.5}, anyhow(i));
  for (int i = 0; i < 4; ++i) scene.add_sheet({3, 2}, {1.0, 0.7}, 0.02, anyhow(i));
  scene.start();
  const double shaken = 0.2 * static_cast<double>(seed % 3);
  for (int n = 0; n < scene.count(); ++n)
    scene.place(n, scene.positions()[index(n)] + random.vector(0.5 * shaken));
  return scene;
}

TEST(AuditCrossings, CountsTheSameAsBruteForceInExactArithmetic) {
  std::int64_t all = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const AuditScene scene = heap(seed);
    const std::int64_t known = by_brute_force(scene);
    EXPECT_EQ(scene.found().crossings, known) << seed;
    all += known;
  }
  EXPECT_GT(all, 150);
}

TEST(AuditCrossings, FindsTheSameWithAnyNumberOfThreads) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    AuditScene scene = heap(seed);
    const Audit one_thread = scene.found(1);
    for (int threads : {2, 3}) {
      const Audit found = scene.found(threads);
      EXPECT_EQ(found.crossings, one_thread.crossings);
      EXPECT_EQ(found.deep_crossings, one_thread.deep_crossings);
      EXPECT_EQ(found.too_close, one_thread.too_close);
      EXPECT_EQ(found.swallowed, one_thread.swallowed);
      EXPECT_EQ(found.deepest_crossing.depth, one_thread.deepest_crossing.depth);
      EXPECT_EQ(found.deepest_crossing.node, one_thread.deepest_crossing.node);
      EXPECT_EQ(found.deepest_too_close.node, one_thread.deepest_too_close.node);
    }
  }
}

}  // namespace
}  // namespace brio::test
