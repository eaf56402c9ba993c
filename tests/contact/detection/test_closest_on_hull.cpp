/// Closest points of triangles and of the hulls of faces, against exact arithmetic.

#include "contact/geometry/closest_on_hull.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "tests/contact/detection/exact_distance.hpp"
#include "tests/contact/detection/packs.hpp"
#include "tests/contact/detection/still_queries.hpp"
#include "tests/core/floating_point_traps.hpp"

namespace brio {
namespace {

std::array<Vector3d, 4> corners(const FaceVertices& face) { return {face[0], face[1], face[2], face[3]}; }
ClosestOnHull<double> closest(const FaceQuery& query) {
  return closest_on_hull(query.node, corners(query.face));
}
double largest_difference(const FaceQuery& query) {
  double largest = 0;
  for (const Vector3d& vertex : query.face) largest = std::max(largest, maximum_norm(query.node - vertex));
  return largest;
}

// Node minus the point of the weights, with eleven bits more than a double.
template <std::size_t N>
Vector3d offset_by_weights(const FaceQuery& query, const std::array<double, N>& weights) {
  Vector3d offset;
  for (int i = 0; i < 3; ++i) {
    long double sum = 0;
    for (std::size_t k = 0; k < N; ++k)
      sum += static_cast<long double>(weights[k]) *
             (static_cast<long double>(query.node[i]) - static_cast<long double>(query.face[k][i]));
    offset[i] = static_cast<double>(sum);
  }
  return offset;
}

template <std::size_t N>
bool are_shares(const std::array<double, N>& weights) {
  double sum = 0;
  for (double weight : weights) sum += weight;
  return std::abs(sum - 1) <= 4 * unit_roundoff &&
         std::all_of(weights.begin(), weights.end(), [](double weight) { return weight >= 0; });
}

// Roundings of the largest difference.
constexpr double roundings = 10;

void judge_triangle(const FaceQuery& query) {
  const test::FloatingPointTraps traps;
  const auto result = closest_on_triangle(query.node, query.face[0], query.face[1], query.face[2]);
  const double rounding = roundings * unit_roundoff * largest_difference(query);
  const double distance = std::sqrt(result.squared_distance);
  EXPECT_TRUE(are_shares(result.weights));
  EXPECT_LE(maximum_norm(offset_by_weights(query, result.weights) - result.offset), rounding);
  EXPECT_LE(std::abs(norm(result.offset) - distance), 4 * unit_roundoff * distance);
  const exact::SquaredDistance truth =
      exact::to_triangle(query.node, {query.face[0], query.face[1], query.face[2]});
  EXPECT_TRUE(truth.at_most(distance + rounding));
  EXPECT_TRUE(truth.at_least(distance - rounding));
}

void judge_hull(const FaceQuery& query) {
  const test::FloatingPointTraps traps;
  const auto result = closest(query);
  const double scale = largest_difference(query);
  const double rounding = roundings * unit_roundoff * scale;
  // Sheets nearer than 16 to 32 roundings of the coordinates are one.
  const double flat = 32 * unit_roundoff * (scale + maximum_norm(query.node));
  const double distance = norm(result.offset);
  EXPECT_TRUE(are_shares(result.weights));
  EXPECT_LE(maximum_norm(offset_by_weights(query, result.weights) - result.offset), rounding + flat);
  if (result.inside) {
    EXPECT_TRUE(exact::is_inside_hull(query.node, query.face));
    EXPECT_EQ(result.squared_distance, 0);
  } else {
    EXPECT_FALSE(exact::is_inside_hull(query.node, query.face, 128 * unit_roundoff));
    EXPECT_LE(std::abs(std::sqrt(result.squared_distance) - distance), 4 * unit_roundoff * distance);
  }
  const exact::SquaredDistance truth = exact::to_hull_surface(query.node, query.face);
  EXPECT_TRUE(truth.at_most(distance + rounding));
  EXPECT_TRUE(truth.at_least(distance - rounding));
}

void judge(std::uint64_t seed, int queries, void (*one)(const FaceQuery&)) {
  Random random(seed);
  for (int i = 0; i < queries; ++i) {
    one(any_face_query(random));
    if (testing::Test::HasFailure()) FAIL() << i;
  }
}

TEST(ClosestOnTriangle, RightToRoundingByExactArithmetic) { judge(51, 30000, judge_triangle); }
TEST(ClosestOnTriangleSlow, RightToRoundingByExactArithmetic) { judge(52, 300000, judge_triangle); }
TEST(ClosestOnHull, RightToRoundingByExactArithmetic) { judge(53, 30000, judge_hull); }
TEST(ClosestOnHullSlow, RightToRoundingByExactArithmetic) { judge(54, 300000, judge_hull); }

TEST(ClosestOnHull, LanesGiveTheBitsOfPlainNumbers) {
  Random random(56);
  const test::FloatingPointTraps traps;
  for (int i = 0; i < 20000; ++i) {
    std::array<FaceQuery, 8> queries;
    Vector3<Pack> node;
    std::array<Vector3<Pack>, 4> face;
    for (int lane = 0; lane < 8; ++lane) {
      FaceQuery& query = queries[index(lane)];
      query = any_face_query(random);
      put(node, lane, query.node);
      for (std::size_t k = 0; k < 4; ++k) put(face[k], lane, query.face[k]);
    }
    const auto packed = closest_on_hull(node, face);
    const auto of_triangle = closest_on_triangle(node, face[0], face[1], face[2]);
    for (int lane = 0; lane < 8; ++lane) {
      const FaceQuery& query = queries[index(lane)];
      const auto result = closest(query);
      ASSERT_TRUE(same_bits(packed.offset, lane, result.offset)) << i;
      ASSERT_TRUE(same_bits(packed.squared_distance[lane], result.squared_distance)) << i;
      ASSERT_EQ(in_lane(packed.inside, lane), result.inside) << i;
      for (std::size_t k = 0; k < 4; ++k)
        ASSERT_TRUE(same_bits(packed.weights[k][lane], result.weights[k])) << i;
      const auto triangle = closest_on_triangle(query.node, query.face[0], query.face[1], query.face[2]);
      ASSERT_TRUE(same_bits(of_triangle.offset, lane, triangle.offset)) << i;
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_TRUE(same_bits(of_triangle.weights[k][lane], triangle.weights[k])) << i;
    }
  }
}

// A mirror that keeps the order of the vertices gives the same bits; one that keeps the sense in which they
// are listed, and any first vertex, the same to rounding.
TEST(ClosestOnHull, MirrorImagesAreMirrorImages) {
  Random random(57);
  for (int i = 0; i < 50000; ++i) {
    const FaceQuery query = any_face_query(random);
    const auto result = closest(query);
    const Vector3d mirror{1, -1, 1};
    FaceQuery mirrored{componentwise_product(query.node, mirror), {}};
    for (std::size_t k = 0; k < 4; ++k) mirrored.face[k] = componentwise_product(query.face[k], mirror);
    const auto seen = closest(mirrored);
    ASSERT_EQ(seen.offset, componentwise_product(result.offset, mirror)) << i;
    ASSERT_EQ(seen.weights, result.weights) << i;
    ASSERT_EQ(seen.inside, result.inside) << i;
    if (query.face[3] == query.face[2]) continue;
    FaceQuery relisted = mirrored;
    const auto first = index(random.integer(0, 3));
    for (std::size_t k = 0; k < 4; ++k) relisted.face[k] = mirrored.face[(first + 4 - k) % 4];
    const double rounding = 2 * roundings * unit_roundoff * largest_difference(query);
    ASSERT_NEAR(norm(closest(relisted).offset), norm(result.offset), rounding) << i;
  }
}

// On a flat face the weights are the bilinear shape functions; the face is anywhere, so not flat to the last
// digit, and the node over, under or in it.
TEST(ClosestOnHull, WeightsOfAFlatFaceAreItsShapeFunctions) {
  Random random(58);
  for (int i = 0; i < 50000; ++i) {
    const Vector3d u = random.vector(1);
    const Vector3d v = random.vector(1);
    const Vector3d normal = cross(u, v);
    if (norm(normal) < 0.1 * norm(u) * norm(v) || norm(u) < 0.1 || norm(v) < 0.1) continue;
    const Vector3d corner = random.vector(random.coin() ? 1 : 100);
    const double s = random.uniform(0.6, 1.5);
    const double t = random.uniform(0.6, 1.5);
    FaceQuery query{{}, {corner, corner + u, corner + s * u + t * v, corner + v}};
    const double xi = random.uniform(0, 1);
    const double eta = random.uniform(0, 1);
    const std::array<double, 4> shape = {(1 - xi) * (1 - eta), xi * (1 - eta), xi * eta, (1 - xi) * eta};
    query.node = random.uniform(-2, 2) * random.integer(0, 2) * normal;
    for (std::size_t k = 0; k < 4; ++k) query.node += shape[k] * query.face[k];
    const auto result = closest(query);
    for (std::size_t k = 0; k < 4; ++k)
      ASSERT_NEAR(result.weights[k], shape[k], 1e-12 * std::max(1.0, norm(corner))) << i;
  }
}

// As a face goes from a warp to the opposite one its nearer sheet changes; with a flatness the weights go
// over gradually. The point that they give moves along the offset; across it by no more than the distance
// times the angle between the sheets, by which their closest points differ.
TEST(ClosestOnHull, WithAFlatnessWeightsAreContinuousInTheWarp) {
  Random random(60);
  const double flatness = 1e-3;
  for (int i = 0; i < 200; ++i) {
    FaceQuery query{random.vector(0.4) + Vector3d{0.5, 0.5, 0}, {}};
    const double height = random.power_of_ten(-2, 0);
    query.node[2] = random.coin() ? height : -height;
    std::array<double, 4> before{};
    for (int k = -400; k <= 400; ++k) {
      const double warp = 0.02 * flatness * k;
      query.face = {Vector3d{0, 0, warp}, Vector3d{1, 0, 0}, Vector3d{1, 1, warp}, Vector3d{0, 1, 0}};
      const auto result = closest_on_hull(query.node, corners(query.face), flatness);
      const Vector3d shift = offset_by_weights(query, result.weights) - result.offset;
      ASSERT_LE(norm(shift), 2 * flatness);
      ASSERT_LE(norm(cross(shift, normalized(result.offset))), 2 * std::abs(warp) * height + 1e-15);
      for (std::size_t c = 0; c < 4; ++c) {
        const double change = k > -400 ? std::abs(result.weights[c] - before[c]) : 0;
        ASSERT_LE(change, 0.03) << i << ' ' << k;
        before[c] = result.weights[c];
      }
    }
  }
}

TEST(ClosestOnHull, ATriangularFaceHasNoWeightOnItsFourthVertex) {
  Random random(59);
  for (int i = 0; i < 10000; ++i) {
    FaceQuery query = any_face_query(random);
    query.face[3] = query.face[2];
    const auto result = closest(query);
    const auto triangle = closest_on_triangle(query.node, query.face[0], query.face[1], query.face[2]);
    ASSERT_EQ(result.weights[3], 0);
    ASSERT_FALSE(result.inside);
    ASSERT_NEAR(std::sqrt(result.squared_distance), std::sqrt(triangle.squared_distance),
                2 * roundings * unit_roundoff * largest_difference(query));
  }
}

}  // namespace
}  // namespace brio
