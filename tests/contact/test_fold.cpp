#include <gtest/gtest.h>

#include <random>

#include "contact/audit/audit.hpp"
#include "contact/geometry/closest_segments.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"
#include "tests/rotation_about.hpp"

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
    model.add_sheet({columns, refine}, {length, 0.5}, 0.25, 1, [&](const Vector3d& x) -> Vector3d {
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
    double approach = 0;  // of two nodes in a step
    for (int i = 0; i < steps; ++i) {
      model.step(dt);
      for (int n = 0; n < model.count(); ++n) approach = std::max(approach, 2 * dt * norm(model.v(n)));
      most_contacts = std::max(most_contacts, model.scene.step.active);
      if (i % 50 != 0) continue;
      ASSERT_EQ(audit(model.scene, model.nodes, team).missed(), 0) << refine << " step " << i;
    }
    EXPECT_GT(most_contacts, 0) << "it has folded onto itself";
    EXPECT_EQ(audit(model.scene, model.nodes, team).missed(), 0);
    // Cells of a quarter of the thickness meet within it as the fold bends: by chance 0.9 to 1.1 % of it
    // lack.
    EXPECT_LT(model.scene.totals.deepest_overlap, refine < 4 ? 0.01 * 0.25 : approach);
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
  model.add_sheet({2, 2}, {2, 2}, 0.01, 1,
                  [&](const Vector3d& x) { return place[index(std::lround(x[0]) + 3 * std::lround(x[1]))]; });
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

// The sharp edge of a bar that is pressed on a sheet whose cells are warped by less than counts: their
// diagonals are no features, and no corner that lies a little nearer may let a side go.
TEST(WarpedCells, KeepTheirThicknessFromASharpEdge) {
  constexpr double thickness = 0.5;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 engine(seed);
    const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(engine); };
    SpringModel model;
    const int across = 6;
    model.add_sheet({across, across}, {1.0 * across, 1.0 * across}, thickness, 1, [&](const Vector3d& x) {
      return Vector3d{x[0] + 0.1 * number(), x[1] + 0.1 * number(), 0.0035 * number()};
    });
    const double turn = 0.3 + 0.2 * number();
    const Tensor<double> rotation =
        rotation_about(turn, Vector3d{0, 0, 1}) * rotation_about(0.25 * std::numbers::pi, Vector3d{1, 0, 0});
    const int first = model.add_box({1, 1, 1}, {8, 1, 1}, 1, [&](const Vector3d& x) -> Vector3d {
      return rotation * (x - Vector3d{4, 0, 0}) + Vector3d{3, 3, 0.5 * thickness + 0.02};
    });
    model.start({});
    for (int n = 0; n < first; ++n) model.hold(n, n + 1);
    for (int n = first; n < model.count(); ++n) model.set_velocity(n, {0, 0, -1});
    model.gravity = {0, 0, -10};
    model.damping = 1;
    double least = 1;
    for (int step = 0; step < 1000; ++step) {
      model.step(1e-3);
      for (int j = 0; j <= across; ++j)
        for (int i = 0; i <= across; ++i)
          for (const auto& [di, dj] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
            if (i + di > across || j + dj > across || j + dj < 0) continue;
            const int from = i + (across + 1) * j, to = i + di + (across + 1) * (j + dj);
            const ClosestSegments seen = closest_points_of_segments({model.x(from), model.x(to)},
                                                                    {model.x(first), model.x(first + 1)});
            least = std::min(least, std::sqrt(seen.squared_distance));
          }
    }
    EXPECT_GT(least, 0.99 * 0.5 * thickness) << seed << ": diagonals that are no features stand out a little";
    EXPECT_GT(model.scene.step.active, 0);
  }
}

}  // namespace
}  // namespace brio::test
