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

}  // namespace
}  // namespace brio::test
