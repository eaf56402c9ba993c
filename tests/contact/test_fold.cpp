#include <gtest/gtest.h>

#include "contact/audit/audit.hpp"
#include "tests/contact/spring_model.hpp"

namespace brio::test {
namespace {

// A strip whose ends are driven together folds onto itself, at three meshes whose cells are one contact
// thickness, a half and a quarter of it.
TEST(FoldingStripSlow, NeverPassesThroughItself) {
  ThreadTeam team(1);
  for (const int refine : {1, 2, 4}) {
    SpringModel model;
    const int columns = 24 * refine;
    const double length = 6;
    model.stiffness = 50.0 / refine;
    model.damping = 1;
    model.add_sheet({columns, 2 * refine}, {length, 0.5}, 0.25, 1, [&](const Vector3d& x) -> Vector3d {
      return {x[0], x[1], 0.05 * std::sin(std::numbers::pi * x[0] / length)};
    });
    model.start({});
    const double dt = 2e-3 / refine;
    for (int n = 0; n < model.count(); ++n) {
      const int column = n % (columns + 1);
      const int grip = column <= refine ? 1 : column >= columns - refine ? -1 : 0;
      if (grip == 0) continue;
      model.hold(n, n + 1);
      model.set_velocity(n, {1.0 * grip, 0, 0});
    }
    const int steps = static_cast<int>(2.0 / dt);
    int most_contacts = 0;
    for (int i = 0; i < steps; ++i) {
      model.step(dt);
      most_contacts = std::max(most_contacts, model.scene.step.active);
      if (i % 50 != 0) continue;
      ASSERT_EQ(audit(model.scene, model.nodes, team).missed(), 0) << refine << " step " << i;
    }
    EXPECT_GT(most_contacts, 0) << "it has folded onto itself";
    EXPECT_EQ(audit(model.scene, model.nodes, team).missed(), 0);
    EXPECT_LT(model.scene.totals.deepest_overlap, 0.01 * 0.25);
  }
}

// Of a cell that is warped by far the cross diagonal stands out of both triangles. A side from its fourth
// corner is led through it from above.
TEST(WarpedCell, ASideOfANeighbourDoesNotPassTheCrossDiagonal) {
  ThreadTeam team(1);
  SpringModel model;
  model.stiffness = 0;
  model.damping = 0;
  const std::array<Vector3d, 9> place{Vector3d{0, 0, -2}, {1, 0, 0}, {0.5, -0.5, 1.5},
                                      {0, 1, 0},          {1, 1, 0}, {0.2, 0.2, 0.5},
                                      {0, 2, -1},         {1, 2, 0}, {-0.5, 0.5, 1.5}};
  model.add_sheet({2, 2}, {2, 2}, 0.01, 1, [&](const Vector3d& x) {
    return place[static_cast<std::size_t>(std::lround(x[0]) + 3 * std::lround(x[1]))];
  });
  model.start({});
  for (const int held : {0, 2, 4, 5, 6, 7, 8}) model.hold(held, held + 1);
  model.set_velocity(5, {0, 0, -1});
  for (int step = 0; step < 80; ++step) {
    model.step(0.01);
    ASSERT_EQ(audit(model.scene, model.nodes, team).crossings, 0) << step;
  }
  EXPECT_LT(model.x(5)[2], -0.29);
  EXPECT_LT(model.x(1)[2] + model.x(3)[2], -0.1) << "the diagonal has been taken along";
}

}  // namespace
}  // namespace brio::test
