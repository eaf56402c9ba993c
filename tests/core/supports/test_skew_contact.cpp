// Contact, walls, ties, springs and rigid parts at skew supports: a turned scene moves as the scene turned.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "src/base/index.hpp"
#include "tests/core/supports/turned_scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double same_in_contact = 1e-10;

PrescribedMotion called(std::string name, PrescribedMotion motion) {
  motion.name = std::move(name);
  return motion;
}

ForceOutput forces_wanted(bool contact) {
  ForceOutput forces;
  forces.reactions.all = true;
  forces.contact.all = contact;
  return forces;
}

void touch_with_friction(Deck& deck) {
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.contact->options.passes = 100000;  // differences are those of rounding
  deck.contact->options.tolerance = 1e-14;
  deck.output.history.forces = forces_wanted(true);
}

// Parallel faces and edges have no closest points of their own: rounding would choose them.
Part tilted(Part part) {
  part.placement.rotate = Rotation{{2, 1, 0.3}, 11};
  return part;
}

// The striker lands on nodes of the target that three symmetry planes hold.
Deck struck_corner(double gap) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("target", {1, 1, 0.5}, {4, 4, 2}, {0.5, 0.5, 0.25}, hex8()),
                tilted(box("striker", {0.61, 0.53, 0.3}, {3, 3, 2}, {0.2, 0.21, 0.71 + gap}, hex8()))};
  deck.initial_conditions = {moving("striker", {6, 4, -20})};
  deck.boundary_conditions = {called("east", fix("target.xmin", {0})),
                              called("north", fix("target.ymin", {1})),
                              called("foot", fix("target.zmin", {2}))};
  touch_with_friction(deck);
  deck.time.end = 2e-3;
  return deck;
}

TEST(SkewContact, AStrikerOnSupportedNodesIsTurned) {
  const Deck deck = struck_corner(1e-3);
  ThreadTeam team(1);
  Model model = build_model(deck);
  test::run(model, deck, team);
  // There is what is compared: impulses of contact, also on the supports of the nodes that it reaches.
  EXPECT_LT(model.energy.friction.at_step(), -1e-3 * model.energy.kinetic_start);
  EXPECT_GT(std::abs(reactions_of(model)[1][1]), 1e-2 * std::abs(reactions_of(model)[3][2]));
  expect_turned(deck, same_in_contact);
}

TEST(SkewContact, NodesThatTouchAtTheStartMoveAlongTheirSupports) {
  Deck deck = struck_corner(-0.0015);
  EXPECT_FALSE(build_model(deck).initial_overlaps.empty());
  deck.time.end = 1e-3;
  expect_turned(deck, same_in_contact);
}

// Nodes of the edge of two planes at 60 degrees, one of which moves, are struck and rubbed.
TEST(SkewContact, AnEdgeOfTwoPlanesThatIsStruckStaysOnBoth) {
  Deck deck = struck_corner(1e-3);
  const double c = 0.5, s = std::sqrt(3.0) / 2;
  deck.coordinate_systems = {{"plane", RectangularSystem{{s, -c, 0}, {0, 0, 1}}}};
  auto& east = std::get<PrescribedMotion>(deck.boundary_conditions[0]);
  east.system = "plane";
  east.components[0].curve = Curve{{{0, 1}}};
  deck.parts[1].placement.translate[0] = -0.2;
  deck.time.end = 4e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  double largest = 0, struck = 0;
  test::run(model, deck, team, [&](Model& now) {
    for (std::size_t i = 0; i < now.nodes.size(); ++i) {
      const double* x = now.nodes.record[i].position;
      const double* v = now.nodes.record[i].velocity;
      if (std::popcount(static_cast<unsigned>(now.nodes.prescribed_translations(i))) < 2 || x[2] < 0.1)
        continue;
      largest = std::max({largest, std::abs(v[1]), std::abs(s * v[0] - c * v[1] - 1)});
      const int slave = now.contacts[0].surface.slave(static_cast<int>(i));
      struck += norm(now.contacts[0].normal_impulse[index(slave)]);
    }
  });
  EXPECT_GT(struck, 0);
  EXPECT_LT(largest, 1e-13);
  EXPECT_LT(model.energy.friction.at_step(), -1e-3 * model.energy.kinetic_start);
  EXPECT_LE(model.energy.contact_added_max, 1e-6 * model.energy.kinetic_start);
  EXPECT_LT(model.energy.error_max, 1e-3);
  model.momentum.now = momentum(model.nodes).total;
  EXPECT_LT(model.momentum.linear_imbalance(), 1e-13);
  EXPECT_LT(model.momentum.angular_imbalance(), 1e-13);
  // Reactions, those of contact among them, are along the normals of their planes and sum to those of all
  // supports.
  const std::vector<Vector3d> reactions = reactions_of(model);
  const double size = std::sqrt(dot(reactions[2], reactions[2]));
  EXPECT_GT(std::abs(reactions[0][0]), 1e-2 * size);
  EXPECT_GT(std::abs(reactions[1][1]), 1e-2 * size);
  EXPECT_NEAR(c * reactions[0][0] + s * reactions[0][1], 0, 1e-13 * size);
  EXPECT_NEAR(reactions[1][0], 0, 1e-13 * size);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(reactions[0][i] + reactions[1][i] + reactions[2][i], model.momentum.supports.linear[i],
                1e-12 * size);
}

Part panel(std::string name, std::array<double, 2> size, std::array<int, 2> elements, Vector3d centre) {
  Shell4 shell;
  shell.thickness = 0.02;
  Part part{std::move(name), PlateMesh{size, elements}, {}, shell, "material"};
  part.placement.translate = centre;
  return part;
}

// A corner strikes an element whose nodes are held, with their rotations.
TEST(SkewContact, ShellsWithHeldRotationsAreTurned) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Part striker = box("striker", {0.3, 0.3, 0.3}, {1, 1, 1}, {0.13, 0.1, 0.265}, hex8());
  striker.placement.rotate = Rotation{{1, -1, 0.2}, 40};
  deck.parts = {panel("target", {1, 1}, {5, 5}, {0.5, 0.5, 0}), striker};
  deck.initial_conditions = {moving("striker", {3, 5, -10})};
  deck.boundary_conditions = {fix("target.xmin", {0, 4, 5}), fix("target.ymin", {1, 3, 5}),
                              fix("target.xmax", {0, 1, 2, 3, 4, 5})};
  touch_with_friction(deck);
  deck.time.end = 3e-3;
  expect_turned(deck, same_in_contact);
}

TEST(SkewContact, ABeamAcrossSupportedShellsIsTurned) {
  Beam2 beam;
  beam.section = CircleSection{.radius = 0.02};
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {panel("target", {1, 1}, {4, 4}, {0.5, 0.5, 0}),
                {"rod", LineMesh{{0.04, 0.07, 0.032}, {0.8, 0.43, 0.335}, 5}, {}, beam, "material"}};
  deck.initial_conditions = {moving("rod", {2, 1, -10})};
  deck.boundary_conditions = {fix("target.xmin", {0, 2, 4, 5}), fix("target.ymin", {1, 3, 5}),
                              fix("rod.start", {0, 3, 4})};
  touch_with_friction(deck);
  deck.time.end = 2e-3;
  expect_turned(deck, same_in_contact);
}

// ---- walls

Deck thrown_at_wall(bool in_contact) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 0.5, 0.5}, {4, 2, 2}, {0.5, 0.25, 0.26}, hex8())};
  deck.initial_conditions = {moving("block", {5, 0, -20})};
  const double s = std::sqrt(0.5);
  deck.boundary_conditions = {called("side", fix("block.ymin", {1})), called("end", fix("block.xmin", {0})),
                              RigidWall{{0, 0, 0}, {0.1, 0.2, 1}, {0, 0, 1}, 0.2},
                              RigidWall{{1.02, 0, 0}, {-s, 0, s}, {}, 0.1}};
  if (in_contact) touch_with_friction(deck);
  deck.output.history.forces = forces_wanted(false);
  deck.time.end = 3e-3;
  return deck;
}

TEST(SkewContact, ABlockThrownAtWallsIsTurned) {
  expect_turned(thrown_at_wall(false), same_in_contact);
  expect_turned(thrown_at_wall(true), same_in_contact);
}

// It begins behind the wall by a little, and its nodes leave it along their supports.
TEST(SkewContact, NodesBehindAWallLeaveItAlongTheirSupports) {
  Deck deck = thrown_at_wall(false);
  std::get<RigidWall>(deck.boundary_conditions[2]).point = {0, 0, 0.012};
  deck.time.end = 2e-4;
  EXPECT_FALSE(build_model(deck).initial_overlaps.empty());
  expect_turned(deck, same_in_contact);
}

// ---- ties, joints and springs

// A symmetry plane cuts both parts of a tie, and a wall stops the tied nodes.
TEST(SkewContact, TiedPartsOnASymmetryPlaneAreTurned) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("coarse", {1, 1, 0.5}, {2, 2, 1}, {0.5, 0.5, 0.75}, hex8()),
                box("fine", {1, 1, 0.5}, {4, 4, 2}, {0.5, 0.5, 0.25}, hex8())};
  TieToSurface tie;
  tie.names = {"fine.zmax", "coarse"};
  tie.tolerance = 1e-3;
  deck.connections = {tie};
  deck.initial_conditions = {moving("coarse", {5, 0, -20}), moving("fine", {5, 0, -20})};
  deck.boundary_conditions = {fix("coarse.ymin", {1}), fix("fine.ymin", {1}),
                              RigidWall{{0, 0, -0.01}, {0.1, 0.2, 1}, {}, 0.2},
                              RigidWall{{1.01, 0, 0}, {-1, 0, 0.1}, {}, 0.1}};
  deck.time.end = 3e-3;
  expect_turned(deck, same_in_contact);
}

TEST(SkewContact, TiesWhereOnlyTheTiedNodesAreHeldAreRefused) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("coarse", {1, 1, 0.5}, {2, 2, 1}, {0.5, 0.5, 0.75}, hex8()),
                box("fine", {1, 1, 0.5}, {4, 4, 2}, {0.5, 0.5, 0.25}, hex8())};
  TieToSurface tie;
  tie.names = {"fine.zmax", "coarse"};
  tie.tolerance = 1e-3;
  deck.connections = {tie};
  deck.boundary_conditions = {fix("fine.ymin", {1})};
  deck.time.end = 5e-4;
  EXPECT_THROW(build_model(turned(deck)), BuildError);
}

TEST(SkewContact, SpringsAndDashpotsOnHeldNodesAreTurned) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 1, 0.5}, {2, 2, 1}, {0.5, 0.5, 0.25}, hex8())};
  deck.initial_conditions = {moving("block", {0, 3, -20})};
  deck.boundary_conditions = {fix("block.xmin", {0}), fix("block.ymin", {1})};
  Spring spring;
  spring.name = "strut";
  spring.from.point = {0, 1, 0.5};
  spring.to.point = {-0.3, 1.2, 1.5};
  spring.to.fixed = true;
  spring.stiffness = 1e6;
  spring.damping = 2e3;
  deck.springs = {spring};
  deck.time.end = 5e-3;
  expect_turned(deck, same_in_contact);
}

// ---- rigid parts

Deck driven_ram(bool joined) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 1, 0.5}, {4, 4, 2}, {0.5, 0.5, 0.25}, hex8()),
                box("ram", {0.5, 0.5, 0.2}, {2, 2, 1}, {0.5, 0.5, joined ? 0.6 : 0.68}, Rigid{})};
  if (!joined) deck.parts[1] = tilted(deck.parts[1]);
  PrescribedMotion down;
  down.name = "ram";
  down.where.set = "ram";
  down.components = {
      {2, Curve{{{0, 0}, {3e-4, -40}}}}, {0, Curve{{{0, 0}}}}, {3, Curve{{{0, 0}, {3e-4, 5}}}}};
  deck.boundary_conditions = {called("foot", fix("block.zmin", {0, 1, 2})), down};
  deck.loads = {NodalForce{}};
  auto& force = std::get<NodalForce>(deck.loads[0]);
  force.where.set = "ram";
  force.force = {0, 1e4, 0};
  if (joined) {
    deck.connections = {Merge{{"ram", "block"}, 1e-6, ""}};
  } else {
    touch_with_friction(deck);
  }
  deck.output.history.forces = forces_wanted(!joined);
  deck.time.end = 1e-3;
  return deck;
}

TEST(SkewContact, ARigidPartDrivenAlongLocalAxesIsTurned) {
  expect_turned(driven_ram(false), same_in_contact);
  expect_turned(driven_ram(true), same_in_contact);
}

TEST(SkewContact, ARigidPartAtAWallIsTurned) {
  Deck deck = driven_ram(false);
  deck.parts.erase(deck.parts.begin());
  deck.contact.reset();
  deck.output.history.forces = forces_wanted(false);
  auto& motion = std::get<PrescribedMotion>(deck.boundary_conditions[1]);
  motion.components = {{0, Curve{{{0, 3}}}}, {4, Curve{{{0, 2}}}}};
  deck.boundary_conditions = {motion, RigidWall{{0, 0, 0.49}, {0.2, 0.1, 1}, {}, 0.2}};
  deck.initial_conditions = {moving("ram", {3, 0, -20})};
  deck.loads = {Gravity{{0, 10, -20}}};
  deck.time.step = 1e-6;
  deck.time.end = 2e-3;
  expect_turned(deck, same_in_contact);
}

// Nodes of elements that belong to a rigid part may be held as it is.
TEST(SkewContact, SupportsOfJoinedNodesAreThoseOfTheirRigidPart) {
  Deck deck = driven_ram(true);
  auto& motion = std::get<PrescribedMotion>(deck.boundary_conditions[1]);
  motion.components = {
      {0, Curve{{{0, 0}}}}, {3, Curve{{{0, 0}}}}, {4, Curve{{{0, 0}}}}, {5, Curve{{{0, 0}}}}};
  deck.boundary_conditions.push_back(fix("block.zmax", {0}));
  expect_turned(deck, same_in_contact);
}

TEST(SkewContact, ARigidPartTakesOneSystem) {
  Deck deck = driven_ram(false);
  deck = turned(deck);
  deck.boundary_conditions.push_back(fix("ram", {1}));
  EXPECT_THROW(build_model(deck), BuildError);
}

}  // namespace
}  // namespace brio
