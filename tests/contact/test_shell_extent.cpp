#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "contact/shell_extent.hpp"

namespace brio::testing {
namespace {

using Eigen::Vector3d;

struct Scene {
  FaceVertices vertices;
  FaceVertices velocities;
  Vector3d node;
  Vector3d node_velocity;
  double radius;
  double margin;
};

// Faces of all shapes: warped rectangles, slivers, triangles, any four points.
Scene random_scene(std::mt19937& random, int kind) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  const Vector3d offset = kind % 2 == 0 ? Vector3d(0, 0, 0) : Vector3d(1000, -3000, 2000);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(3 * uniform(random), vector().normalized()).toRotationMatrix();
  const double height = kind % 5 == 1 ? 1e-6 : 0.7;
  Scene scene;
  scene.vertices = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, height, 0), Vector3d(0, height, 0)};
  for (Vector3d& x : scene.vertices) {
    x += (kind % 5 == 2 ? 0.3 : 0.0) * vector();
    if (kind % 5 == 3) x = vector();
    x = turn * x + offset;
  }
  if (kind % 5 == 4) scene.vertices[3] = scene.vertices[2];
  for (Vector3d& v : scene.velocities) v = vector();
  scene.node = turn * (1.5 * vector()) + offset;
  scene.node_velocity = 2 * vector();
  scene.radius = 0.1 + 0.1 * uniform(random);
  scene.margin = 0.1 + 0.1 * uniform(random);
  return scene;
}

TEST(ShellExtent, LeavesOutOnlyWhatIsOutOfReach) {
  std::mt19937 random(11);
  const double ahead = 0.02;
  int left_out = 0;
  int out_of_reach = 0;
  for (int i = 0; i < 100000; ++i) {
    const Scene scene = random_scene(random, i);
    const bool out = surely_out_of_reach(shell_extent(scene.vertices, scene.velocities, scene.margin),
                                         scene.node, scene.node_velocity, scene.radius, ahead);
    double fastest = 0;
    for (const Vector3d& v : scene.velocities) fastest = std::max(fastest, (v - scene.node_velocity).norm());
    const double distance = std::sqrt(closest_point_on_quad(scene.node, scene.vertices).squared_distance);
    const bool far = distance > scene.margin + scene.radius + ahead * fastest;
    left_out += out;
    out_of_reach += far;
    ASSERT_TRUE(far || !out) << i;
  }
  EXPECT_GT(out_of_reach, 50000);
  EXPECT_GT(left_out, 0.6 * out_of_reach);
}

// Over a flat rectangle the box is the face: the distance is exact.
TEST(ShellExtent, IsExactForRectanglesAtRest) {
  const FaceVertices vertices{Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(2, 1, 0), Vector3d(0, 1, 0)};
  const FaceVertices at_rest{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  const ShellExtent extent = shell_extent(vertices, at_rest, 0.3);
  const Vector3d beyond_corner(2.3, 1.4, 1.2);  // 1.3 from the corner
  EXPECT_TRUE(surely_out_of_reach(extent, beyond_corner, Vector3d::Zero(), 0.99, 0));
  EXPECT_FALSE(surely_out_of_reach(extent, beyond_corner, Vector3d::Zero(), 1.01, 0));
  EXPECT_TRUE(surely_out_of_reach(extent, beyond_corner, Vector3d(0, 0, -4), 0.49, 0.125));
  EXPECT_FALSE(surely_out_of_reach(extent, beyond_corner, Vector3d(0, 0, -4), 0.51, 0.125));
}

TEST(ShellExtent, NeverLeavesOutAFaceWithoutArea) {
  const FaceVertices line{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(2, 0, 0), Vector3d(1, 0, 0)};
  const FaceVertices at_rest{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  EXPECT_FALSE(surely_out_of_reach(shell_extent(line, at_rest, 0.1), {0, 9, 0}, Vector3d::Zero(), 0.1, 1));
}

}  // namespace
}  // namespace brio::testing
