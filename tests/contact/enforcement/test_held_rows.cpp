/// Rows that nothing, or hardly anything, can move carry nothing.

#include <gtest/gtest.h>

#include "tests/contact/enforcement/row_scenes.hpp"

namespace brio {
namespace {

using namespace test;

// A node of a shell that is fixed, but may rotate, under a node that is driven into it: rotation about the
// normal moves nothing along it, whatever rounding says.
TEST(HeldRows, WhatOnlyTurnsAboutTheNormalIsHeld) {
  RandomNumbers random(7);
  for (int i = 0; i < 100; ++i) {
    RowScene scene;
    const Vector3d normal = random.direction();
    scene.blocks = {VelocityBlock{-1.0 * normal, isotropic(0.0)}, VelocityBlock{{0, 0, 0}, isotropic(0.0)},
                    moving(0.1, {0, 0, 0})};
    scene.rows.add_row(normal, 0, i % 2 == 0 ? 0 : 0.3).impulse = 1;
    scene.rows.add_point(0, Side::first);
    scene.rows.add_turning_point(1, 2, 0.1, Side::second);
    solve(scene, {50, 1e-6});
    EXPECT_EQ(scene.rows.row[0].impulse, 0);
    EXPECT_EQ(norm(scene.blocks[2].velocity), 0);
  }
}

/// A fixed node is driven against a point between a fixed and a free node, or a free node along its own
/// normal alone. \param share of the free node, or what of its other motion the point sees.
RowScene nearly_held(double share, bool by_matrix, double friction) {
  RowScene scene;
  scene.blocks = {VelocityBlock{{-1, 0, 0}, isotropic(0.0)}, VelocityBlock{{0, 0, 0}, isotropic(0.0)},
                  moving(0.1, {0, 0, 0})};
  if (by_matrix) scene.blocks[2].inverse_mass.xx = 0;
  scene.rows.add_row({1, 0, 0}, 0, friction).impulse = 1;
  scene.rows.add_point(0, Side::first);
  if (by_matrix) {
    Tensor<double> seen;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) seen.m[i][j] = i == j ? -1 : 0;
    seen.m[0][2] = share;
    scene.rows.add_matrix(2, seen);
  } else {
    scene.rows.add_point(1, Side::second, 1 - share);
    scene.rows.add_point(2, Side::second, share);
  }
  return scene;
}

// Two nodes on a line of symmetry that meet across it: what turns them moves the row by a millionth, and the
// impulse that stops it threw both out of the model.
TEST(HeldRows, WhatHardlyMovesIsHeld) {
  for (const bool by_matrix : {false, true})
    for (const double friction : {0.0, 0.3}) {
      for (const double share : {0.0, 1e-9, 1e-6, 9e-4}) {
        RowScene scene = nearly_held(share, by_matrix, friction);
        solve(scene, {200, 1e-6});
        EXPECT_EQ(scene.rows.row[0].impulse, 0) << share << by_matrix;
        EXPECT_EQ(norm(scene.blocks[2].velocity), 0) << share << by_matrix;
      }
      if (friction > 0) continue;  // it jams where there is more friction than slope
      RowScene scene = nearly_held(0.01, by_matrix, 0);
      solve(scene, to_the_end());
      EXPECT_NEAR(scene.relative_velocity(0).x, 0, 1e-9) << by_matrix;
      EXPECT_NEAR(norm(scene.blocks[2].velocity), 100, 1e-6) << by_matrix;
    }
}

}  // namespace
}  // namespace brio
