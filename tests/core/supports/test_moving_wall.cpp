// Energy of bodies and rigid walls that move.

#include <gtest/gtest.h>

#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr Vector3d of_wall_motion{3, -2, 8};

struct WallCase {
  const char* name;
  bool rigid = false, contact = false, tied = false;
};

// A block comes down aslant on a wall with friction; both are seen from a frame.
Deck slanting_impact(const WallCase& kind, const Vector3d& frame) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  const Element element = kind.rigid ? Element(Rigid{}) : Element(hex8());
  const double height = kind.tied ? 0.151 : 0.051;
  deck.parts = {box("block", {0.3, 0.2, 0.1}, {3, 2, 2}, {0, 0, height}, element)};
  deck.initial_conditions = {moving("block", Vector3d{6, 4, -20} + frame)};
  if (kind.tied) {
    deck.parts.push_back(box("cap", {0.2, 0.2, 0.1}, {4, 3, 1}, {0, 0, 0.051}, element));
    deck.initial_conditions.push_back(moving("cap", Vector3d{6, 4, -20} + frame));
    TieToSurface tie;
    tie.names = {"cap.zmax", "block"};
    tie.tolerance = 0.01;
    deck.connections = {tie};
  }
  RigidWall wall;
  wall.point = {0, 0, 0};
  wall.normal = {0, 0, 1};
  wall.velocity = frame;
  wall.friction = 0.2;
  deck.boundary_conditions = {wall};
  if (kind.contact) deck.contact.emplace();
  deck.time.end = 1e-3;
  if (kind.rigid) deck.time.step = 1e-5;
  return deck;
}

class MovingWall : public testing::TestWithParam<WallCase> {};

// What contact and friction dissipate does not depend on the frame; the work of the wall is its impulse times
// its velocity.
TEST_P(MovingWall, WorkIsExternalAndDissipationThatOfAWallAtRest) {
  const auto at_end = [&](const Vector3d& frame) {
    const Deck deck = slanting_impact(GetParam(), frame);
    Model model = build_model(deck);
    ThreadTeam team(1);
    test::run(model, deck, team);
    return model;
  };
  const Model at_rest = at_end({}), moves = at_end(of_wall_motion);
  const EnergyBalance &still = at_rest.energy, &moving = moves.energy;
  const double scale = still.kinetic_start;
  EXPECT_LT(still.contact.at_step(), -0.01 * scale);
  EXPECT_LT(still.friction.at_step(), -0.01 * scale);
  EXPECT_EQ(still.external.at_step(), 0);
  EXPECT_NEAR(moving.contact.at_step(), still.contact.at_step(), 1e-9 * scale);
  EXPECT_NEAR(moving.friction.at_step(), still.friction.at_step(), 1e-9 * scale);
  EXPECT_NEAR(moving.internal, still.internal, 1e-9 * scale);
  const double work = dot(moves.momentum.walls.linear, of_wall_motion);
  EXPECT_GT(work, 0.1 * scale);
  EXPECT_NEAR(moving.external.at_step(), work, 1e-12 * work);
  EXPECT_LT(std::abs(moving.relative_error()), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(EachWay, MovingWall,
                         testing::Values(WallCase{.name = "nodes"},
                                         WallCase{.name = "contact", .contact = true},
                                         WallCase{.name = "rigid", .rigid = true},
                                         WallCase{.name = "rigid_in_contact", .rigid = true, .contact = true},
                                         WallCase{.name = "tied", .tied = true},
                                         WallCase{.name = "tied_in_contact", .contact = true, .tied = true}),
                         [](const auto& entry) { return entry.param.name; });

}  // namespace
}  // namespace brio
