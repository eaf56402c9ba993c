/// Lower bounds of the distance of the features of two faces, against all pairs of them.

#include "contact/pairs/feature_distance.hpp"

#include <gtest/gtest.h>

#include "contact/geometry/closest_segments.hpp"
#include "contact/geometry/hull_point.hpp"
#include "src/base/index.hpp"
#include "tests/contact/geometry/adversarial_queries.hpp"

namespace brio {
namespace {
using Corners = std::array<Vector3d, 4>;
using Numbers = std::array<int, 4>;

/// Two faces as a pass over pairs sees them.
struct TwoFaces {
  using Pairs = PackOfPairs<4, 4>;
  Numbers first, second;
  PairList list{};
  const Numbers& first_nodes(int) const { return first; }
  const Numbers& second_nodes(int) const { return second; }
};

double bound_of(const Numbers& first, const Corners& a, const Numbers& second, const Corners& b) {
  TwoFaces kind{first, second};
  kind.list.add({.spacing = Spacing::radii});
  OnePair<TwoFaces>::Points at;
  for (std::size_t k = 0; k < 4; ++k) {
    at.first[k] = a[k];
    at.second[k] = b[k];
  }
  return CommonCorners(OnePair<TwoFaces>(kind, 0), at).distance().distance;
}

// Of all nodes and edges of one and faces and edges of the other without a common node.
double least_distance(const Numbers& first, const Corners& a, const Numbers& second, const Corners& b) {
  constexpr std::size_t edges[6][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}};
  const auto has = [](const Numbers& nodes, int node) {
    return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
  };
  double least = infinity;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!has(second, first[k])) least = std::min(least, closest_on_face(a[k], b, true).squared_distance);
    if (!has(first, second[k])) least = std::min(least, closest_on_face(b[k], a, true).squared_distance);
  }
  for (const auto& e : edges)
    for (const auto& f : edges) {
      const int p = first[e[0]], q = first[e[1]], r = second[f[0]], s = second[f[1]];
      if (p == r || p == s || q == r || q == s) continue;
      least = std::min(least,
                       closest_points_of_segments({a[e[0]], a[e[1]]}, {b[f[0]], b[f[1]]}).squared_distance);
    }
  return std::sqrt(least);
}

constexpr Numbers own{0, 1, 2, 3};
/// The other face has none, one, or two neighbouring nodes of it, wherever in either.
const std::vector<Numbers> others{{4, 5, 6, 7}, {2, 5, 6, 7}, {5, 6, 0, 7},
                                  {2, 1, 6, 7}, {5, 3, 2, 6}, {0, 5, 6, 3}};

TEST(FeatureDistance, IsNoMoreThanThatOfAnyPairOfFeatures) {
  Random random(5);
  std::array<int, 6> known{};
  for (int trial = 0; trial < 20000; ++trial) {
    std::array<Vector3d, 8> node;
    for (Vector3d& x : node) x = random.vector(1);
    const auto at = [&](const Numbers& numbers) {
      Corners x;
      for (std::size_t k = 0; k < 4; ++k) x[k] = node[index(numbers[k])];
      return x;
    };
    if (random.coin())
      for (std::size_t k = 4; k < 8; ++k) node[k] += Vector3d{1, 1, 0};
    for (std::size_t i = 0; i < others.size(); ++i) {
      const double bound = bound_of(own, at(own), others[i], at(others[i]));
      ASSERT_LE(bound, least_distance(own, at(own), others[i], at(others[i]))) << trial << ' ' << i;
      known[i] += bound > 0 ? 1 : 0;
    }
  }
  for (int count : known) EXPECT_GT(count, 200);
}

// In a sheet of squares, bent or not: what faces share no node with is an edge away, or its half diagonal.
TEST(FeatureDistance, OfSquaresIsNearlyTheLeast) {
  const auto square_at = [](double x, double y) {
    return Corners{Vector3d{x, y, 0}, Vector3d{x + 1, y, 0}, Vector3d{x + 1, y + 1, 0},
                   Vector3d{x, y + 1, 0}};
  };
  EXPECT_NEAR(bound_of(own, square_at(0, 0), {4, 5, 6, 7}, square_at(2, 0.3)), 1, 0.1);
  EXPECT_NEAR(bound_of(own, square_at(0, 0), {2, 5, 6, 7}, square_at(1, 1)), std::sqrt(0.5), 0.07);
  EXPECT_NEAR(bound_of(own, square_at(0, 0), {1, 4, 5, 2}, square_at(1, 0)), std::sqrt(0.5), 0.07);
  Corners folded = square_at(1, 0);
  folded[1] = {1, 0, 1};
  folded[2] = {1, 1, 1};
  EXPECT_NEAR(bound_of(own, square_at(0, 0), {1, 4, 5, 2}, folded), 0.5, 0.21) << "at a right angle";
}

TEST(FeatureDistance, OfFacesFoldedOntoEachOtherIsNone) {
  const Corners flat{Vector3d{0, 0, 0}, Vector3d{1, 0, 0}, Vector3d{1, 1, 0}, Vector3d{0, 1, 0}};
  const Corners folded{Vector3d{1, 0, 0}, Vector3d{0, 0, 1e-3}, Vector3d{0, 1, 1e-3}, Vector3d{1, 1, 0}};
  EXPECT_LT(bound_of(own, flat, {1, 4, 5, 2}, folded), 1e-3);
}

}  // namespace
}  // namespace brio
