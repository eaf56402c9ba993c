// Lists of neighbours against all pairs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "elements/particle/neighbour_search.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

std::vector<int> neighbours_of(const std::vector<ReachingPoint>& points, std::size_t i) {
  std::vector<int> found;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const double reach = points[i].reach + points[j].reach;
    if (i == j || points[i].reach < 0 || points[j].reach < 0) continue;
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = points[j].position[axis] - points[i].position[axis];
      squared += d * d;
    }
    if (squared < reach * reach) found.push_back(static_cast<int>(j));
  }
  return found;
}

void expect_all_pairs(const std::vector<ReachingPoint>& points) {
  NeighbourSearch search;
  ThreadTeam team(3), alone(1);
  search.find(points, team);
  NeighbourSearch again;
  again.find(points, alone);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto of = search.of(i), of_one = again.of(i);
    ASSERT_TRUE(std::ranges::equal(of, of_one)) << i << ": the order depends on the threads";
    std::vector<int> sorted(of.begin(), of.end());
    std::ranges::sort(sorted);
    ASSERT_EQ(sorted, neighbours_of(points, i)) << i;
  }
}

std::vector<ReachingPoint> cloud_of(int count, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, size), reach(0.3, 1.2);
  std::vector<ReachingPoint> points(index(count));
  for (ReachingPoint& point : points)
    point = {{place(random) - 7, place(random), place(random) + 100}, reach(random)};
  return points;
}

TEST(NeighbourSearch, FindsThePairsOfACloudOfUnlikeReaches) {
  for (const double size : {0.5, 4.0, 12.0, 300.0}) expect_all_pairs(cloud_of(700, size, 3));
}

TEST(NeighbourSearch, FindsThoseOnALatticeWhosePlanesAreBordersOfCells) {
  std::vector<ReachingPoint> points;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      for (int k = 0; k < 9; ++k) points.push_back({{1.0 * i, 1.0 * j, 1.0 * k}, 1});
  expect_all_pairs(points);  // neighbours at exactly 2 are none
}

TEST(NeighbourSearch, LeavesOutWhatHasBeenDeletedAndKeepsThoseInOnePlace) {
  std::vector<ReachingPoint> points = cloud_of(300, 3, 8);
  for (std::size_t i = 0; i < points.size(); i += 3) points[i].reach = -1;
  points[1] = points[2];
  expect_all_pairs(points);
  expect_all_pairs({});
  expect_all_pairs({{{0, 0, 0}, -1}, {{0, 0, 0}, -1}});
  expect_all_pairs({{{0, 0, 0}, 0}, {{0, 0, 0}, 0}});
  points[5].position[2] = NAN;
  expect_all_pairs(points);
}

TEST(NeighbourSearch, FindsThoseOfACloudWithOneFarAway) {
  std::vector<ReachingPoint> points = cloud_of(400, 5, 5);
  points[17].position[1] = 1e9;
  points[18].position[2] = -1e4;
  expect_all_pairs(points);
}

}  // namespace
}  // namespace brio
