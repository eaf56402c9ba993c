// Nodes end a time step where contact has looked for crossings: what moves them afterwards could make some.
// So it is contact that keeps them in front of rigid walls.

#include <gtest/gtest.h>

#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

enum class Upper { soft, rigid, driven, tied };

// A sheet and a block between a moving wall with friction and a box that spins, or turns as prescribed.
Deck pressed(Upper upper) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  const bool is_rigid = upper == Upper::rigid || upper == Upper::driven;
  deck.parts = {box("block", {0.3, 0.2, 0.02}, {6, 4, 1}, {0, 0, 0.013}, hex8()),
                box("upper", {0.2, 0.1, 0.1}, {2, 1, 1}, {0.03, 0, 0.08},
                    is_rigid ? Element(Rigid{}) : Element(hex8()))};
  PlateMesh plate;
  plate.size = {0.3, 0.2};
  plate.elements = {6, 4};
  Shell4 shell;
  shell.thickness = 2e-3;
  deck.parts.push_back({"sheet", plate, {}, shell, "material"});
  InitialCondition fall = moving("upper", {6, 4, -20});
  if (is_rigid) fall.spin = Spin{{0.03, 0, 0.08}, {200, -300, 400}};
  if (upper == Upper::driven) {
    PrescribedMotion turn;
    turn.where.set = "upper";
    turn.components = {{3, Curve{{{0, 200}}}}, {5, Curve{{{0, 400}}}}};
    deck.boundary_conditions.push_back(turn);
    fall.spin.reset();
  }
  deck.initial_conditions = {moving("block", {6, 4, -20}), moving("sheet", {6, 4, -20}), fall};
  if (upper == Upper::tied) {
    deck.parts.push_back(box("cap", {0.06, 0.1, 0.04}, {3, 2, 1}, {-0.115, 0, 0.044}, hex8()));
    deck.initial_conditions.push_back(moving("cap", {6, 4, -20}));
    TieToSurface tie;
    tie.names = {"cap.zmin", "block"};
    tie.tolerance = 0.01;
    deck.connections = {tie};
  }
  RigidWall wall;
  wall.normal = {0.1, 0, 1};
  wall.point = {0, 0, -0.02};
  wall.velocity = {0, 0, 5};
  wall.friction = 0.2;
  deck.boundary_conditions.push_back(wall);
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 2e-3;
  return deck;
}

class ContactEnds : public testing::TestWithParam<Upper> {};

TEST_P(ContactEnds, AreWhereNodesGo) {
  const Deck deck = pressed(GetParam());
  Model model = build_model(deck);
  ThreadTeam team(1);
  std::vector<Vector3d> end;
  double farthest = 0, lowest = 1, wall_impulse = 0;
  std::uint64_t pushed = 0;
  test::run(model, deck, team, [&](Model& now) {
    const ContactScene& scene = now.contacts[0];
    for (std::size_t s = 0; s < end.size(); ++s)
      farthest = std::max(farthest, norm(position(now.nodes, scene.surface.node[s]) - end[s]));
    end.clear();
    const RigidWall& wall = now.walls[0].wall;
    const Vector3d at_wall = wall.point + (now.times.time + now.times.next) * wall.velocity;
    for (std::size_t s = 0; s < scene.surface.slaves(); ++s) {
      end.push_back(scene.motion.end(static_cast<int>(s)));
      lowest = std::min(lowest, dot(wall.normal, end[s] - at_wall));
    }
    pushed += index(scene.step.active);
    wall_impulse += norm(scene.step.wall_impulse);
  });
  EXPECT_LT(farthest, 1e-15);
  EXPECT_GT(lowest, -1e-15);
  EXPECT_LT(lowest, 1e-6);
  EXPECT_GT(pushed, 30U);
  EXPECT_GT(wall_impulse, 1);
}

INSTANTIATE_TEST_SUITE_P(EachUpper, ContactEnds,
                         testing::Values(Upper::soft, Upper::rigid, Upper::driven, Upper::tied));

}  // namespace
}  // namespace brio
