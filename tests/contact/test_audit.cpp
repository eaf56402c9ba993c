#include <gtest/gtest.h>

#include "contact/audit.hpp"
#include "tests/contact/spring_model.hpp"

namespace brio::test {
namespace {

void move_nodes(SpringModel& model, int first, int end, const Vector3d& by) {
  for (int n = first; n < end; ++n)
    for (int axis = 0; axis < 3; ++axis)
      model.nodes.record[static_cast<std::size_t>(n)].position[axis] += by[axis];
}

TEST(Audit, FindsAPlantedPenetrationOfSolids) {
  ThreadTeam team(1);
  SpringModel model;
  model.add_box({3, 3, 3}, {3, 3, 3}, 1, shifted({0, 0, 0}));
  const int upper = model.add_box({1, 1, 1}, {0.9, 0.9, 0.9}, 1, shifted({1, 1, 3.001}));
  model.start({});
  EXPECT_EQ(brute_force_audit(model.scene, model.nodes, team).missed(), 0);
  move_nodes(model, upper, model.count(), {0, 0, -0.05});
  EXPECT_EQ(brute_force_audit(model.scene, model.nodes, team).missed(), 0) << "shallower than a tenth";
  move_nodes(model, upper, model.count(), {0, 0, -0.1});
  const BruteForceAudit found = brute_force_audit(model.scene, model.nodes, team);
  EXPECT_EQ(found.inside_solids, 4);
  EXPECT_NEAR(found.deepest, 0.149, 1e-12);
  EXPECT_GE(found.deepest_node, upper);
}

// The normals of a flake turned inside out point inwards, so that whatever is beside it seems to be inside.
TEST(Audit, CountsNothingBesideAFlakeTurnedInsideOut) {
  ThreadTeam team(1);
  SpringModel model;
  model.add_box({1, 1, 1}, {1, 1, 1}, 1, shifted({0, 0, 0}));
  const int beside = model.add_box({1, 1, 1}, {1, 1, 1}, 1, shifted({0, 0, 1.3}));
  model.start({});
  for (int n = 0; n < beside; ++n) move_nodes(model, n, n + 1, {0, 0, 1 - 2 * model.x(n)[2]});
  EXPECT_EQ(brute_force_audit(model.scene, model.nodes, team).missed(), 0);
}

TEST(Audit, FindsShellsTooCloseAndPierced) {
  ThreadTeam team(1);
  SpringModel model;
  model.add_sheet({6, 6}, {6, 6}, 0.1, 1, shifted({0, 0, 0}));
  const int upper = model.add_sheet({4, 4}, {3, 3}, 0.1, 1, [](const Vector3d& x) -> Vector3d {
    return {1.1 + x[0], 1.2, 0.101 + x[1]};
  });
  model.start({});
  EXPECT_EQ(brute_force_audit(model.scene, model.nodes, team).missed(), 0);
  move_nodes(model, upper, model.count(), {0, 0, -0.02});
  const BruteForceAudit close = brute_force_audit(model.scene, model.nodes, team);
  EXPECT_EQ(close.shells_too_close, 5);
  EXPECT_EQ(close.shells_pierced, 0);
  move_nodes(model, upper, model.count(), {0, 0, -0.4});
  EXPECT_EQ(brute_force_audit(model.scene, model.nodes, team).shells_pierced, 5 + 3)
      << "its uprights, and columns of the lower";
}

// A bar folded upon itself: the node at the bottom of the cleft has material all around and a face of the
// other side of the bar near by, and is no penetration. Flanks that reach through each other are.
TEST(Audit, CountsNothingAtTheBottomOfAClosedCleft) {
  const auto folded = [](double angle) {
    return [angle](const Vector3d& x) -> Vector3d {
      const double along = x[2] - 2, side = along < 0 ? -1 : 1;
      if (along == 0) return {-x[0], -x[1], 0};
      const double c = std::cos(angle), s = std::sin(angle), reach = std::abs(along);
      return {c * reach - s * x[0], -x[1], side * (s * reach + c * x[0])};
    };
  };
  const auto missed = [&](double angle) {
    ThreadTeam team(1);
    SpringModel open, closed;
    open.add_box({2, 2, 4}, {0.6, 2, 4}, 1, folded(0.1));
    closed.add_box({2, 2, 4}, {0.6, 2, 4}, 1, folded(angle));
    open.start({});
    closed.start({});
    for (int n = 0; n < open.count(); ++n) move_nodes(open, n, n + 1, closed.x(n) - open.x(n));
    return brute_force_audit(open.scene, open.nodes, team).missed();
  };
  EXPECT_EQ(missed(0.1), 0);
  EXPECT_EQ(missed(0), 0);
  EXPECT_EQ(missed(-0.03), 0);
  EXPECT_GT(missed(-0.15), 0);
}

TEST(Audit, FindsASolidThatCutsItself) {
  ThreadTeam team(1);
  SpringModel model;
  // A bar bent into an open ring, then the ends pushed into each other.
  const int cells = 16;
  model.add_box({1, 1, cells}, {1, 1, 2}, 1, [](const Vector3d& x) -> Vector3d {
    const double angle = std::numbers::pi * 0.95 * x[2];
    return {(3 + x[0]) * std::cos(angle), x[1], (3 + x[0]) * std::sin(angle)};
  });
  model.start({});
  EXPECT_EQ(brute_force_audit(model.scene, model.nodes, team).missed(), 0);
  // The first section, made narrower, is turned back until it lies inside the last cell.
  for (int n = 0; n < 4; ++n) {
    const double angle = -0.16 * std::numbers::pi;
    const double radius = n % 2 == 0 ? 3.3 : 3.7;
    move_nodes(model, n, n + 1,
               Vector3d(radius * std::cos(angle), n < 2 ? 0.3 : 0.7, radius * std::sin(angle)) - model.x(n));
  }
  EXPECT_EQ(brute_force_audit(model.scene, model.nodes, team).inside_solids, 4);
}

}  // namespace
}  // namespace brio::test
