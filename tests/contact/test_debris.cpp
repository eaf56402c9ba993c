// Nodes left without elements that stay in contact with a radius.
#include <gtest/gtest.h>

#include "contact/audit/audit.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"

namespace brio::test {
namespace {

constexpr double radius = 0.1;

// From a node to the nearest living face.
double distance_to_surface(const SpringModel& model, int node) {
  double nearest = HUGE_VAL;
  for (const Face& face : model.scene.surface.face)
    if (face.alive() && !face.has(node))
      nearest = std::min(nearest,
                         closest_point_on_quad(model.x(node), vertices(model.nodes, face)).squared_distance);
  return std::sqrt(nearest);
}

double radius_of(const SpringModel& model, int node) {
  const Surface& surface = model.scene.surface;
  return surface.slave(node) < 0 ? -1 : surface.radius[index(surface.slave(node))];
}

TEST(Debris, FliesAgainstAPlateAndTurnsAtItsRadius) {
  for (const double thickness : {0.05, 0.0})  // 0: a solid
    for (const double given : {radius, 0.0}) {
      SpringModel model;
      model.stiffness = 100;
      model.debris_radius = given;
      const int first = model.add_box({1, 1, 1}, {0.2, 0.2, 0.2}, 1, shifted({0.37, 0.41, 0.3}));
      model.throw_from(first, {0, 0, -1});
      const int plate = thickness > 0 ? model.add_sheet({4, 4}, {1, 1}, thickness, 1000, shifted({0, 0, 0}))
                                      : model.add_box({4, 4, 1}, {1, 1, 0.2}, 100, shifted({0, 0, -0.2}));
      model.start_erodible({});
      const double dt = 1e-3;
      model.step(dt);
      model.erode(std::vector<SurfaceElement>{{0, 0}});
      const Vector3d momentum = model.momentum();
      const Vector3d moment = model.angular_momentum();
      ThreadTeam team(1);
      double nearest = HUGE_VAL;
      for (int i = 0; i < 1000; ++i) {
        model.step(dt);
        for (int n = first; n < first + 8; ++n) nearest = std::min(nearest, distance_to_surface(model, n));
        if (i % 20 == 0) {
          ASSERT_EQ(audit(model.scene, model.nodes, team).missed(), 0);
        }
      }
      EXPECT_LT(norm(model.momentum() - momentum), 1e-12 * norm(momentum));
      EXPECT_LT(norm(model.angular_momentum() - moment), 1e-11 * norm(momentum));
      if (given > 0) {
        EXPECT_NEAR(nearest, radius + std::max(0.5 * thickness, model.scene.features.skin), 1e-3 * radius);
        for (int n = first; n < first + 8; ++n)
          EXPECT_GT(model.v(n)[2], model.mean_velocity(plate, model.count())[2] - 0.05);
      } else {
        EXPECT_LT(nearest, 0.01);
        EXPECT_LT(model.mean_velocity(first, first + 8)[2], -0.999)
            << "without a radius it is out of contact";
      }
    }
}

// A node in the middle of a side of a block loses its four elements and sits over the hole: it is outside of
// what is left, whichever way it goes.
TEST(Debris, IsOutsideOfTheBodyThatItWasPartOf) {
  for (const Vector3d& way :
       {Vector3d{0, 0, 1}, Vector3d{0, 0, -1}, Vector3d{1, 0.3, 0}, Vector3d{-1, 0, -1}}) {
    SpringModel model;
    model.stiffness = 200;
    model.debris_radius = radius;
    model.add_box({4, 4, 3}, {4, 4, 3}, 1, shifted({0, 0, 0}));
    const int node = 2 + 5 * (2 + 5 * 3);
    model.start_erodible({});
    model.step(1e-3);
    ASSERT_EQ(model.x(node), (Vector3d{2, 2, 3}));
    std::vector<SurfaceElement> around;
    for (int j : {1, 2})
      for (int i : {1, 2}) around.push_back({0, i + 4 * (j + 4 * 2)});
    model.erode(around);
    model.set_velocity(node, way);
    model.step(1e-3);
    EXPECT_EQ(model.v(node), way) << "nothing pushes where it was";
    EXPECT_EQ(radius_of(model, node), radius);
    const Vector3d momentum = model.momentum();
    ThreadTeam team(1);
    double nearest = HUGE_VAL;
    for (int i = 0; i < 1500; ++i) {
      model.step(1e-3);
      nearest = std::min(nearest, distance_to_surface(model, node));
      if (i % 20 == 0) {
        ASSERT_EQ(audit(model.scene, model.nodes, team).missed(), 0);
      }
    }
    EXPECT_LT(norm(model.momentum() - momentum), 1e-12);
    if (way[2] > 0) {
      EXPECT_EQ(model.v(node), way);
    } else {
      EXPECT_NEAR(nearest, radius + model.scene.features.skin, 1e-3 * radius) << testing::PrintToString(way);
    }
  }
}

// Debris has its full radius at once, but not towards what it is nearer to when it is freed,
// until it has been apart.
TEST(Debris, FreedNextToABlockWaitsUntilItHasBeenApart) {
  SpringModel model;
  model.stiffness = 200;
  model.debris_radius = radius;
  const double gap = 0.01;
  const int above = model.add_box({1, 1, 2}, {0.6, 0.6, 1}, 1, shifted({0.67, 0.71, 1 + gap}));
  model.add_box({2, 2, 1}, {2, 2, 1}, 1, shifted({0, 0, 0}));
  model.start_erodible({});
  model.step(1e-3);
  model.erode(std::vector<SurfaceElement>{{0, 0}});
  for (int i = 0; i < 50; ++i) {
    model.step(1e-3);
    for (int n = 0; n < model.count(); ++n) ASSERT_EQ(model.v(n), (Vector3d{}));
  }
  const int node = above + 3;
  const auto fly = [&](double speed, int steps) {
    model.set_velocity(node, {0, 0, speed});
    double nearest = HUGE_VAL;
    for (int i = 0; i < steps; ++i) {
      model.step(1e-3);
      nearest = std::min(nearest, distance_to_surface(model, node));
    }
    return nearest;
  };
  const double skin = model.scene.features.skin;
  fly(1, 50);
  EXPECT_EQ(model.v(node)[2], 1) << "it is not pushed";
  EXPECT_NEAR(fly(-1, 80), 2 * skin, 0.25 * skin) << "it has not been apart by its radius";
  fly(1, 150);
  EXPECT_EQ(model.v(node)[2], 1);
  EXPECT_NEAR(fly(-1, 200), radius + skin, 1e-3 * radius);
}

}  // namespace
}  // namespace brio::test
