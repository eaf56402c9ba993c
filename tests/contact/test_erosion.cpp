#include "contact/erosion.hpp"

#include <gtest/gtest.h>

#include <random>

#include "contact/audit/audit.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"
#include "tests/rotation_about.hpp"

namespace brio::test {
namespace {

std::vector<SurfaceElement> some_of(std::vector<SurfaceElement>& living, std::size_t count,
                                    std::mt19937& random) {
  std::shuffle(living.begin(), living.end(), random);
  count = std::min(count, living.size());
  const std::vector<SurfaceElement> chosen(living.end() - static_cast<std::ptrdiff_t>(count), living.end());
  living.resize(living.size() - count);
  return chosen;
}

std::vector<SurfaceElement> elements_of_parts(std::initializer_list<int> counts) {
  std::vector<SurfaceElement> all;
  int part = 0;
  for (int count : counts) {
    for (int e = 0; e < count; ++e) all.push_back({part, e});
    ++part;
  }
  return all;
}

// A block thrown at another and at a sheet.
void build_impact(SpringModel& model, const ContactOptions& options) {
  model.stiffness = 10;
  model.add_box({4, 4, 3}, {0.8, 0.8, 0.6}, 1, shifted({0, 0, 0}));
  model.throw_from(model.add_box({3, 3, 2}, {0.6, 0.6, 0.4}, 1, shifted({0.13, 0.17, 0.61})), {0.1, 0, -1});
  model.throw_from(model.add_sheet({4, 4}, {1, 1}, 0.05, 20, shifted({-0.1, -0.1, 1.1})), {0, 0.1, -2});
  model.start_erodible(options);
}
constexpr std::initializer_list<int> impact_elements{48, 18, 16};

TEST(Erosion, SameBitsForAnyNumberOfThreads) {
  std::vector<Vector3d> first;
  for (const int threads : {1, 2, 4}) {
    ThreadTeam team(threads);
    ContactOptions options;
    options.friction = 0.2;
    SpringModel model;
    build_impact(model, options);
    std::mt19937 random(6);
    std::vector<SurfaceElement> living = elements_of_parts(impact_elements);
    for (int i = 0; i < 200; ++i) {
      model.step(1e-3, team);
      if (i % 3 == 0) model.erode(some_of(living, 1, random));
    }
    std::vector<Vector3d> end;
    for (int n = 0; n < model.count(); ++n) end.push_back(model.x(n));
    if (first.empty()) first = end;
    for (std::size_t n = 0; n < end.size(); ++n) ASSERT_EQ(first[n], end[n]) << threads << " threads";
    EXPECT_GT(model.scene.totals.contacts, 1000U);
  }
}

// A block whose thin middle layer goes while both halves are pressed together: what is laid bare meets in the
// very next step.
TEST(Erosion, FacesLaidBareTouchInTheSameStep) {
  for (const bool turned : {false, true}) {
    SpringModel model;
    const Tensor<double> turn = turned ? rotation_about(0.7, Vector3d{1, 2, 3}) : identity<double>();
    const double layer = 1e-3;
    model.stiffness = 200;
    const int nodes = 4 * 4 * 8;
    model.add_box({3, 3, 7}, {3, 3, 7}, 1, [&](const Vector3d& x) -> Vector3d {
      return turn * Vector3d{x[0], x[1], x[2] < 3.5 ? x[2] : x[2] - 1 + layer};
    });
    model.start_erodible({});
    for (int n = 0; n < nodes; ++n) model.set_velocity(n, turn * Vector3d{0, 0, n < nodes / 2 ? 0.5 : -0.5});
    const double dt = 5e-3;
    resolve(model.scene, model.nodes, 1e-9, model.alone());
    EXPECT_TRUE(model.scene.contacts.empty());
    std::vector<SurfaceElement> middle;
    for (int e = 27; e < 36; ++e) middle.push_back({0, e});
    model.erode(middle);
    const Vector3d momentum = model.momentum();
    const Vector3d moment = model.angular_momentum();
    ThreadTeam team(1);
    for (int i = 0; i < 400; ++i) {
      model.step(dt);
      if (i == 0) {
        EXPECT_GE(model.scene.step.active, 16) << "every node of one side at least";
      }
      if (i % 20 != 0) continue;
      ASSERT_EQ(audit(model.scene, model.nodes, team).missed(), 0) << i;
    }
    const double scale = 0.5 * 7 * 9;
    EXPECT_LT(norm(model.momentum() - momentum), 1e-12 * scale);
    EXPECT_LT(norm(model.angular_momentum() - moment), 1e-11 * scale);
    const double between =
        transposed_times(turn, model.mean_velocity(nodes / 2, nodes) - model.mean_velocity(0, nodes / 2))[2];
    EXPECT_GT(between, 0.3) << "they have bounced";
    EXPECT_LT(model.scene.totals.deepest_overlap, 1e-2 * layer);
  }
}

// Two cubes that have nothing but an edge in common, one above and to the right of the other: the normals of
// the nodes of that edge cancel, but what comes from below under the upper one has to carry them.
TEST(Erosion, NodesOfAPinchedEdgeAreCarried) {
  SpringModel model;
  model.stiffness = 100;
  model.add_box({2, 1, 2}, {2, 1, 2}, 1, [](const Vector3d& x) -> Vector3d {
    const Vector3d p = x - Vector3d{1, 0, 1};
    return {p[0] + 0.5 * std::min(p[2], 0.0), p[1], p[2]};
  });
  const int below = model.add_box({1, 1, 1}, {0.6, 1.4, 0.5}, 1, shifted({-0.003, -0.2, -0.51}));
  model.throw_from(below, {0, 0, 1});
  model.start_erodible({});
  model.erode(std::vector<SurfaceElement>{{0, 1}, {0, 2}});
  const Surface& surface = model.scene.surface;
  const std::array<int, 2> edge{surface.slave(7), surface.slave(10)};
  for (int slave : edge) {
    EXPECT_EQ(surface.pinched[index(slave)], 1);
    EXPECT_LT(dot(vertex_normal(surface, model.nodes, slave), Vector3d{0, 0, 1}), 0.1);
  }
  model.step(0.02);
  int carried = 0;
  for (const Contact& contact : model.scene.contacts)
    carried += (contact.slave == edge[0] || contact.slave == edge[1]) && contact.normal[2] > 0.99;
  EXPECT_EQ(carried, 2);
}

// One large brick comes down on a block whose thin skin goes: it has no nodes over the block, so that only
// the nodes laid bare can carry it.
TEST(Erosion, NodesLaidBareCarryWhatComesDown) {
  SpringModel model;
  model.stiffness = 200;
  const double skin = 1e-3;
  model.add_box({3, 3, 4}, {3, 3, 4}, 1, [&](const Vector3d& x) -> Vector3d {
    return {x[0], x[1], x[2] < 3.5 ? x[2] : 3 + skin};
  });
  const int brick = model.add_box({1, 1, 1}, {6, 6, 3}, 1, shifted({-1.5, -1.5, 3 + 2 * skin}));
  model.throw_from(brick, {0, 0, -1});
  model.start_erodible({});
  resolve(model.scene, model.nodes, 1e-9, model.alone());
  std::vector<SurfaceElement> top;
  for (int e = 27; e < 36; ++e) top.push_back({0, e});
  model.erode(top);
  ThreadTeam team(1);
  for (int i = 0; i < 50; ++i) {
    model.step(2e-3);
    if (i == 0) {
      int nodes = 0;
      for (const Contact& contact : model.scene.contacts) nodes += contact.of_edges() ? 0 : 1;
      EXPECT_EQ(nodes, 16) << "twelve at the rim and four that were inside";
    }
    ASSERT_EQ(audit(model.scene, model.nodes, team).missed(), 0) << i;
  }
  EXPECT_LT(model.scene.totals.deepest_overlap, 0.1 * skin);
}

// What has nothing to do with the deleted elements goes on to the last bit, with its history.
TEST(Erosion, OtherContactsGoOnUnchanged) {
  ContactOptions options;
  options.friction = 0.3;
  SpringModel model[2];
  for (SpringModel& m : model) {
    m.gravity = {2, 0, -10};
    m.add_box({12, 3, 1}, {12, 3, 1}, 1, shifted({0, 0, 0}));
    m.add_box({2, 2, 1}, {1, 1, 0.5}, 1, shifted({1.1, 1.2, 1.0005}));
    m.start_erodible(options);
    m.hold(0, 13 * 4 * 2);
    for (int i = 0; i < 300; ++i) m.step(1e-4);
  }
  ASSERT_GT(model[0].scene.step.active, 2);
  model[1].erode(std::vector<SurfaceElement>{{0, 10}, {0, 11}, {0, 22}, {0, 34}});
  for (int i = 0; i < 100; ++i) {
    for (SpringModel& m : model) m.step(1e-4);
    for (int n = 13 * 4 * 2; n < model[0].count(); ++n) {
      ASSERT_EQ(model[0].x(n), model[1].x(n)) << "step " << i;
      ASSERT_EQ(model[0].v(n), model[1].v(n));
    }
  }
}

TEST(Erosion, EverythingMayGoWhileInContact) {
  SpringModel model;
  build_impact(model, {});
  for (int i = 0; i < 60; ++i) model.step(1e-3);
  ASSERT_GT(model.scene.step.active, 0);
  model.erode(elements_of_parts(impact_elements));
  for (int i = 0; i < 60; ++i) {
    model.step(1e-3);
    ASSERT_EQ(model.scene.step.contacts, 0);
  }
}

// A brick slides over a floor whose elements vanish under it, and falls to the floor below.
TEST(Erosion, ABrickFallsThroughWhatVanishesAndNotThroughWhatRemains) {
  SpringModel model;
  model.gravity = {0, 0, -10};
  model.stiffness = 100;
  const int floor = model.add_box({12, 4, 2}, {6, 2, 1}, 1, shifted({0, 0, 0}));
  const int brick = model.add_box({3, 3, 1}, {1.2, 1.2, 0.4}, 1, shifted({0.5, 0.4, 1.0}));
  model.throw_from(brick, {2, 0, 0});
  model.start_erodible({});
  model.hold(floor, brick);
  model.make_gap();
  model.damping = 0.5;
  ThreadTeam team(1);
  const double dt = 1e-3;
  int column = 0;
  for (int i = 0; i < 2000; ++i) {
    model.step(dt);
    if (i % 100 == 50 && column < 12) {  // the upper layer goes, column by column
      std::vector<SurfaceElement> gone;
      for (int j = 0; j < 4; ++j) gone.push_back({0, column + 12 * (j + 4)});
      model.erode(gone);
      ++column;
    }
    if (i % 50 != 0) continue;
    ASSERT_EQ(audit(model.scene, model.nodes, team).missed(), 0) << i;
  }
  EXPECT_EQ(column, 12);
  double lowest = HUGE_VAL;
  for (int n = brick; n < model.count(); ++n) lowest = std::min(lowest, model.x(n)[2]);
  EXPECT_NEAR(lowest, 0.5, 0.02) << "on what was inside";
}

// A shell of cells smaller than its thickness, torn along a line: the sides of the tear are closer than they
// may touch. Nothing pushes them; once they have been apart they do touch.
TEST(Erosion, ATornShellDoesNotPushItselfApart) {
  SpringModel model;
  const int cells = 12;
  const double thickness = 0.4;
  model.add_sheet({cells, 4}, {3, 1}, thickness, 1, shifted({0, 0, 0}));  // cells of 0.25
  model.start_erodible({});
  std::vector<SurfaceElement> line;
  for (int j = 0; j < 4; ++j) line.push_back({0, 6 + cells * j});
  model.erode(line);
  for (int i = 0; i < 50; ++i) {
    model.step(1e-3);
    ASSERT_EQ(model.scene.step.active, 0);
  }
  const auto column = [](int n) { return n % (cells + 1); };
  const auto gap = [&] {
    double nearest = HUGE_VAL;
    for (int n = 0; n < model.count(); ++n)
      for (int m = 0; m < model.count(); ++m)
        if (column(n) == 6 && column(m) == 7) nearest = std::min(nearest, norm(model.x(n) - model.x(m)));
    return nearest;
  };
  const auto drive = [&](double speed) {
    for (int n = 0; n < model.count(); ++n) model.set_velocity(n, {column(n) > 6 ? speed : 0, 0, 0});
  };
  const double dt = 2e-4;  // stable for springs of these cells
  drive(4);
  for (int i = 0; i < 500; ++i) model.step(dt);
  ASSERT_GT(gap(), 1.5 * thickness);
  drive(-4);
  for (int i = 0; i < 1000; ++i) {
    model.step(dt);
    ASSERT_GT(gap(), 0.9 * thickness) << "step " << i;
  }
}

}  // namespace
}  // namespace brio::test
