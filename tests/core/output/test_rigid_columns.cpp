// Motion of rigid parts in the history against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "src/output/rigid_columns.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// A cube that flies and turns about an axis that is none of its own: all of its axes are principal.
TEST(RigidColumns, OfAFreeCubeAreThoseOfUniformMotion) {
  const Vector3d velocity{3, -2, 1}, spin{1, 2, 2};  // 3 radians a second
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("wall", {1, 1, 1}, {1, 1, 1}, {9, 9, 9}, hex8()),
                box("cube", {1, 1, 1}, {2, 2, 2}, {0.5, 0.25, -2}, Rigid{})};
  deck.initial_conditions = {moving("cube", velocity)};
  deck.initial_conditions[0].spin = Spin{{0.5, 0.25, -2}, spin};
  deck.output.history.rigid_bodies = true;
  deck.time.end = 2;
  Model model = build_model(deck);
  std::vector<std::string> columns;
  add_rigid_columns(model, columns);
  ASSERT_EQ(columns, (std::vector<std::string>{"cube.centre_x", "cube.centre_y", "cube.centre_z",
                                               "cube.rotation_x", "cube.rotation_y", "cube.rotation_z"}));
  ThreadTeam team(1);
  bool turned_back = false;
  double lag = 0, before = 0;
  run(model, deck, team, [&](Model& now) {
    std::vector<double> row;
    add_rigid_values(now, row);
    const double t = now.times.time;
    // In a step the attitude turns by twice the arc tangent of half the angle.
    lag += std::pow(3 * (t - before), 3) / 12;
    before = t;
    double angle = std::remainder(3 * t, 2 * std::numbers::pi);
    turned_back = turned_back || angle < 0;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(row.at(i), (Vector3d{0.5, 0.25, -2})[i] + velocity[i] * t, 1e-12) << t;
      EXPECT_NEAR(row.at(3 + i), (angle - lag) * spin[i] / 3, 1e-3 * lag + 1e-11) << t;
    }
  });
  EXPECT_TRUE(turned_back) << "beyond half a turn the shorter way is told";
}

TEST(RigidColumns, AreRefusedWhereNoPartIsRigid) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("cube", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, hex8())};
  deck.output.history.rigid_bodies = true;
  EXPECT_THROW(build_model(deck), BuildError);
}

}  // namespace
}  // namespace brio
