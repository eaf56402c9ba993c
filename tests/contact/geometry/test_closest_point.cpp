/// Closest points region by region, against an exhaustive search, and under rotation, reflection and
/// renumbering.

#include "contact/geometry/closest_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/contact/geometry/adversarial_queries.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {

const FaceVertices unit_square = {Vector3d{0, 0, 0}, Vector3d{1, 0, 0}, Vector3d{1, 1, 0}, Vector3d{0, 1, 0}};
const FaceVertices right_triangle = {Vector3d{0, 0, 0}, Vector3d{1, 0, 0}, Vector3d{0, 1, 0},
                                     Vector3d{0, 1, 0}};

struct Region {
  Vector3d node;
  Vector3d point;
  Feature feature;
  int index;
};

void expect_region(const FaceVertices& face, const Region& region) {
  const ClosestPoint closest = closest_point_on_quad(region.node, face);
  EXPECT_NEAR(norm(closest.point - region.point), 0, 1e-15);
  EXPECT_NEAR(norm(closest.separation - (region.node - region.point)), 0, 1e-15);
  EXPECT_NEAR(closest.squared_distance, squared_norm(region.node - region.point), 1e-14);
  EXPECT_EQ(closest.feature, region.feature);
  EXPECT_EQ(closest.index, region.index);
  EXPECT_NEAR(closest.normal.z, 1, 1e-15);
  Vector3d by_weights{};
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    by_weights += closest.weights[k] * face[k];
    sum += closest.weights[k];
  }
  EXPECT_NEAR(sum, 1, 1e-15);
  EXPECT_NEAR(norm(by_weights - region.point), 0, 1e-15);
}

TEST(ClosestPoint, RegionsOfASquare) {
  expect_region(unit_square, {{0.5, 0.25, 2}, {0.5, 0.25, 0}, Feature::interior, 0});
  expect_region(unit_square, {{0.75, 0.5, -1}, {0.75, 0.5, 0}, Feature::interior, 1});
  expect_region(unit_square, {{0.5, 0.75, 1}, {0.5, 0.75, 0}, Feature::interior, 2});
  expect_region(unit_square, {{0.25, 0.5, 1}, {0.25, 0.5, 0}, Feature::interior, 3});
  expect_region(unit_square, {{0.5, -1, 1}, {0.5, 0, 0}, Feature::edge, 0});
  expect_region(unit_square, {{3, 0.25, 1}, {1, 0.25, 0}, Feature::edge, 1});
  expect_region(unit_square, {{0.75, 2, -1}, {0.75, 1, 0}, Feature::edge, 2});
  expect_region(unit_square, {{-1, 0.5, 0}, {0, 0.5, 0}, Feature::edge, 3});
  expect_region(unit_square, {{-1, -2, 1}, {0, 0, 0}, Feature::vertex, 0});
  expect_region(unit_square, {{2, -1, 1}, {1, 0, 0}, Feature::vertex, 1});
  expect_region(unit_square, {{2, 2, 0}, {1, 1, 0}, Feature::vertex, 2});
  expect_region(unit_square, {{-1, 2, -1}, {0, 1, 0}, Feature::vertex, 3});
}

TEST(ClosestPoint, RegionsOfATriangle) {
  expect_region(right_triangle, {{0.25, 0.25, 1}, {0.25, 0.25, 0}, Feature::interior, 0});
  expect_region(right_triangle, {{0.5, -1, 1}, {0.5, 0, 0}, Feature::edge, 0});
  expect_region(right_triangle, {{1, 1, 1}, {0.5, 0.5, 0}, Feature::edge, 1});
  expect_region(right_triangle, {{-1, 0.25, 1}, {0, 0.25, 0}, Feature::edge, 2});
  expect_region(right_triangle, {{-1, -1, 1}, {0, 0, 0}, Feature::vertex, 0});
  expect_region(right_triangle, {{3, 0, 1}, {1, 0, 0}, Feature::vertex, 1});
  expect_region(right_triangle, {{0, 3, 1}, {0, 1, 0}, Feature::vertex, 2});
}

TEST(ClosestPoint, SeamsAndTheCentroidBelongToTheInterior) {
  EXPECT_EQ(closest_point_on_quad({0.5, 0.5, 1}, unit_square).feature, Feature::interior);
  EXPECT_EQ(closest_point_on_quad({0.25, 0.25, 1}, unit_square).feature, Feature::interior);
}

FaceVertices random_face(Random& random) {
  FaceVertices face;
  const double flat = random.coin() ? 1 : random.power_of_ten(-9, 0);
  const Vector3d along = random.vector(1);
  for (Vector3d& vertex : face) vertex = random.uniform(-1, 1) * along + flat * random.vector(1);
  if (random.integer(0, 4) == 0) face[3] = face[2];
  return face;
}

// Least distance to the triangle by a grid over its weights that closes in on its best point.
double searched_distance(const Vector3d& node, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  double s0 = 0.5;
  double t0 = 0.5;
  double best = norm(a - node);
  for (double reach = 0.5; reach > 1e-9; reach *= 0.5) {
    double s_best = s0;
    double t_best = t0;
    for (int i = -8; i <= 8; ++i) {
      for (int j = -8; j <= 8; ++j) {
        const double s = std::clamp(s0 + reach * i / 8, 0.0, 1.0);
        const double t = std::clamp(t0 + reach * j / 8, 0.0, 1.0);
        const double distance = norm((1 - s) * a + s * ((1 - t) * b + t * c) - node);
        if (distance >= best) continue;
        best = distance;
        s_best = s;
        t_best = t;
      }
    }
    s0 = s_best;
    t0 = t_best;
  }
  return best;
}

TEST(ClosestPoint, NoPointOfTheFaceIsCloser) {
  Random random(11);
  for (int i = 0; i < 100; ++i) {
    const FaceVertices face = random_face(random);
    const Vector3d node = random.vector(1.5);
    const ClosestPoint closest = closest_point_on_quad(node, face);
    const Vector3d centroid = 0.25 * (face[0] + face[1] + face[2] + face[3]);
    double searched = 1e300;
    for (std::size_t k = 0; k < 4; ++k)
      searched = std::min(searched, searched_distance(node, centroid, face[k], face[(k + 1) % 4]));
    const double distance = std::sqrt(closest.squared_distance);
    EXPECT_LE(distance, searched + 1e-15) << i;
    EXPECT_GE(distance, searched - 1e-6) << i;
    Vector3d by_weights{};
    for (std::size_t k = 0; k < 4; ++k) by_weights += closest.weights[k] * face[k];
    EXPECT_NEAR(norm(by_weights - closest.point), 0, 1e-15);
  }
}

// The distance cannot be lessened by going from the closest point towards a vertex, but by rounding: also for
// slivers down to a height of 1e-9 and nodes close to the plane.
TEST(ClosestPoint, GoingTowardsAVertexDoesNotLessenTheDistance) {
  Random random(12);
  double most = 0;
  for (int i = 0; i < 20000; ++i) {
    const FaceVertices face = random_face(random);
    const std::array<Vector3d, 3> triangle = {face[0], face[1], face[2]};
    const Vector3d inside = (face[0] + face[1] + face[2]) / 3;
    const double near = random.power_of_ten(-6, 0);
    const TrianglePoint closest = closest_point_on_triangle(inside + random.vector(near), triangle);
    const Vector3d point = closest.weights[0] * triangle[0] + closest.weights[1] * triangle[1] +
                           closest.weights[2] * triangle[2];
    for (const Vector3d& vertex : triangle) {
      const Vector3d way = vertex - point;
      const double downhill = -dot(way, closest.offset);
      if (downhill <= 0) continue;
      const double less = std::max(0.0, closest.squared_distance - downhill * downhill / squared_norm(way));
      most = std::max(most, std::sqrt(closest.squared_distance) - std::sqrt(less));
    }
  }
  EXPECT_LT(most, 1e-15);
}

TEST(ClosestPoint, ZeroAreaIsASegmentOrAPoint) {
  const FaceVertices segment = {Vector3d{0, 0, 0}, Vector3d{1, 1, 1}, Vector3d{2, 2, 2}, Vector3d{2, 2, 2}};
  const ClosestPoint on_segment = closest_point_on_quad({1, 1, 4}, segment);
  EXPECT_NEAR(norm(on_segment.point - Vector3d{2, 2, 2}), 0, 1e-15);
  EXPECT_EQ(on_segment.normal, (Vector3d{0, 0, 0}));
  FaceVertices point;
  point.fill(Vector3d{1, 2, 3});
  const ClosestPoint on_point = closest_point_on_quad({1, 2, 5}, point);
  EXPECT_EQ(on_point.squared_distance, 4);
  EXPECT_EQ(on_point.point, (Vector3d{1, 2, 3}));
}

TEST(ClosestPoint, FarFromTheOriginTheSeparationIsAsGoodAsTheInput) {
  FaceVertices face = unit_square;
  const Vector3d far{1048576, -2097152, 1048576};  // unit squares stay exact here
  for (Vector3d& vertex : face) vertex += far;
  const ClosestPoint closest = closest_point_on_quad(far + Vector3d{0.5, 0.25, 0.125}, face);
  EXPECT_EQ(closest.separation, (Vector3d{0, 0, 0.125}));
}

TEST(ClosestPoint, TurnsMirrorsAndRenumbersWithTheFace) {
  Random random(13);
  int same = 0;
  for (int i = 0; i < 2000; ++i) {
    FaceVertices face;
    for (std::size_t k = 0; k < 4; ++k) face[k] = unit_square[k] + random.vector(0.2);
    const Vector3d node = Vector3d{0.5, 0.5, 0} + random.vector(1);
    const ClosestPoint closest = closest_point_on_quad(node, face);
    const Tensor<double> turn = rotation_matrix(normalized(
        Quaternion<double>{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 1.1}));
    FaceVertices turned;
    FaceVertices mirrored;
    FaceVertices renumbered;
    for (std::size_t k = 0; k < 4; ++k) {
      turned[k] = turn * face[k];
      mirrored[k] = componentwise_product(face[(4 - k) % 4], Vector3d{1, 1, -1});
      renumbered[k] = face[(k + 1) % 4];
    }
    const ClosestPoint of_turned = closest_point_on_quad(turn * node, turned);
    EXPECT_NEAR(norm(of_turned.point - turn * closest.point), 0, 1e-14);
    same += of_turned.sub_triangle == closest.sub_triangle;  // not where two share the closest point
    if (of_turned.sub_triangle == closest.sub_triangle) {
      EXPECT_NEAR(norm(of_turned.normal - turn * closest.normal), 0, 1e-13);
    }
    const ClosestPoint of_mirrored =
        closest_point_on_quad(componentwise_product(node, Vector3d{1, 1, -1}), mirrored);
    EXPECT_NEAR(norm(of_mirrored.point - componentwise_product(closest.point, Vector3d{1, 1, -1})), 0, 1e-15);
    const ClosestPoint of_renumbered = closest_point_on_quad(node, renumbered);
    EXPECT_NEAR(norm(of_renumbered.point - closest.point), 0, 1e-15);
    EXPECT_EQ(of_renumbered.feature, closest.feature);
    if (closest.feature != Feature::interior) {
      EXPECT_EQ((of_renumbered.index + 1) % 4, closest.index);
    }
  }
  EXPECT_GT(same, 1500);
}

}  // namespace
}  // namespace brio
