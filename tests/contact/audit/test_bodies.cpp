/// Bodies that reach into others and into themselves.

#include <gtest/gtest.h>

#include "contact/audit/audit.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"

namespace brio::test {
namespace {

void move_nodes(SpringModel& model, int first, int end, const Vector3d& by) {
  for (int n = first; n < end; ++n)
    for (int axis = 0; axis < 3; ++axis) model.nodes.record[index(n)].position[axis] += by[axis];
}

TEST(AuditBodies, FindsAPlantedPenetrationHoweverShallow) {
  ThreadTeam team(1);
  SpringModel model;
  model.add_box({3, 3, 3}, {3, 3, 3}, 1, shifted({0, 0, 0}));
  const int upper = model.add_box({1, 1, 1}, {0.9, 0.9, 0.9}, 1, shifted({1.03, 1.04, 3.001}));
  model.start({});
  EXPECT_EQ(audit(model.scene, model.nodes, team).missed(), 0);
  move_nodes(model, upper, model.count(), {0, 0, -0.0010001});
  const Audit shallow = audit(model.scene, model.nodes, team);
  EXPECT_EQ(shallow.crossings, 4) << "its sides with one face";
  EXPECT_EQ(shallow.deep(), 0);
  move_nodes(model, upper, model.count(), {0, 0, -0.149});
  const Audit deep = audit(model.scene, model.nodes, team);
  EXPECT_EQ(deep.deep_crossings, 4);
  EXPECT_GE(deep.deepest_crossing.node, upper);
}

// A bar folded upon itself: flanks that lie on each other are no crossing, flanks that reach through are.
TEST(AuditBodies, CountsNothingAtTheBottomOfAClosedCleft) {
  const auto folded = [](double angle) {
    return [angle](const Vector3d& x) -> Vector3d {
      const double along = x[2] - 2, side = along < 0 ? -1 : 1;
      if (along == 0) return {-x[0], -x[1], 0};
      const double c = std::cos(angle), s = std::sin(angle), reach = std::abs(along);
      return {c * reach - s * x[0], -x[1], side * (s * reach + c * x[0])};
    };
  };
  const auto found = [&](double angle) {
    ThreadTeam team(1);
    SpringModel open, closed;
    open.add_box({2, 2, 4}, {0.6, 2, 4}, 1, folded(0.1));
    closed.add_box({2, 2, 4}, {0.6, 2, 4}, 1, folded(angle));
    open.start({});
    closed.start({});
    for (int n = 0; n < open.count(); ++n) move_nodes(open, n, n + 1, closed.x(n) - open.x(n));
    return audit(open.scene, open.nodes, team);
  };
  EXPECT_EQ(found(0.1).missed(), 0);
  EXPECT_EQ(found(0).missed(), 0);
  EXPECT_GT(found(-0.03).crossings, 0);
  EXPECT_GT(found(-0.15).crossings, 0);
}

TEST(AuditBodies, FindsASolidThatCutsItself) {
  ThreadTeam team(1);
  SpringModel model;
  // A bar bent into an open ring, then the ends pushed into each other.
  model.add_box({1, 1, 16}, {1, 1, 2}, 1, [](const Vector3d& x) -> Vector3d {
    const double angle = std::numbers::pi * 0.95 * x[2];
    return {(3 + x[0]) * std::cos(angle), x[1], (3 + x[0]) * std::sin(angle)};
  });
  model.start({});
  EXPECT_EQ(audit(model.scene, model.nodes, team).missed(), 0);
  // The first section, made narrower, is turned back until it lies inside the last cell.
  for (int n = 0; n < 4; ++n) {
    const double angle = -0.16 * std::numbers::pi;
    const double radius = n % 2 == 0 ? 3.3 : 3.7;
    move_nodes(model, n, n + 1,
               Vector3d{radius * std::cos(angle), n < 2 ? 0.3 : 0.7, radius * std::sin(angle)} - model.x(n));
  }
  const Audit found = audit(model.scene, model.nodes, team);
  EXPECT_EQ(found.crossings, 4) << "four sides with the end";
  EXPECT_EQ(found.deep_crossings, 3);
}

// What deletions leave free within a solid is not swallowed by it; what gets into its walls is.
TEST(AuditBodies, CountsNothingInACavity) {
  ThreadTeam team(1);
  SpringModel model;
  model.add_box({7, 7, 7}, {7, 7, 7}, 1, shifted({0, 0, 0}));
  model.start_erodible({});
  const auto element = [](int i, int j, int k) { return SurfaceElement{0, i + 7 * (j + 7 * k)}; };
  model.erode(std::vector<SurfaceElement>{element(1, 1, 1)});
  EXPECT_EQ(audit(model.scene, model.nodes, team).missed(), 0);
  std::vector<SurfaceElement> around;
  for (int k = 2; k < 5; ++k)
    for (int j = 2; j < 5; ++j)
      for (int i = 2; i < 5; ++i)
        if (i != 3 || j != 3 || k != 3) around.push_back(element(i, j, k));
  model.erode(around);
  EXPECT_EQ(audit(model.scene, model.nodes, team).missed(), 0);
  const Vector3d middle{3.5, 3.5, 3.5}, in_wall{5.9, 3.6, 3.4};
  for (int k = 3; k < 5; ++k)
    for (int j = 3; j < 5; ++j)
      for (int i = 3; i < 5; ++i) {
        const int node = i + 8 * (j + 8 * k);
        move_nodes(model, node, node + 1, in_wall - middle - 0.7 * (model.x(node) - middle));
      }
  const Audit found = audit(model.scene, model.nodes, team);
  EXPECT_EQ(found.crossings, 0);
  EXPECT_EQ(found.swallowed, 1);
}

}  // namespace
}  // namespace brio::test
