// The step allocates nothing once it has warmed up, whatever the scene and the number of threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/contact/allocation_count.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// A block under gravity and pressure that falls onto a rigid wall and slides there.
Deck block_on_wall(const Element& element) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 1, 0.5}, {8, 8, 4}, {0, 0, 0.25}, element)};
  deck.initial_conditions = {moving("block", {5, 0, 0})};
  RigidWall floor;
  floor.normal = {0, 0, 1};
  floor.friction = 0.2;
  deck.boundary_conditions = {floor};
  Gravity gravity;
  gravity.acceleration = {0, 0, -100};
  deck.loads = {gravity, Pressure{"block.zmax", Curve{{{0, 0}, {1e-2, 1e5}}}}};
  deck.time.end = 1;
  return deck;
}

// A can of shells, fixed at its bottom, under a block that comes down: contact with friction.
Deck can_under_block() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}, {"heavy", elastic(0.3)}};
  std::get<Elastic>(deck.materials[1].second).density *= 10;
  Shell4 shell;
  shell.thickness = 0.02;
  deck.parts = {{"can", CylinderMesh{0.5, 1, {24, 8}}, {}, shell, "material"},
                box("block", {1.5, 1.5, 0.2}, {6, 6, 1}, {0, 0, 1.12}, hex8(), "heavy")};
  deck.initial_conditions = {moving("block", {3, 0, -20})};
  deck.boundary_conditions = {fix("can.bottom", {0, 1, 2, 3, 4, 5})};
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 1;
  return deck;
}

// A block that slides over a floor of another mesh: contact changes faces all the time.
Deck block_on_floor() {
  Deck deck = block_on_wall(hex8());
  deck.initial_conditions = {moving("block", {15, 0, 0})};
  deck.parts.push_back(box("floor", {4, 2, 0.25}, {17, 7, 1}, {0.5, 0, -0.125}, hex8()));
  deck.boundary_conditions = {fix("floor.zmin", {0, 1, 2})};
  deck.contact.emplace();
  deck.contact->options.friction = 0.2;
  return deck;
}

// The same with a block that is covered by a tied shell.
Deck can_under_covered_block() {
  Deck deck = can_under_block();
  deck.parts[1].placement.translate = {0, 0, 1.15};
  Shell4 shell;
  shell.thickness = 0.02;
  Part cover{"cover", PlateMesh{{1.4, 1.4}, {15, 15}}, {}, shell, "material"};
  cover.placement.translate = {0, 0, 1.04};
  deck.parts.push_back(cover);
  deck.connections = {TieToSurface{{"cover", "block"}, 1e-2, "deck.yaml:3:5"}};
  deck.initial_conditions.push_back(moving("cover", {3, 0, -20}));
  return deck;
}

Part thrown_beam(std::string name, Vector3d start, Vector3d end) {
  Beam2 beam;
  beam.section = CircleSection{.radius = 0.05};
  return {std::move(name), LineMesh{start, end, 4}, {}, beam, "material"};
}

// What meets along lines, under gravity: on the edge of a block and the rim of a sheet that stand still, a
// beam slides and another rests, and on the two lie a sheet's rim, a block's edge and a ball of particles.
Deck lines_on_lines(double speed) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Part edge = box("edge", {2, 0.5, 0.5}, {4, 1, 1}, {0, 0, 0}, hex8());
  edge.placement = {.rotate = Rotation{{1, 0, 0}, 45}, .translate = {0, -0.4, -std::sqrt(0.125)}};
  Shell4 shell;
  shell.thickness = 0.05;
  const auto sheet = [&](std::string name, Vector3d size, Rotation turn, Vector3d centre) {
    PlateMesh mesh;
    mesh.size = {size[0], size[1]};
    mesh.elements = {4, 2};
    return Part{std::move(name), mesh, {.rotate = turn, .translate = centre}, shell, "material"};
  };
  Part block = box("block", {0.3, 0.3, 0.3}, {1, 1, 1}, {0, 0, 0}, hex8());
  block.placement = {.rotate = Rotation{{0, 1, 0}, 45}, .translate = {0.1, 0, 0.1 + std::sqrt(0.045)}};
  ParticleMesh ball;
  ball.sphere = ParticleSphere{0.12, 0.06};
  deck.parts = {edge,
                sheet("rim", {2, 0.5, 0}, Rotation{{1, 0, 0}, 90}, {0, 0.4, -0.275}),
                thrown_beam("sliding", {0.1, -0.7, 0.05}, {0.1, 0.7, 0.05}),
                thrown_beam("resting", {-0.5, -0.7, 0.05}, {-0.5, 0.7, 0.05}),
                sheet("standing", {0.3, 0.3, 0}, Rotation{{1, 0, 0}, 90}, {-0.5, 0, 0.275}),
                block,
                {"ball", ball, {.rotate = {}, .translate = {-0.5, 0.25, 0.23}}, Particle{}, "material"}};
  deck.boundary_conditions = {fix("edge", {0, 1, 2}), fix("rim", {0, 1, 2, 3, 4, 5})};
  deck.initial_conditions = {moving("sliding", {speed, 0, -1}), moving("block", {speed, 0, -1})};
  Gravity gravity;
  gravity.acceleration = {0, 0, -100};
  deck.loads = {gravity};
  deck.contact.emplace();
  deck.contact->options.friction = 0.2;
  deck.time.end = 1;
  return deck;
}

struct Counted {
  std::size_t allocations = 0;  ///< in steps without a search
  int searches = 0;
  int active = 0;  ///< contacts with an impulse, over all counted steps
  int edges = 0;   ///< of these, of edges
};

// The scene runs once, so that every buffer has seen what the scene holds, and again from the start, counted
// after a few steps.
Counted count(const Deck& deck, int threads, int steps) {
  Model model = build_model(deck);
  ThreadTeam team(threads);
  const auto advance = [&](int count) { make_steps(model, count, deck.numerics.energy_error_limit, team); };
  const Model start = model;
  const auto restart = [&] {
    model.step = start.step;
    model.times = start.times;
    model.control = start.control;
    model.assembled_step = start.assembled_step;
    model.nodes = start.nodes;
    model.blocks = start.blocks;
    model.energy = start.energy;
    model.ties = start.ties;
  };
  // Twice: what is a constraint depends on the constraints before, those at the end of a run included.
  for (int run = 0; run < 2; ++run) {
    advance(steps);
    restart();
  }
  advance(10);
  Counted counted;
  for (int step = 10; step < steps; ++step) {
    const AllocationCount allocations;
    advance(1);
    const bool searched = std::any_of(model.contacts.begin(), model.contacts.end(),
                                      [](const ContactScene& scene) { return scene.step.searched; });
    if (!searched) counted.allocations += allocations.count();
    for (const ContactScene& scene : model.contacts) {
      counted.searches += scene.step.searched ? 1 : 0;
      counted.active += scene.step.active;
      counted.edges += static_cast<int>(
          std::count_if(scene.contacts.begin(), scene.contacts.end(),
                        [](const Contact& contact) { return contact.of_edges() && contact.impulse > 0; }));
    }
  }
  return counted;
}

TEST(StepAllocation, NoneInASceneOfHexahedraWithWallGravityAndPressure) {
  for (int threads : {1, 2})
    for (const Element& element : {Element(Hex8{}), Element(Hex8Full{})})
      EXPECT_EQ(count(block_on_wall(element), threads, 100).allocations, 0u) << threads;
}

// Tables, expressions, damping, and friction that falls with the velocity.
TEST(StepAllocation, NoneWithTablesExpressionsAndDamping) {
  Deck deck = block_on_floor();
  const std::array<double, 2> slow[] = {{0, 1e5}, {0.1, 2e5}}, fast[] = {{0, 3e5}, {0.2, 3e5}};
  const YieldCurve curves[] = {{slow, 1}, {fast, 1e3}};
  TabulatedPlasticity law{
      1000, 1e9, 0.3, {std::make_shared<const YieldTable>(curves, BeyondTable::constant)}};
  deck.materials = {{"material", law}};
  SpaceTimeCurve pressure;
  pressure.expression =
      std::make_shared<const Expression>("1e5*(1 + x)*smooth_step(t, 0, 1e-2)", Expression::Parameters{},
                                         Expression::Variables::time_and_position);
  pressure.points = {{0, 0}, {1, 1e5}};
  pressure.varies_in_space = true;
  std::get<Pressure>(deck.loads[1]).pressure = pressure;
  deck.parts[0].damping = 10;
  deck.contact->options.kinetic_friction = KineticFriction{0.1, 0.1};
  for (int threads : {1, 2}) {
    const Counted counted = count(deck, threads, 900);
    EXPECT_EQ(counted.allocations, 0u) << threads;
    EXPECT_GT(counted.active, 200);
  }
}

TEST(StepAllocation, NoneWhereBlocksSlideOverEachOther) {
  for (int threads : {1, 2}) {
    const Counted counted = count(block_on_floor(), threads, 900);
    EXPECT_EQ(counted.allocations, 0u) << threads;
    EXPECT_GT(counted.searches, 2);
    EXPECT_GT(counted.active, 200);
  }
}

TEST(StepAllocation, NoneInASceneOfShellsWithContactAndFriction) {
  for (int threads : {1, 2}) {
    const Counted counted = count(can_under_block(), threads, 300);
    EXPECT_EQ(counted.allocations, 0u) << threads;
    EXPECT_GT(counted.searches, 1);
    EXPECT_GT(counted.active, 200);
  }
}

// Reactions, contact forces and a section, of shells that are crushed.
TEST(StepAllocation, NoneWhereForcesAreSummed) {
  Deck deck = can_under_block();
  ForceOutput& forces = deck.output.history.forces.emplace();
  forces.reactions.all = forces.contact.all = true;
  forces.sections = {{"waist", "can", {0, 0, 0.5}, {0, 0, 1}}};
  for (int threads : {1, 2}) {
    const Counted counted = count(deck, threads, 300);
    EXPECT_EQ(counted.allocations, 0u) << threads;
    EXPECT_GT(counted.active, 200);
  }
}

TEST(StepAllocation, NoneWhereHeldNodesAreInContact) {
  for (int threads : {1, 2}) {
    const Counted counted = count(can_under_covered_block(), threads, 300);
    EXPECT_EQ(counted.allocations, 0u) << threads;
    EXPECT_GT(counted.searches, 1);
    EXPECT_GT(counted.active, 200);
  }
}

TEST(StepAllocation, NoneWhereLinesRestAndSlideOnLines) {
  for (int threads : {1, 2})
    for (double speed : {0.0, 15.0}) {
      const Counted counted = count(lines_on_lines(speed), threads, 400);
      EXPECT_EQ(counted.allocations, 0u) << threads << ' ' << speed;
      EXPECT_GT(counted.edges, 400);
    }
}

TEST(StepAllocation, CounterSeesWhatIsAllocated) {
  const AllocationCount allocations;
  const Model model = build_model(can_under_block());
  EXPECT_GT(allocations.count(), 0u);
}

}  // namespace
}  // namespace brio
