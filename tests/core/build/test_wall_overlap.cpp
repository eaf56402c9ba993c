// Meshes that begin behind rigid walls, and prescribed motions that walls do not allow.

#include <gtest/gtest.h>

#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

RigidWall wall_at(Vector3d point, Vector3d normal, Vector3d velocity = {}) {
  RigidWall wall;
  wall.point = point;
  wall.normal = normal;
  wall.velocity = velocity;
  return wall;
}

/// A body of edges of 0.1 whose lowest node is `depth` behind a wall.
Deck body_in_wall(Kind kind, double depth, bool upright = false) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Part part = body(kind, "body");
  if (upright) part.placement.rotate = Rotation{{0, 1, 0}, 90};
  double lowest = HUGE_VAL;
  for (const Vector3d& x : generate_mesh(part.mesh, part.placement).position) lowest = std::min(lowest, x[2]);
  deck.parts = {part};
  deck.boundary_conditions = {wall_at({0, 0, lowest + depth}, {0, 0, 3})};
  deck.time.end = 2e-3;
  return deck;
}

double fastest_node(const Model& model) {
  double fastest = 0;
  for (const NodeRecord& node : model.nodes.record)
    fastest = std::max(fastest, std::hypot(node.velocity[0], node.velocity[1], node.velocity[2]));
  return fastest;
}

double lowest_height(const Model& model) {
  double lowest = HUGE_VAL;
  for (const WallInRun& wall : model.walls)
    for (const NodeRecord& node : model.nodes.record) {
      double height = 0;
      for (std::size_t i = 0; i < 3; ++i)
        height += wall.wall.normal[i] * (node.position[i] - wall.wall.point[i]);
      lowest = std::min(lowest, height);
    }
  return lowest;
}

double fastest_in_run(const Deck& deck, Model& model) {
  ThreadTeam team(1);
  double fastest = 0;
  run(model, deck, team, [&](Model& m) { fastest = std::max(fastest, fastest_node(m)); });
  return fastest;
}

std::string refusal_of(const Deck& deck) {
  try {
    build_model(deck);
  } catch (const BuildError& fault) {
    return fault.place + ": " + fault.what();
  }
  return {};
}

class WallOverlap : public testing::TestWithParam<Kind> {};

TEST_P(WallOverlap, IsRemovedWithoutThrowingTheBodyOff) {
  for (const double depth : {1e-12, 1e-5, 1e-3, 0.01, 0.0199})
    for (const bool upright : {false, true}) {
      const Deck deck = body_in_wall(GetParam(), depth, upright);
      Model model = build_model(deck);
      EXPECT_GE(lowest_height(model), -1e-15) << depth;
      ASSERT_EQ(model.initial_overlaps.size(), depth < 1e-10 ? 0U : 1U) << depth;
      if (depth >= 1e-10) {
        EXPECT_EQ(model.initial_overlaps[0].node_part, "body");
        EXPECT_EQ(model.initial_overlaps[0].face_part, "rigid_wall");
        EXPECT_NEAR(model.initial_overlaps[0].depth, depth, 1e-12);
        EXPECT_NEAR(model.initial_overlaps[0].moved, depth, 1e-12);
      }
      EXPECT_LT(fastest_in_run(deck, model), 1e-8) << depth << (upright ? " upright" : " flat");
      EXPECT_LT(model.energy.internal, 1e-12);
    }
}

TEST_P(WallOverlap, OfMoreThanAFifthOfAnEdgeIsRefusedByName) {
  const std::string said = refusal_of(body_in_wall(GetParam(), 0.021));
  EXPECT_NE(said.find("of part 'body' at ("), std::string::npos) << said;
  EXPECT_NE(said.find("begins behind the rigid wall by 0.021, deeper than 0.2 of"), std::string::npos)
      << said;
  Deck deck = body_in_wall(GetParam(), 0.021);
  deck.contact.emplace();
  deck.contact->options.initial_overlap_limit = 0.3;
  EXPECT_EQ(refusal_of(deck), "");
}

INSTANTIATE_TEST_SUITE_P(EachKind, WallOverlap, testing::ValuesIn(deformable_kinds),
                         [](const auto& kind) { return std::string(name_of_kind(kind.param)); });

// Two walls that are not at right angles: each moves nodes that the other has put in place.
TEST(WallOverlap, OfACornerIsRemoved) {
  Deck deck = body_in_wall(Kind::hex8, 0.001);
  deck.boundary_conditions.push_back(wall_at({-0.199, 0, 0}, {1, 0, 0.8}));
  std::get<RigidWall>(deck.boundary_conditions[1]).point = {-0.199, 0, -0.199};
  Model model = build_model(deck);
  EXPECT_GE(lowest_height(model), -1e-10);
  ASSERT_EQ(model.initial_overlaps.size(), 2U);
  EXPECT_EQ(model.initial_overlaps[0].face_part, "rigid_wall 1");
  EXPECT_EQ(model.initial_overlaps[1].face_part, "rigid_wall 2");
  EXPECT_LT(fastest_in_run(deck, model), 1e-4);
}

// Prescribed components stay: the node goes along the others.
TEST(WallOverlap, LeavesPrescribedComponentsAlone) {
  Deck deck = body_in_wall(Kind::hex8, 0);
  deck.boundary_conditions = {fix("body", {0, 1}), wall_at({0.2, 0, -0.199}, {0.03, 0, 1})};
  const Model plain = [&] {
    Deck without = deck;
    without.boundary_conditions.pop_back();
    return build_model(without);
  }();
  const Model model = build_model(deck);
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    for (int axis = 0; axis < 2; ++axis)
      EXPECT_EQ(model.nodes.record[i].position[axis], plain.nodes.record[i].position[axis]);
  EXPECT_GE(lowest_height(model), -1e-15);
  EXPECT_EQ(model.initial_overlaps.size(), 1U);
}

// Tied nodes are moved onto the wall before their main faces are found.
TEST(WallOverlap, OfTiedNodesIsRemoved) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("upper", {0.4, 0.4, 0.4}, {4, 4, 4}, {0, 0, 0}, Hex8{}),
                box("lower", {0.3, 0.3, 0.1}, {4, 4, 1}, {0, 0, -0.25}, Hex8{})};
  TieToSurface tie;
  tie.names = {"lower.top", "upper"};
  tie.tolerance = 0.01;
  deck.connections = {tie};
  deck.time.end = 2e-3;
  for (const double height : {-0.299, -0.199}) {  // of the wall: the lower end of the scene, the tied nodes
    deck.boundary_conditions = {wall_at({0, 0, height}, {0, 0, 1})};
    if (height > -0.25) {
      deck.parts[1] = box("lower", {0.3, 0.3, 0.1}, {4, 4, 1}, {0, 0, -0.15}, Hex8{});
      tie.names = {"lower.bottom", "upper"};
      deck.connections = {tie};
    }
    Model model = build_model(deck);
    EXPECT_GE(lowest_height(model), -1e-12);
    EXPECT_LT(fastest_in_run(deck, model), 1e-8);
  }
}

// ---- what walls cannot stop

TEST(WallOverlap, OfANodeWhoseMotionIsPrescribedIsRefused) {
  Deck deck = body_in_wall(Kind::hex8, 0.001);
  deck.boundary_conditions.push_back(fix("body.bottom", {2}));
  const std::string said = refusal_of(deck);
  EXPECT_NE(said.find("of part 'body' at ("), std::string::npos) << said;
  EXPECT_NE(said.find("and its motion is prescribed"), std::string::npos) << said;
}

PrescribedMotion drive(MotionKind kind, int axis, Curve curve, std::string place = "here") {
  PrescribedMotion motion;
  motion.where.set = "body";
  motion.kind = kind;
  motion.components = {{axis, std::move(curve), std::move(place)}};
  return motion;
}

struct Way {
  const char* name;
  MotionKind kind;
  Curve curve;
  double depth;  ///< behind a wall at a distance of 0.1, by hand; below 0: it stays before the wall
};

class DrivenTowardsAWall : public testing::TestWithParam<Way> {};

const Way ways[] = {
    {"Velocity", MotionKind::velocity, {{{0, -60}}}, 0.02},
    {"VelocityThatStopsAtTheWall", MotionKind::velocity, {{{0, -100}, {2e-3, 0}}}, -1},
    // back at the start at the end: lowest half way, by the area of a triangle
    {"VelocityThatTurnsBehindTheWall", MotionKind::velocity, {{{0, -240}, {2e-3, 240}}}, 0.02},
    {"Displacement", MotionKind::displacement, {{{0, 5}, {1e-3, 4.87}, {2e-3, 5}}}, 0.03},
    {"DisplacementUpToTheWall", MotionKind::displacement, {{{0, 5}, {1e-3, 4.9}, {2e-3, 5}}}, -1},
    {"Acceleration", MotionKind::acceleration, {{{0, -6e4}}}, 0.02},
    // a t^2/2 - a t^3/(3 T) at T, which is a T^2/6
    {"AccelerationThatTurns", MotionKind::acceleration, {{{0, -1.8e5}, {2e-3, 1.8e5}}}, 0.02},
    {"AccelerationUpToTheWall", MotionKind::acceleration, {{{0, -5e4}}}, -1},
};

TEST_P(DrivenTowardsAWall, IsRefusedWhereItPasses) {
  const Way& way = GetParam();
  for (const bool rigid : {false, true})
    for (const bool wall_moves : {false, true}) {
      Deck deck = body_in_wall(rigid ? Kind::rigid : Kind::hex8, -0.1);
      if (rigid) deck.time.step = 1e-5;
      std::get<RigidWall>(deck.boundary_conditions[0]).place = "there";
      deck.boundary_conditions.push_back(drive(way.kind, 2, way.curve));
      if (rigid) deck.boundary_conditions.push_back(fix("body", {3, 4, 5}));
      if (wall_moves) {  // everything drifts by
        if (way.kind != MotionKind::velocity) continue;
        std::get<RigidWall>(deck.boundary_conditions[0]).velocity = {0, 0, 7};
        for (auto& point : std::get<PrescribedMotion>(deck.boundary_conditions[1]).components[0].curve.points)
          point[1] += 7;
      }
      const std::string said = refusal_of(deck);
      if (way.depth < 0) {
        EXPECT_EQ(said, "");
        continue;
      }
      EXPECT_EQ(said.substr(0, 6), "here: ") << said;
      EXPECT_NE(said.find("part 'body'"), std::string::npos) << said;
      EXPECT_NE(said.find("through the rigid wall of there: it would be "), std::string::npos) << said;
      EXPECT_NEAR(std::stod(said.substr(said.find("would be ") + 9)), way.depth, 1e-6) << said;
    }
}

INSTANTIATE_TEST_SUITE_P(EachWay, DrivenTowardsAWall, testing::ValuesIn(ways),
                         [](const auto& way) { return std::string(way.param.name); });

TEST(DrivenTowardsAWall, AWallThatMovesIntoFixedNodesIsRefused) {
  Deck deck = body_in_wall(Kind::hex8, -0.1);
  std::get<RigidWall>(deck.boundary_conditions[0]).velocity = {0, 0, 60};
  deck.boundary_conditions.push_back(fix("body.bottom", {2}));
  EXPECT_NE(refusal_of(deck).find("it would be 0.02 behind it at time 0.002"), std::string::npos);
  // Along the wall, or with a component that is free, the wall can act.
  deck.boundary_conditions.back() = fix("body.bottom", {0, 1});
  EXPECT_EQ(refusal_of(deck), "");
}

/// Two rigid cubes, the upper driven 0.1 down onto the lower over 2 ms, from a gap of 0.05.
Deck rigid_cubes(std::vector<int> fixed_of_lower) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("lower", {1, 1, 1}, {2, 2, 2}, {0, 0, -0.5}, Rigid{}),
                box("upper", {0.5, 0.5, 0.5}, {2, 2, 2}, {0.1, 0.07, 0.3}, Rigid{})};
  PrescribedMotion down;
  down.where.set = "upper";
  down.components = {{2, Curve{{{0, -50}}}}};
  deck.boundary_conditions = {down, fix("upper", {0, 1, 3, 4, 5})};
  if (!fixed_of_lower.empty()) deck.boundary_conditions.push_back(fix("lower", fixed_of_lower));
  deck.contact.emplace();
  deck.time.end = 2e-3;
  deck.time.step = 1e-5;
  return deck;
}

TEST(RigidPart, DrivenIntoAFixedOneIsNamedWhenTheyMeet) {
  const Deck deck = rigid_cubes({0, 1, 2, 3, 4, 5});
  Model model = build_model(deck);
  ThreadTeam team(1);
  try {
    run(model, deck, team);
    FAIL() << "passed";
  } catch (const Breakdown& breakdown) {
    const std::string said = breakdown.what();
    EXPECT_NE(said.find("rigid part 'upper' is driven into rigid part 'lower'"), std::string::npos) << said;
  }
  EXPECT_NEAR(model.times.time, 1e-3, 2e-5);
}

TEST(RigidPart, DrivenIntoOneThatGivesWayPushesIt) {
  const Deck deck = rigid_cubes({0, 1, 3, 4, 5});
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_NEAR(model.rigid.motion[0].velocity[2], -50, 0.5);
}

TEST(RigidPart, DrivenIntoOneThatItMayNotTouchPasses) {
  Deck deck = rigid_cubes({0, 1, 2, 3, 4, 5});
  deck.contact->pairs = {{.parts = {"lower", "upper"}, .friction = {}, .touch = false}};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_DOUBLE_EQ(model.times.time, deck.time.end);
}

}  // namespace
}  // namespace brio
