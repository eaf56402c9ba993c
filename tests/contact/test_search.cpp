#include <gtest/gtest.h>

#include <random>

#include "contact/global_search.hpp"
#include "tests/contact/search_by_brute_force.hpp"

namespace brio {
namespace {

template <class Strategy>
class EveryStrategy : public ::testing::Test {};
using Strategies = ::testing::Types<SortedListSearch, TreeSearch>;
TYPED_TEST_SUITE(EveryStrategy, Strategies);

TYPED_TEST(EveryStrategy, FindsThePairsOfBruteForce) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<Vector3<double>> points(500);
  for (auto& point : points) point = {coordinate(random), coordinate(random), coordinate(random)};
  std::vector<CaptureBox> boxes(300);
  for (auto& box : boxes)
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = coordinate(random);
      box.upper[axis] = box.lower[axis] + 0.5 * std::abs(coordinate(random));
    }
  const CandidatePairs expected = search_by_brute_force(points, boxes);
  ASSERT_GT(expected.size(), 0u);
  for (int threads : {1, 2, 3, 8}) {
    ThreadTeam team(threads);
    TypeParam search;
    CandidatePairs pairs;
    SearchCounts counts;
    search.find(points, boxes, team, pairs, counts);
    EXPECT_EQ(pairs.first, expected.first);
    EXPECT_EQ(pairs.node, expected.node);
    EXPECT_EQ(counts.candidate_pairs, expected.size());
    EXPECT_EQ(counts.searches, 1u);
  }
}

}  // namespace
}  // namespace brio
