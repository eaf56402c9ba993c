#include <gtest/gtest.h>

#include <algorithm>

#include "contact/search/global_search.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/contact/search/search_by_brute_force.hpp"
#include "tests/contact/search/search_scenes.hpp"

namespace brio {
namespace {

template <class Strategy>
class EveryStrategy : public ::testing::Test {
 protected:
  void find(const SearchScene& scene, int threads = 1) {
    ThreadTeam team(threads);
    search.find(scene.points, scene.boxes, team, pairs, counts);
  }

  Strategy search;
  CandidatePairs pairs;
  SearchCounts counts;
};
using Strategies = ::testing::Types<SortedListSearch, TreeSearch, GlobalSearch>;
TYPED_TEST_SUITE(EveryStrategy, Strategies);

TYPED_TEST(EveryStrategy, FindsThePairsOfBruteForce) {
  for (unsigned seed : {1u, 2u, 3u})
    for (const SearchScene& scene : SceneMaker(seed).all()) {
      const CandidatePairs expected = search_by_brute_force(scene.points, scene.boxes);
      ASSERT_GT(expected.size(), 0u) << scene.name;
      this->find(scene);
      EXPECT_EQ(this->pairs.first, expected.first) << scene.name;
      EXPECT_EQ(this->pairs.node, expected.node) << scene.name;
    }
}

TYPED_TEST(EveryStrategy, FindsNodesThatMayBeAnywhereInABox) {
  for (unsigned seed : {11u, 12u})
    for (const SearchScene& scene : SceneMaker(seed).all()) {
      // The boxes of a scene of the same kind stand for the nodes; some are infinite, inverted or not
      // numbers.
      const std::vector<CaptureBox> nodes(scene.boxes.rbegin(), scene.boxes.rend());
      const CandidatePairs expected = search_by_brute_force(nodes, scene.boxes);
      ASSERT_GT(expected.size(), 0u) << scene.name;
      ThreadTeam team;
      this->search.find(nodes, scene.boxes, team, this->pairs, this->counts);
      EXPECT_EQ(this->pairs.first, expected.first) << scene.name;
      EXPECT_EQ(this->pairs.node, expected.node) << scene.name;
    }
}

TYPED_TEST(EveryStrategy, FindsTheSameWithTheSameWorkForAnyNumberOfThreads) {
  const SearchScene scene =
      SceneMaker(4).uniform_cloud(20000, 9000);  // enough for several tasks of each kind
  this->find(scene);
  const CandidatePairs one_thread = this->pairs;
  for (int threads : {2, 3, 8}) {
    SearchCounts work;
    ThreadTeam team(threads);
    this->search.find(scene.points, scene.boxes, team, this->pairs, work);
    EXPECT_EQ(this->pairs.first, one_thread.first);
    EXPECT_EQ(this->pairs.node, one_thread.node);
    EXPECT_EQ(work.comparisons, this->counts.comparisons);
  }
}

TYPED_TEST(EveryStrategy, TakesNothingAndSingles) {
  const Vector3d point{1, 2, 3};
  const CaptureBox box = SceneMaker::around(point, 0);
  this->find({.name = "nothing", .points = {}, .boxes = {}});
  EXPECT_EQ(this->pairs.first, std::vector<int>{0});
  EXPECT_EQ(this->pairs.size(), 0u);
  this->find({.name = "no points", .points = {}, .boxes = {box, box}});
  EXPECT_EQ(this->pairs.first, (std::vector<int>{0, 0, 0}));
  this->find({.name = "no boxes", .points = {point}, .boxes = {}});
  EXPECT_EQ(this->pairs.first, std::vector<int>{0});
  this->find({.name = "one each", .points = {point}, .boxes = {box}});
  EXPECT_EQ(this->pairs.first, (std::vector<int>{0, 1}));
  EXPECT_EQ(this->pairs.node, std::vector<int>{0});
}

TYPED_TEST(EveryStrategy, ReusesItsMemoryForScenesThatShrinkAndGrow) {
  SceneMaker make(5);
  for (int points : {500, 20, 1000, 0, 700}) {
    const SearchScene scene = make.uniform_cloud(points, 300);
    this->find(scene);
    const CandidatePairs expected = search_by_brute_force(scene.points, scene.boxes);
    EXPECT_EQ(this->pairs.first, expected.first);
    EXPECT_EQ(this->pairs.node, expected.node);
  }
}

TYPED_TEST(EveryStrategy, AllocatesNothingAfterTheFirstSearch) {
  for (int threads : {1, 3}) {
    ThreadTeam team(threads);
    for (const SearchScene& scene : SceneMaker(6).all()) {
      this->search.find(scene.points, scene.boxes, team, this->pairs, this->counts);
      const AllocationCount allocations;
      this->search.find(scene.points, scene.boxes, team, this->pairs, this->counts);
      EXPECT_EQ(allocations.count(), 0u) << scene.name;
    }
  }
}

TYPED_TEST(EveryStrategy, CountsItsWork) {
  const SearchScene scene = SceneMaker(7).uniform_cloud(2000, 500);
  this->find(scene);
  const SearchCounts once = this->counts;
  EXPECT_EQ(once.searches, 1u);
  EXPECT_EQ(once.candidate_pairs, this->pairs.size());
  EXPECT_GT(once.comparisons, this->pairs.size());
  this->find(scene);
  EXPECT_EQ(this->counts.searches, 2u);
  EXPECT_EQ(this->counts.candidate_pairs, 2 * once.candidate_pairs);
  EXPECT_EQ(this->counts.comparisons, 2 * once.comparisons);
}

/// Moving one part of the scene away, however far, must not make the search dearer.
TYPED_TEST(EveryStrategy, WorkDoesNotDependOnTheExtentOfTheDomain) {
  const auto work = [&](double distance) {
    SearchScene scene = SceneMaker(8).uniform_cloud(4000, 4000);
    for (std::size_t i = 0; i < scene.points.size(); i += 2) scene.points[i].x += distance;
    for (std::size_t i = 0; i < scene.boxes.size(); i += 2) {
      scene.boxes[i].lower[0] += distance;
      scene.boxes[i].upper[0] += distance;
    }
    const std::uint64_t before = this->counts.comparisons;
    this->find(scene);
    return static_cast<double>(this->counts.comparisons - before);
  };
  const double near = work(4);
  for (double distance : {1e3, 1e6, 1e9}) EXPECT_LT(work(distance), 1.25 * near) << distance;
}

/// Slabs of a sheet folded in space hold many nodes; the tree does not care.
TEST(TreeSearch, WorkGrowsInProportionToThePoints) {
  const auto work_per_point = [](int points) {
    SceneMaker make(9);
    SearchScene scene;
    const double edge = std::cbrt(points);
    for (int i = 0; i < points; ++i) scene.points.push_back(make.in_cube(edge));
    for (int i = 0; i < points; ++i) scene.boxes.push_back(SceneMaker::around(make.in_cube(edge), 1));
    ThreadTeam team;
    TreeSearch search;
    CandidatePairs pairs;
    SearchCounts counts;
    search.find(scene.points, scene.boxes, team, pairs, counts);
    return static_cast<double>(counts.comparisons) / points;
  };
  EXPECT_LT(work_per_point(64000), 1.3 * work_per_point(8000));
}

TEST(GlobalSearch, PicksTheStrategyByName) {
  const SearchScene scene = SceneMaker(10).uniform_cloud(1000, 200);
  const auto comparisons = [&](auto search) {
    ThreadTeam team;
    CandidatePairs pairs;
    SearchCounts counts;
    search.find(scene.points, scene.boxes, team, pairs, counts);
    return counts.comparisons;
  };
  EXPECT_EQ(comparisons(GlobalSearch(SearchStrategy::sorted_lists)), comparisons(SortedListSearch()));
  EXPECT_EQ(comparisons(GlobalSearch(SearchStrategy::tree)), comparisons(TreeSearch()));
  EXPECT_NE(comparisons(SortedListSearch()), comparisons(TreeSearch()));
}

}  // namespace
}  // namespace brio
