/// Certificates of separation: never false by exact arithmetic, also where heights are a rounding apart, and
/// not given away where features are apart by more.

#include "contact/geometry/separation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "contact/geometry/closest_on_segments.hpp"
#include "src/base/index.hpp"
#include "tests/contact/detection/exact_distance.hpp"
#include "tests/contact/detection/packs.hpp"
#include "tests/contact/detection/still_queries.hpp"
#include "tests/contact/geometry/adversarial_edges.hpp"
#include "tests/contact/geometry/exact_edges.hpp"
#include "tests/core/floating_point_traps.hpp"

namespace brio {
namespace {

struct Features {
  Vector3d d;
  std::vector<Vector3d> first_start, first_end, second_start, second_end;
};

// Features whose nearest heights along d differ by about `gap` at both ends of the step; d in single
// precision or in double.
Features features(Random& random, std::size_t n, std::size_t m, double gap) {
  Features f;
  f.d = random.vector(1) * random.power_of_ten(-3, 3);
  if (random.coin())
    for (double& component : f.d) component = static_cast<float>(component);
  if (random.integer(0, 9) == 0) f.d[random.integer(0, 2)] = 0;
  const auto at_one_time = [&](std::vector<Vector3d>& first, std::vector<Vector3d>& second) {
    const Vector3d shift = random.integer(0, 2) == 0 ? random.vector(1e6) : random.vector(1);
    const double square = squared_norm(f.d);
    const auto raise = [&](Vector3d v, double height) {  // to this height along d
      return Vector3d(v + (height - dot(v, f.d) / std::sqrt(square)) / std::sqrt(square) * f.d);
    };
    for (std::size_t k = 0; k < n; ++k)
      first.push_back(shift + raise(random.vector(1), gap + (random.coin() ? 0 : random.uniform(0, 1))));
    for (std::size_t k = 0; k < m; ++k)
      second.push_back(shift + raise(random.vector(1), random.coin() ? 0 : random.uniform(-1, 0)));
  };
  at_one_time(f.first_start, f.second_start);
  at_one_time(f.first_end, f.second_end);
  return f;
}

template <std::size_t N>
std::array<Vector3d, N> points(const std::vector<Vector3d>& from) {
  std::array<Vector3d, N> to;
  for (std::size_t k = 0; k < N; ++k) to[k] = from[k];
  return to;
}

struct Count {
  int certain = 0, refused = 0;
};

template <std::size_t N, std::size_t M>
void judge(Random& random, Count& count) {
  const double gap =
      random.integer(0, 5) == 0 ? 0 : random.power_of_ten(-18, 0) * (random.integer(0, 3) - 0.5);
  const Features f = features(random, N, M, gap);
  const test::FloatingPointTraps traps;
  const auto result = separation(f.d, points<N>(f.first_start), points<N>(f.first_end),
                                 points<M>(f.second_start), points<M>(f.second_end));
  ASSERT_TRUE(exact::separated_by(f.d, f.first_start, f.second_start, result.start - result.bound));
  ASSERT_FALSE(exact::separated_by(f.d, f.first_start, f.second_start, result.start + result.bound));
  ASSERT_TRUE(exact::separated_by(f.d, f.first_end, f.second_end, result.end - result.bound));
  ASSERT_FALSE(exact::separated_by(f.d, f.first_end, f.second_end, result.end + result.bound));
  ASSERT_EQ(result.is_certain(), result.start > result.bound && result.end > result.bound);
  ++(result.is_certain() ? count.certain : count.refused);
}

void judge(std::uint64_t seed, int queries) {
  Random random(seed);
  Count count;
  for (int i = 0; i < queries; ++i) {
    judge<1, 4>(random, count);
    judge<2, 2>(random, count);
    judge<3, 1>(random, count);
    if (testing::Test::HasFailure()) FAIL() << i;
  }
  EXPECT_GT(count.certain, queries / 4);
  EXPECT_GT(count.refused, queries / 4);
}

TEST(Separation, TheValueIsWithinTheBoundByExactArithmetic) { judge(71, 10000); }
TEST(SeparationSlow, TheValueIsWithinTheBoundByExactArithmetic) { judge(72, 150000); }

// Multiples of 2^-30: the ends of the step are exact.
Segment on_grid(const Segment& segment) {
  const auto round = [](const Vector3d& v) { return rounded_to(v, 0x1p-30); };
  return {round(segment[0]), round(segment[1])};
}

// Along the direction between the closest points at the start.
TEST(Separation, WhatIsCertainNeverMeets) {
  Random random(73);
  int certain = 0;
  for (int i = 0; i < 10000; ++i) {
    EdgeQuery query = adversarial_edges(static_cast<EdgeFamily>(i % edge_family_count), random);
    std::array<Vector3d, 2> start[2], end[2];
    MovingEdge* edges[2] = {&query.a, &query.b};
    for (int side = 0; side < 2; ++side) {
      edges[side]->radius = 0;
      edges[side]->start = on_grid(edges[side]->start);
      edges[side]->displacement = on_grid(edges[side]->displacement);
      for (std::size_t k = 0; k < 2; ++k) {
        start[side][k] = edges[side]->start[k];
        end[side][k] = edges[side]->start[k] + edges[side]->displacement[k];
      }
    }
    const auto closest = closest_on_segments(start[0][0], start[0][1], start[1][0], start[1][1]);
    if (!separation(closest.offset, start[0], end[0], start[1], end[1]).is_certain()) continue;
    ++certain;
    ASSERT_FALSE(exact::first_contact(query.a, query.b).has_value()) << i;
  }
  EXPECT_GT(certain, 1000);
}

TEST(Separation, LanesGiveTheBitsOfPlainNumbers) {
  Random random(74);
  for (int i = 0; i < 5000; ++i) {
    Vector3<Pack> d;
    std::array<Vector3<Pack>, 1> node_start, node_end;
    std::array<Vector3<Pack>, 4> face_start, face_end;
    std::array<Features, 8> all;
    for (int lane = 0; lane < 8; ++lane) {
      Features& f = all[index(lane)];
      f = features(random, 1, 4, random.power_of_ten(-18, 0));
      put(d, lane, f.d);
      put(node_start[0], lane, f.first_start[0]);
      put(node_end[0], lane, f.first_end[0]);
      for (std::size_t k = 0; k < 4; ++k) {
        put(face_start[k], lane, f.second_start[k]);
        put(face_end[k], lane, f.second_end[k]);
      }
    }
    const auto packed = separation(d, node_start[0], node_end[0], face_start, face_end);
    for (int lane = 0; lane < 8; ++lane) {
      const Features& f = all[index(lane)];
      const auto result = separation(f.d, f.first_start[0], f.first_end[0], points<4>(f.second_start),
                                     points<4>(f.second_end));
      ASSERT_TRUE(same_bits(packed.start[lane], result.start)) << i;
      ASSERT_TRUE(same_bits(packed.end[lane], result.end)) << i;
      ASSERT_TRUE(same_bits(packed.bound[lane], result.bound)) << i;
      ASSERT_EQ(in_lane(packed.is_certain(), lane), result.is_certain()) << i;
    }
  }
}

}  // namespace
}  // namespace brio
