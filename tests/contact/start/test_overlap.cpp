#include <gtest/gtest.h>

#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"
#include "tests/rotation_about.hpp"

namespace brio::test {
namespace {

// Two blocks of unit cells, the upper one sunk in by `depth`, turned a little so that nodes meet faces.
void overlap_blocks(SpringModel& model, double depth, double limit, int across = 3) {
  model.add_box({across, across, 3}, {1.0 * across, 1.0 * across, 3}, 1, shifted({0, 0, 0}));
  const double aside = 0.5 * (across - 3);
  model.add_box({2, 2, 2}, {2, 2, 2}, 1, [&](const Vector3d& x) -> Vector3d {
    return rotation_about(0.3, Vector3d{0, 0, 1}) * x + Vector3d{0.8 + aside, 0.4 + aside, 3 - depth};
  });
  ContactOptions options;
  options.initial_overlap_limit = limit;
  model.start(options);
}

TEST(InitialOverlap, IsRemovedWithoutStrainOrMotion) {
  ThreadTeam team(1);
  for (const double depth : {1e-12, 1e-3, 0.15, 0.5}) {
    SpringModel model;
    overlap_blocks(model, depth, 0.6, 4);  // corners are farther from the sides than deep
    const auto report = make_initial_gap(model.scene, model.nodes, team);
    if (depth > 1e-9) {
      ASSERT_FALSE(report.empty()) << depth;
      EXPECT_NEAR(report.front().depth, depth, 1e-9);
      EXPECT_LT(report.front().moved, 1.001 * (depth + report.front().gap));
    }
    model.rest();
    for (int i = 0; i < 50; ++i) model.step(1e-3);
    EXPECT_LT(model.scene.totals.deepest_overlap, 1e-8);
    EXPECT_LT(model.kinetic_energy() + model.spring_energy(), 1e-14) << depth;
  }
}

TEST(InitialOverlap, BeyondTheLimitNamesPartsAndDepth) {
  ThreadTeam team(1);
  SpringModel model;
  overlap_blocks(model, 0.5, 0.2);
  try {
    make_initial_gap(model.scene, model.nodes, team);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("part 0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("part 1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("0.5"), std::string::npos) << error.what();
  }
}

// A corner that is nearer to a side than it is deep seems to have come through that side.
TEST(InitialOverlap, CornersThatAreLeftInsideAreRefused) {
  ThreadTeam team(1);
  SpringModel model;
  overlap_blocks(model, 0.5, 0.6);
  try {
    make_initial_gap(model.scene, model.nodes, team);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'part 1' lies in part 'part 0'"), std::string::npos)
        << error.what();
  }
}

TEST(InitialOverlap, SheetsTooCloseAreMovedToTheirThickness) {
  ThreadTeam team(1);
  SpringModel model;
  model.add_sheet({4, 4}, {4, 4}, 0.1, 1, shifted({0, 0, 0}));
  const int upper = model.add_sheet({5, 5}, {3, 3}, 0.1, 1, shifted({0.3, 0.2, 0.09}));
  model.start({});
  const auto report = make_initial_gap(model.scene, model.nodes, team);
  ASSERT_FALSE(report.empty());
  EXPECT_NEAR(report.front().depth, 0.01, 1e-12);
  EXPECT_NEAR(model.centre(upper, model.count())[2] - model.centre(0, upper)[2], 0.1, 0.02);
}

TEST(InitialOverlap, HeldPartStaysWhereItIs) {
  ThreadTeam team(1);
  SpringModel model;
  overlap_blocks(model, 0.1, 0.2);
  model.hold(0, 64);
  make_initial_gap(model.scene, model.nodes, team);
  EXPECT_EQ(model.x(63), (Vector3d{3, 3, 3}));
  double lowest = 10;
  for (int n = 64; n < model.count(); ++n) lowest = std::min(lowest, model.x(n)[2]);
  EXPECT_NEAR(lowest, 3 + 2 * model.scene.features.skin, 1e-8);
}

// What cannot be removed is told before anything moves, not after many rounds.
TEST(InitialOverlap, BetweenPartsThatAreBothHeldIsRefusedAtOnce) {
  ThreadTeam team(1);
  SpringModel model;
  model.add_sheet({4, 4}, {4, 4}, 0.1, 1, shifted({0, 0, 10}));
  model.add_sheet({5, 5}, {3, 3}, 0.1, 1, shifted({0.3, 0.2, 10.095}));
  const int first = model.count();
  overlap_blocks(model, 0.1, 0.2);
  model.hold(first, model.count());
  std::vector<Vector3d> start;
  for (int n = 0; n < model.count(); ++n) start.push_back(model.x(n));
  try {
    make_initial_gap(model.scene, model.nodes, team);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("which moving nodes does not remove"), std::string::npos)
        << error.what();
  }
  for (int n = 0; n < model.count(); ++n) EXPECT_EQ(model.x(n), start[index(n)]) << n;
}

}  // namespace
}  // namespace brio::test
