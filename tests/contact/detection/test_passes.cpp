/// The passes over pairs of features in lanes and threads: what they find is what a look at every listed pair
/// finds, what would touch is what the exact checks of every pair of the scene find, and inactive pairs are
/// not near.

#include <gtest/gtest.h>

#include <set>

#include "src/base/index.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/contact/detection/reference_passes.hpp"

namespace brio {
namespace {

/// What goes through the passes from step to step.
struct Detector {
  RandomScene& scene;
  ThreadTeam& team;
  FeatureMotion motion{};
  FeaturePairs pairs{};
  Proximity proximity{};
  CrossingGuard guard{};
  std::vector<Contact> contacts{};
  std::vector<Vector3d> corrected{};
  std::array<std::vector<int>, 2> active{};  ///< before constraints were found

  void begin() {
    motion.predict(scene.features, scene.surface, scene.nodes, scene.dt, {}, team);
    if (pairs.is_due(scene.features, scene.surface, motion, team)) search();
    select();
    active = {proximity.node_face, proximity.edge_edge};
    motion.set_limits(2, allowed_surplus(scene.features));
    find_proximities(proximity, scene.features, scene.surface, scene.excluded, scene.options, pairs, motion,
                     team, {}, contacts);
  }
  void select() {
    select_active(proximity, scene.features, scene.surface, scene.excluded, scene.options, pairs, motion,
                  team);
  }
  void search() { pairs.find(scene.features, scene.surface, scene.excluded, scene.options, motion, team); }

  // Nodes are pushed, as if by contact, one in ten of them beyond its limit.
  void solve(double speed, Random& random) {
    SlaveSet pushed(scene.surface.slaves());
    corrected.resize(scene.surface.slaves(), Vector3d{});
    for (std::size_t s = 0; s < scene.surface.slaves(); ++s) {
      if (random.coin()) continue;
      NodeRecord& node = scene.nodes.record[index(scene.surface.node[s])];
      const Vector3d change = random.vector(random.integer(0, 9) == 0 ? 8 * speed : 0.5 * speed);
      for (int axis = 0; axis < 3; ++axis)
        corrected[s][axis] = node.velocity[axis] = node.velocity[axis] + change[axis];
      pushed.insert(static_cast<int>(s));
    }
    motion.end_by_solution(scene.features, scene.surface, pushed, corrected, scene.dt, {}, team);
    if (pairs.is_due(scene.features, scene.surface, motion, team))
      search();
    else if (!motion.exceeds_limits())
      return;
    select();
  }
  void find() {
    find_hits(guard, proximity, scene.features, scene.surface, scene.options, pairs, motion, {}, team);
  }

  std::vector<Reference::Touch> touches() const {
    std::vector<Reference::Touch> touches;
    for (const Hit& hit : guard.hits) {
      const PairList& list = hit.kind == PairKind::node_face ? pairs.node_face : pairs.edge_edge;
      touches.emplace_back(hit.kind, list.first(hit.pair), list.second(hit.pair));
    }
    std::sort(touches.begin(), touches.end());
    return touches;
  }
};

#ifdef __SANITIZE_ADDRESS__
constexpr int scenes = 100;  // four minutes otherwise
#else
constexpr int scenes = 500;
#endif

TEST(Passes, FindWhatALookAtEveryPairFinds) {
  Random random(1);
  ThreadTeam team(2);
  std::size_t contacts = 0, of_edges = 0, touches = 0, asleep = 0, pairs = 0;
  for (int s = 0; s < scenes; ++s) {
    const int rounds = s % 2 * 2;  // half of the scenes are of faces alone
    RandomScene scene({.beams = rounds, .particles = rounds}, random);
    const double speed = random.power_of_ten(-2, 1);
    scene.push(speed, random);
    FeaturePairs all = all_pairs(scene, team);
    Detector detector{scene, team};
    for (int step = 0; step < 20; ++step) {
      detector.begin();
      const Reference reference(scene, all, detector.motion);
      // Constraints are of what is listed: pairs whose boxes meet.
      const std::vector<Contact> expected = Reference(scene, detector.pairs, detector.motion).contacts();
      ASSERT_EQ(detector.contacts.size(), expected.size()) << s << ' ' << step;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_TRUE(Reference::same(detector.contacts[i], expected[i])) << s << ' ' << step << ' ' << i;
        of_edges += expected[i].of_edges() ? 1 : 0;
      }
      contacts += expected.size();
      detector.solve(speed, random);
      detector.find();
      const auto wanted = reference.touches();
      ASSERT_EQ(detector.touches(), wanted) << s << ' ' << step;
      touches += wanted.size();
      pairs += detector.pairs.edge_edge.size();
      asleep += detector.pairs.edge_edge.size() - detector.proximity.edge_edge.size();
      scene.move(random);
      scene.push(speed, random);
    }
  }
  // All that is judged occurs.
  EXPECT_GT(contacts - of_edges, 10U * scenes);
  EXPECT_GT(of_edges, 1U * scenes);
  EXPECT_GT(touches, 4U * scenes);
  EXPECT_GT(asleep, pairs / 20);
}

TEST(Passes, SameBitsForAnyNumberOfThreads) {
  const auto run = [](int threads, auto&& visit) {
    Random random(2);
    ThreadTeam team(threads);
    RandomScene scene({.sheets = 6, .cells = 9, .cubes = 60, .beams = 40, .particles = 40, .room = 4},
                      random);
    scene.push(1, random);
    Detector detector{scene, team};
    for (int step = 0; step < 10; ++step) {
      detector.begin();
      detector.solve(1, random);
      detector.find();
      visit(step, detector);
      scene.move(random);
      scene.push(1, random);
    }
  };
  struct State {
    std::vector<Contact> contacts;
    std::vector<Hit> hits;
    PairList node_face, edge_edge;
  };
  std::vector<State> expected;
  run(1, [&](int, const Detector& d) {
    expected.push_back({d.contacts, d.guard.hits, d.pairs.node_face, d.pairs.edge_edge});
    EXPECT_GT(d.proximity.edge_edge.size(), 5000U) << "many ranges";
  });
  const auto compare = [](const PairList& a, const PairList& b) {
    EXPECT_EQ(a.records(), b.records());
    EXPECT_EQ(a.wake, b.wake);
  };
  for (int threads : {2, 3, 8})
    run(threads, [&](int step, const Detector& d) {
      const State& state = expected[index(step)];
      ASSERT_EQ(d.contacts.size(), state.contacts.size());
      for (std::size_t i = 0; i < d.contacts.size(); ++i)
        EXPECT_TRUE(Reference::same(d.contacts[i], state.contacts[i]));
      ASSERT_EQ(d.guard.hits.size(), state.hits.size());
      for (std::size_t i = 0; i < d.guard.hits.size(); ++i) {
        EXPECT_EQ(d.guard.hits[i].pair, state.hits[i].pair);
        EXPECT_TRUE(same_bits(d.guard.hits[i].time, state.hits[i].time));
        EXPECT_TRUE(Reference::same(d.guard.hits[i].at_start, state.hits[i].at_start));
      }
      compare(d.pairs.node_face, state.node_face);
      compare(d.pairs.edge_edge, state.edge_edge);
    });
}

TEST(Passes, AllocateNothingForWhatTheyHaveSeen) {
  Random random(4);
  ThreadTeam team(2);
  RandomScene scene({.sheets = 6, .cells = 9, .cubes = 60, .beams = 40, .particles = 40, .room = 4}, random);
  scene.push(1, random);
  Detector detector{scene, team};
  FeatureMotion first;
  const auto step = [&] {  // the same one
    if (first.restarts() > 0) detector.motion = first;
    detector.motion.predict(scene.features, scene.surface, scene.nodes, scene.dt, {}, team);
    detector.select();
    find_proximities(detector.proximity, scene.features, scene.surface, scene.excluded, scene.options,
                     detector.pairs, detector.motion, team, {}, detector.contacts);
    detector.find();
  };
  detector.begin();
  first = detector.motion;
  step();
  step();
  const std::size_t contacts = detector.contacts.size(), hits = detector.guard.hits.size();
  EXPECT_GT(contacts, 50U);
  EXPECT_GT(hits, 50U);
  const AllocationCount count;
  step();
  EXPECT_EQ(count.count(), 0U);
  EXPECT_EQ(detector.contacts.size(), contacts);
  EXPECT_EQ(detector.guard.hits.size(), hits);
}

// Paths of edges are followed for those in pairs alone, from the step on in which they are paired.
TEST(Passes, EveryPairedEdgeIsSeenToGoAsFarAsItsNodes) {
  Random random(11);
  ThreadTeam team(2);
  RandomScene scene({.sheets = 4, .cells = 9, .cubes = 60, .beams = 20, .particles = 20, .room = 3}, random);
  Detector detector{scene, team};
  std::size_t seen = 0;
  for (int step = 0; step < 100; ++step) {
    scene.push(random.integer(0, 19) == 0 ? 2 : 0.1, random);
    detector.begin();
    const FeatureMotion& motion = detector.motion;
    for (const PairRecord& pair : detector.pairs.edge_edge.records()) {
      if (pair.spacing == Spacing::none) continue;
      for (int e : {pair.first, pair.second}) {
        const std::array<int, 2>& nodes = scene.features.edge_node[index(e)];
        const auto& frame = motion.groups.group[index(motion.groups.of_node(nodes[0]))].step;
        double longest = 0;
        for (int node : nodes) longest = std::max(longest, norm(motion.displacement(node) - frame));
        ASSERT_GE((motion.of_edge.ahead[index(e)] - motion.of_edge.path[index(e)]) * (1 + 1e-12),
                  approach_factor * longest)
            << step << ' ' << e;
        ++seen;
      }
    }
    scene.move(random);
  }
  EXPECT_GT(seen, 10000U);
}

// Pairs that are active but are not checked for crossings are farther apart than the limits of motion allow
// them to come nearer.
TEST(Passes, WhatIsNotCheckedCannotCrossWithinTheLimits) {
  Random random(7);
  ThreadTeam team(2);
  std::size_t dropped = 0, checked = 0;
  RandomScene scene({.sheets = 4, .cells = 9, .cubes = 60, .beams = 20, .particles = 20, .room = 3}, random);
  Detector detector{scene, team};
  for (int step = 0; step < 200; ++step) {
    scene.push(random.integer(0, 19) == 0 ? 2 : 0.1, random);
    detector.begin();
    const Reference reference(scene, detector.pairs, detector.motion);
    const auto judge = [&](const PairList& list, const std::vector<int>& before, const std::vector<int>& kept,
                           const PathAndAhead& first, const PathAndAhead& second, const auto& distance) {
      ASSERT_TRUE(std::is_sorted(kept.begin(), kept.end()));
      ASSERT_TRUE(std::includes(before.begin(), before.end(), kept.begin(), kept.end()));
      checked += kept.size();
      const auto way = [](const PathAndAhead& ways, int i) {
        return ways.ahead[index(i)] - ways.path[index(i)];
      };
      for (int i : before) {
        if (std::binary_search(kept.begin(), kept.end(), i)) continue;
        ++dropped;
        const PairRecord& pair = list[index(i)];
        const double approach = way(first, pair.first) + way(second, pair.second) +
                                way(detector.motion.groups.relation, pair.relation);
        ASSERT_GT(distance(index(i)), approach + 2 * allowed_surplus(scene.features)) << step << ' ' << i;
      }
    };
    const FeatureMotion& motion = detector.motion;
    const Proximity& proximity = detector.proximity;
    judge(detector.pairs.node_face, detector.active[0], proximity.node_face, motion.of_node, motion.of_face,
          [&](std::size_t i) { return reference.node_face_distance(i); });
    judge(detector.pairs.edge_edge, detector.active[1], proximity.edge_edge, motion.of_edge, motion.of_edge,
          [&](std::size_t i) { return reference.edge_edge_distance(i); });
    if (HasFatalFailure()) return;
    scene.move(random);
  }
  EXPECT_GT(dropped, 1000U);
  EXPECT_GT(checked, 1000U);
}

// Of all pairs of features, those that are near are listed, but for diagonals of flat faces.
std::size_t expect_near_ones_are_listed(RandomScene& scene, const Detector& detector, ThreadTeam& team) {
  const FeaturePairs all = all_pairs(scene, team);
  const Reference reference(scene, all, detector.motion);
  const auto numbers = [](const PairList& list) {
    std::set<std::pair<int, int>> found;
    for (const PairRecord& pair : list.records())
      if (pair.spacing != Spacing::none) found.insert({pair.first, pair.second});
    return found;
  };
  const SurfaceFeatures& features = scene.features;
  std::size_t near = 0;
  const auto judge = [&](const PairList& list, const PairList& listed, const auto& distance,
                         const auto& radii, const auto& is_paired) {
    const std::set<std::pair<int, int>> known = numbers(listed);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const double reach = list.has_radii(i) ? radii(list[i]) : 2 * features.skin;
      if (distance(i) > reach + proximity_band * features.smallest_edge || !is_paired(list[i])) continue;
      ++near;
      EXPECT_EQ(known.count({list.first(i), list.second(i)}), 1U) << list.first(i) << ' ' << list.second(i);
    }
  };
  const auto of = [](const std::vector<double>& values, int i) { return values[index(i)]; };
  judge(
      all.node_face, detector.pairs.node_face, [&](std::size_t i) { return reference.node_face_distance(i); },
      [&](const PairRecord& p) {
        return of(features.node_radius, p.first) + of(features.face_radius, p.second);
      },
      [](const PairRecord&) { return true; });
  judge(
      all.edge_edge, detector.pairs.edge_edge, [&](std::size_t i) { return reference.edge_edge_distance(i); },
      [&](const PairRecord& p) {
        return of(features.edge_radius, p.first) + of(features.edge_radius, p.second);
      },
      [&](const PairRecord& p) {
        const bool radii = p.spacing == Spacing::radii;
        return detector.pairs.flatness().pairs(features, p.first, p.second, radii);
      });
  return near;
}

// Nodes walk at random, now and then one of them far.
TEST(Passes, WhatSleepsIsNotNear) {
  Random random(3);
  ThreadTeam team(1);
  std::size_t asleep = 0, asleep_at_ends = 0, looked_at = 0, near = 0;
  for (int walk = 0; walk < 5; ++walk) {
    RandomScene scene({.room = 2.5}, random);
    Detector detector{scene, team};
    for (int step = 0; step < 1000; ++step) {
      scene.push(random.integer(0, 99) == 0 ? 3 : 0.1, random);
      detector.begin();
      const Reference reference(scene, detector.pairs, detector.motion);
      const auto judge = [&](const PairList& list, const std::vector<int>& active, const auto& distance,
                             const auto& reach, const auto& at_end) {
        auto next = active.begin();
        for (std::size_t i = 0; i < list.size(); ++i) {
          if (next != active.end() && *next == static_cast<int>(i)) {
            ++next;
            ++looked_at;
          } else if (list.spacing(i) != Spacing::none) {
            ++asleep;
            const bool is_near = distance(i) <= reach(i) + proximity_band * scene.features.smallest_edge;
            ASSERT_TRUE(!is_near || at_end(i)) << walk << ' ' << step << ' ' << i;
            asleep_at_ends += is_near ? 1 : 0;
          }
        }
        ASSERT_EQ(next, active.end());
      };
      const double skins = 2 * scene.features.skin;
      const auto& nf = detector.pairs.node_face;
      const auto& ee = detector.pairs.edge_edge;
      judge(
          nf, detector.proximity.node_face, [&](std::size_t i) { return reference.node_face_distance(i); },
          [&](std::size_t i) {
            return !nf.has_radii(i) ? skins
                                    : scene.features.node_radius[index(nf.first(i))] +
                                          scene.features.face_radius[index(nf.second(i))];
          },
          [](std::size_t) { return false; });
      judge(
          ee, detector.proximity.edge_edge, [&](std::size_t i) { return reference.edge_edge_distance(i); },
          [&](std::size_t i) {
            return !ee.has_radii(i) ? skins
                                    : scene.features.edge[index(ee.first(i))].radius +
                                          scene.features.edge[index(ee.second(i))].radius;
          },
          // Of faces and closest at an end: a node keeps the distance there.
          [&](std::size_t i) { return reference.closest_at_an_end(i); });
      if (step % 3 == 0) near += expect_near_ones_are_listed(scene, detector, team);
      if (HasFailure()) return;
      scene.move(random);
    }
  }
  EXPECT_GT(near, 1000U);
  EXPECT_GT(asleep, looked_at);
  EXPECT_GT(asleep_at_ends, 100U);
  EXPECT_GT(looked_at, 10000U);
}

}  // namespace
}  // namespace brio
