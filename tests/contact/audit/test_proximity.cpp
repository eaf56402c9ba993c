/// Distances below thickness and radius.

#include <gtest/gtest.h>

#include <cmath>

#include "contact/audit/distance.hpp"
#include "src/base/index.hpp"
#include "tests/contact/audit/audit_scene.hpp"
#include "tests/contact/geometry/adversarial_queries.hpp"

namespace brio::test {
namespace {

const auto as_it_is = moved({0, 0, 0});

// By walking over both in small steps.
TEST(AuditDistance, IsNeverMoreThanThatOfAnyTwoPoints) {
  Random random(5);
  constexpr int steps = 20;
  for (int i = 0; i < 2000; ++i) {
    const std::array first{random.vector(1), random.vector(1)};
    std::array second{random.vector(1), random.vector(1)};
    if (i % 4 == 0) second[1] = second[0] + random.uniform(-1, 1) * (first[1] - first[0]);  // parallel
    if (i % 5 == 0) second[1] = second[0];
    const std::array<Vector3d, 4> face{random.vector(1), random.vector(1), random.vector(1),
                                       random.vector(1)};
    const double of_segments = distance_of_segments(first, second).distance;
    const double of_triangle = std::sqrt(squared_distance_to_triangle(first[0], face[0], face[1], face[2]));
    double least = HUGE_VAL, least_of_triangle = HUGE_VAL;
    for (int a = 0; a <= steps; ++a)
      for (int b = 0; b <= steps; ++b) {
        const double s = a / double(steps), t = b / double(steps);
        const Vector3d x = first[0] + s * (first[1] - first[0]), y = second[0] + t * (second[1] - second[0]);
        least = std::min(least, norm(x - y));
        if (a + b > steps) continue;
        const Vector3d z = face[0] + s * (face[1] - face[0]) + t * (face[2] - face[0]);
        least_of_triangle = std::min(least_of_triangle, norm(first[0] - z));
      }
    ASSERT_LE(of_segments, least + 1e-12);
    ASSERT_GE(of_segments, least - 0.2);
    ASSERT_LE(of_triangle, least_of_triangle + 1e-12);
    ASSERT_GE(of_triangle, least_of_triangle - 0.2);
  }
}

TEST(AuditDistance, IsKnownAtEveryFeature) {
  const Vector3d a{0, 0, 0}, b(2, 0, 0), c(0, 2, 0);
  const auto distance = [&](const Vector3d& x) {
    return std::sqrt(squared_distance_to_triangle(x, a, b, c));
  };
  EXPECT_DOUBLE_EQ(distance({0.5, 0.5, -3}), 3);
  EXPECT_DOUBLE_EQ(distance({1, -3, 4}), 5);
  EXPECT_DOUBLE_EQ(distance({2, 2, 0}), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(distance({-1, -2, 2}), 3);
  EXPECT_DOUBLE_EQ(distance({4, 0, 0}), 2);
}

TEST(AuditProximity, CountsNodesOfShellsTooClose) {
  AuditScene scene;
  scene.add_sheet({6, 6}, {6, 6}, 0.1, as_it_is);
  const int upper = scene.add_sheet({4, 4}, {3, 3}, 0.1, [](const Vector3d& x) -> Vector3d {
    return {1.1 + x[0], 1.2, 0.101 + x[1]};
  });
  scene.start();
  const int first = scene.first_node(upper);
  EXPECT_EQ(scene.found().missed(), 0);
  const auto lower = [&](double by) {
    for (int n = first; n < scene.count(); ++n)
      scene.place(n, scene.positions()[index(n)] - Vector3d{0, 0, by});
  };
  lower(0.009);
  EXPECT_EQ(scene.found().missed(), 0) << "by less than a tenth";
  lower(0.011);
  EXPECT_EQ(scene.found().too_close, 5);
  EXPECT_EQ(scene.found().crossings, 0);
  EXPECT_NEAR(scene.found().deepest_too_close.depth, 0.1 - 0.081, 1e-12);
  EXPECT_EQ(scene.found().deepest_too_close.part, (std::array{upper, 0}));
  lower(0.4);
  EXPECT_EQ(scene.found().crossings, 7) << "four columns across faces of the lower, three of them across two";
}

TEST(AuditProximity, CountsParticlesInFacesBeamsAndParticles) {
  AuditScene scene;
  scene.add_box({2, 2, 1}, {2, 2, 1}, as_it_is);
  scene.add_sheet({1, 1}, {2, 2}, 0.1, moved({4, 0, 1}));
  scene.add_beams({{8, 0, 1}, {9, 0, 1}}, 0.1);
  const int near = scene.add_particles({{0.7, 0.6, 1.2}, {5.1, 0.8, 1.25}, {8.5, 0, 1.3}, {12, 0, 1.0}}, 0.2);
  const int other = scene.add_particles({{12, 0, 1.4}}, 0.2);
  scene.start();
  EXPECT_EQ(scene.found().missed(), 0) << "all touch";
  const int first = scene.first_node(near);
  for (int n = first; n < scene.first_node(other); ++n) {
    AuditScene closer = scene;
    const double down = n + 1 == scene.first_node(other) ? -0.05 : 0.05;
    closer.place(n, scene.positions()[index(n)] - Vector3d{0, 0, down});
    EXPECT_EQ(closer.found().too_close, 1) << n;
    EXPECT_EQ(closer.found().missed(), 1) << n;
    EXPECT_NEAR(closer.found().deepest_too_close.depth, 0.05, 1e-12) << n;
  }
}

TEST(AuditProximity, CountsCrossedBeamsAndEdges) {
  AuditScene scene;
  scene.add_box({1, 1, 1}, {1, 1, 1}, as_it_is);
  scene.add_sheet({1, 1}, {1, 1}, 0.1, [](const Vector3d& x) -> Vector3d { return {4 + x[0], 0.5, x[1]}; });
  scene.add_sheet({1, 1}, {1, 1}, 0.1, [](const Vector3d& x) -> Vector3d { return {4.5, x[0], 1.1 + x[1]}; });
  const int beams = scene.add_beams({{-1, 0.5, 1.1}, {2, 0.5, 1.1}}, 0.1);
  scene.add_beams({{-0.5, -1, 1.3}, {-0.5, 2, 1.3}}, 0.1);
  scene.start();
  EXPECT_EQ(scene.found().missed(), 0) << "all touch";
  const auto depths = [&](int node_count, int first, double by) {
    AuditScene closer = scene;
    for (int n = first; n < first + node_count; ++n)
      closer.place(n, scene.positions()[index(n)] - Vector3d{0, 0, by});
    return closer.found();
  };
  EXPECT_EQ(depths(4, scene.first_node(2), 0.02).too_close, 1) << "rim on rim";
  EXPECT_EQ(depths(2, scene.first_node(beams), 0.02).too_close, 2) << "beam on two edges of the top";
  EXPECT_EQ(depths(2, scene.first_node(beams) + 2, 0.05).too_close, 1) << "beam on beam";
  EXPECT_EQ(depths(2, scene.first_node(beams) + 2, 0.015).too_close, 0) << "by less than a tenth";
}

TEST(AuditProximity, NeighboursInAFoldOfTheirThicknessAreNotTooClose) {
  AuditScene scene;
  scene.add_sheet({40, 1}, {4, 1}, 0.5, as_it_is);  // elements of a fifth of the thickness
  scene.add_beams({{0, 5, 0}, {0.1, 5, 0}, {0.2, 5, 0}, {0.3, 5, 0}, {0.4, 5, 0}}, 0.1);
  scene.start();
  scene.step();
  EXPECT_EQ(scene.found().missed(), 0);
}

}  // namespace
}  // namespace brio::test
