#include <gtest/gtest.h>

#include <cmath>

#include "contact/search/sorted_list_search.hpp"
#include "tests/contact/search/search_scenes.hpp"

namespace brio {
namespace {

// Comparisons as the paper estimates them: every body searched against every other, and all at once.
double comparisons_by_pairs(int bodies, int nodes_per_body) {
  const double both = 2.0 * nodes_per_body;
  return static_cast<double>(bodies) * bodies * both * std::log2(both);
}
double comparisons_of_global_search(int bodies, int nodes_per_body) {
  const double all = static_cast<double>(bodies) * nodes_per_body;
  return all * std::log2(all);
}

/// Heinstein et al. (1993), 'Multi-Body Impact': 19 bodies of about 50 slave nodes.
TEST(SortedListSearch, EstimatesTheComparisonsOfThePaper) {
  EXPECT_EQ(std::floor(comparisons_by_pairs(19, 50)), 239843);
  EXPECT_EQ(std::floor(comparisons_of_global_search(19, 50)), 9397);
}

std::uint64_t comparisons(const SearchScene& scene) {
  ThreadTeam team;
  SortedListSearch search;
  CandidatePairs pairs;
  SearchCounts counts;
  search.find(scene.points, scene.boxes, team, pairs, counts);
  return counts.comparisons;
}

/// The nodes of a surface of 4 x 4 x 4 elements less its edges' middles: about fifty nodes a body, bodies in
/// a row.
SearchScene bodies_in_a_row(int bodies) {
  SearchScene scene;
  for (int body = 0; body < bodies; ++body)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 4; ++k) {
          const bool inside = i % 3 != 0 && j % 3 != 0 && k % 3 != 0;
          if (!inside) scene.points.push_back({body * 3.2 + i, 1.0 * j, 1.0 * k});
        }
  for (const auto& point : scene.points) scene.boxes.push_back(SceneMaker::around(point, 0.6));
  return scene;
}

/// One box needs two binary searches an axis, each of at most log2(n) + 1 comparisons, and four for each node
/// of its slab.
TEST(SortedListSearch, BinarySearchesTakeLogarithmicallyManyComparisons) {
  SearchScene scene = SceneMaker(1).uniform_cloud(4096, 1);
  scene.boxes[0] = {{5, 5, 5}, {6, 6, 6}};  // behind all points: slabs are empty
  EXPECT_GE(comparisons(scene), 3u * 12u);
  EXPECT_LE(comparisons(scene), 6u * 13u);
}

/// All bodies searched at once, against body by body: the ratio the paper claims is 25.
TEST(SortedListSearch, TakesFewerComparisonsAtOnceThanBodyByBody) {
  const int bodies = 19;
  const SearchScene all = bodies_in_a_row(bodies);
  ASSERT_EQ(all.points.size(), 56u * bodies);
  std::uint64_t by_pairs = 0;
  const auto body = [&](int b, auto& list) {
    return std::vector(list.begin() + 56 * b, list.begin() + 56 * (b + 1));
  };
  for (int slave = 0; slave < bodies; ++slave)
    for (int master = 0; master < bodies; ++master)
      by_pairs +=
          comparisons({.name = "", .points = body(slave, all.points), .boxes = body(master, all.boxes)});
  const std::uint64_t at_once = comparisons(all);
  RecordProperty("comparisons_by_pairs", static_cast<int>(by_pairs));
  RecordProperty("comparisons_at_once", static_cast<int>(at_once));
  EXPECT_LT(5 * at_once, by_pairs);
}

TEST(SortedListSearch, ComparisonsGrowWithPointsAndBoxes) {
  std::uint64_t last = 0;
  for (int bodies : {1, 2, 4, 8, 16}) {
    const std::uint64_t now = comparisons(bodies_in_a_row(bodies));
    EXPECT_GT(now, 2 * last);
    last = now;
  }
}

}  // namespace
}  // namespace brio
