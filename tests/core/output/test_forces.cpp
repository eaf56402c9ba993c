// Forces in the history against balances of momentum and closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "src/base/index.hpp"
#include "src/model/state.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

PrescribedMotion named(std::string name, PrescribedMotion motion) {
  motion.name = std::move(name);
  return motion;
}
PrescribedMotion pulled(std::string set, int axis, double velocity) {
  PrescribedMotion motion;
  motion.where.set = std::move(set);
  motion.components = {{axis, Curve{{{0, velocity}}}}};
  return motion;
}

ForceOutput all_forces() {
  ForceOutput forces;
  forces.reactions.all = true;
  forces.contact.all = true;
  return forces;
}

/// Values of the columns of forces in the present state.
std::map<std::string, double> forces_of(const Model& model) {
  std::vector<std::string> columns;
  std::vector<double> row;
  add_columns(*model.forces, columns);
  add_values(*model.forces, row);
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < columns.size(); ++i) values[columns[i]] = row.at(i);
  return values;
}
Vector3d vector_of(const std::map<std::string, double>& values, const std::string& name,
                   const std::array<const char*, 3>& endings = {"_x", "_y", "_z"}) {
  return {values.at(name + endings[0]), values.at(name + endings[1]), values.at(name + endings[2])};
}

Vector3d momentum_of_part(const Model& model, std::size_t part) {
  Vector3d sum{};
  for (const int node : model.parts[part].node)
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] += model.nodes.mass[index(node)] * model.nodes.record[index(node)].velocity[i];
  return sum;
}

void expect_near(const Vector3d& a, const Vector3d& b, double tolerance, const std::string& what) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << what << ", axis " << i;
}

// ---- contact

/// A block that strikes a plate obliquely, with friction; the plate is on supports.
Deck oblique_impact() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {0.2, 0.2, 0.2}, {3, 3, 3}, {0.013, 0.021, 0.101}, hex8()),
                box("plate", {1, 1, 0.1}, {8, 8, 1}, {0, 0, -0.05}, hex8())};
  deck.initial_conditions = {moving("block", {6, 3, -20})};
  deck.boundary_conditions = {named("west", fix("plate.xmin", {0, 1, 2})),
                              named("east", fix("plate.xmax", {0, 2}))};
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 4e-3;
  deck.output.history.forces = all_forces();
  return deck;
}

TEST(Forces, ContactAndReactionsAreTheChangesOfMomentum) {
  const Deck deck = oblique_impact();
  Model model = build_model(deck);
  ThreadTeam team(2);
  Vector3d block = momentum_of_part(model, 0), plate = momentum_of_part(model, 1), supports{};
  double largest = 0;
  run(model, deck, team, [&](Model& now) {
    const auto values = forces_of(now);
    const double duration = now.forces->duration;
    const auto impulse = [&](const std::string& name) {
      Vector3d force = vector_of(values, name);
      for (double& component : force) component *= duration;
      return force;
    };
    const Vector3d on_block = impulse("contact.block.plate");
    Vector3d reactions = impulse("reaction.west");
    reactions += impulse("reaction.east");
    const Vector3d block_now = momentum_of_part(now, 0), plate_now = momentum_of_part(now, 1);
    const double scale = 1e-12 * 8 * 25;  // of m v
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(block_now[i] - block[i], on_block[i], scale);
      EXPECT_NEAR(plate_now[i] - plate[i], reactions[i] - on_block[i], scale);
      EXPECT_NEAR(now.momentum.supports.linear[i] - supports[i], reactions[i], scale);
    }
    EXPECT_EQ(values.at("contact.block.block_x"), 0);
    largest = std::max(largest, std::abs(on_block[2]));
    block = block_now;
    plate = plate_now;
    supports = now.momentum.supports.linear;
    now.forces->begin_interval();
  });
  EXPECT_GT(largest, 0);
}

// The plate moves at a constant velocity: what the press bears is what the block receives.
TEST(Forces, APressBearsWhatItPressesOn) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {0.2, 0.2, 0.2}, {3, 3, 3}, {0, 0, 0}, hex8()),
                box("plate", {0.4, 0.4, 0.1}, {2, 2, 1}, {0.02, 0.01, 0.1502}, Rigid{})};
  deck.boundary_conditions = {named("base", fix("block.zmin", {0, 1, 2})),
                              named("press", pulled("plate", 2, -5)), fix("plate", {0, 1, 3, 4, 5})};
  deck.initial_conditions = {moving("plate", {0, 0, -5})};
  deck.contact.emplace();
  deck.time.end = 2e-3;
  deck.output.history.forces = all_forces();
  Model model = build_model(deck);
  ThreadTeam team(1);
  double largest = 0;
  run(model, deck, team, [&](Model& now) {
    const auto values = forces_of(now);
    const double press = values.at("reaction.press_z");
    EXPECT_NEAR(press, values.at("contact.block.plate_z"), 1e-9 * std::max(1.0, std::abs(press)));
    EXPECT_NEAR(values.at("reaction.2_x"), values.at("contact.block.plate_x"),
                1e-9 * std::max(1.0, std::abs(press)));
    largest = std::min(largest, press);
    now.forces->begin_interval();
  });
  EXPECT_LT(largest, -1e3);
}

TEST(Forces, AWallReturnsTheMomentumItTakes) {
  for (const Element& element : {Element(hex8()), Element(Rigid{})}) {
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {box("block", {0.2, 0.2, 0.2}, {2, 2, 2}, {0, 0, 0.1001}, element)};
    deck.initial_conditions = {moving("block", {2, 0, -10})};
    RigidWall wall{{0, 0, 0}, {0, 0, 1}, {}, 0.2};
    wall.label = "floor";
    deck.boundary_conditions = {wall};
    deck.time.end = 1e-3;
    if (std::holds_alternative<Rigid>(element)) deck.time.step = 1e-5;
    deck.output.history.forces.emplace().reactions.names = {"floor"};
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    const Vector3d force = vector_of(forces_of(model), "reaction.floor");
    Vector3d change = model.momentum.walls.linear;
    for (double& component : change) component /= model.forces->duration;
    expect_near(force, change, 1e-9, "wall");
    EXPECT_GT(force[2], 0);
  }
}

// ---- sections

/// Compares the sections with expected values at each step of a state that grows evenly.
template <class Expect>
void at_each_step(Model& model, int steps, const Expect& expect) {
  ThreadTeam team(1);
  look_at_steps(model, steps, 1e9, team, [&](int step) {
    if (step > 0) expect(forces_of(model), model.times.time);
    model.forces->begin_interval();
  });
}

TEST(Forces, APulledBarBearsItsStress) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("left", {0.5, 0.1, 0.2}, {5, 2, 2}, {0.25, 0, 0}, inviscid_hex8()),
                box("right", {0.5, 0.1, 0.2}, {5, 2, 2}, {0.75, 0, 0}, inviscid_hex8())};
  deck.connections = {Merge{{"left", "right"}, 1e-6, ""}};
  constexpr double rate = 1e-3;
  deck.boundary_conditions = {named("held", fix("left.xmin", {0})),
                              named("grip", pulled("right.xmax", 0, rate))};
  deck.time.end = 1;
  ForceOutput& forces = deck.output.history.forces.emplace();
  forces.reactions.all = true;
  forces.sections = {{"cut", "left", {0.23, 0, 0}, {1, 0, 0}}, {"back", "right", {0.81, 0, 0}, {-2, 0, 0}}};
  Model model = build_model(deck);
  for (NodeRecord& node : model.nodes.record) node.velocity[0] = rate * node.position[0];
  at_each_step(model, 50, [&](const auto& values, double time) {
    const double force = 1e9 * 0.02 * std::log1p(rate * time);
    EXPECT_NEAR(values.at("section.cut_x"), force, 1e-6 * force);
    EXPECT_NEAR(values.at("section.back_x"), -force, 1e-6 * force);
    EXPECT_NEAR(values.at("section.cut_y"), 0, 1e-6 * force);
    EXPECT_NEAR(values.at("section.cut_my"), 0, 1e-6 * force);
    EXPECT_NEAR(values.at("reaction.held_x"), -force, 1e-6 * force);
    EXPECT_NEAR(values.at("reaction.grip_x"), force, 1e-6 * force);
  });
}

/// Velocities of a curvature that is the same along x and grows at a rate: w'' = rate t.
void bend(Model& model, double rate) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const double x = model.nodes.record[i].position[0];
    model.nodes.record[i].velocity[2] = 0.5 * rate * x * (x - 1);
    model.nodes.angular_velocity[i].component[1] = -0.5 * rate * (2 * x - 1);
  }
}

void expect_bending(Part part, const std::string& start, const std::string& end, double stiffness,
                    double axial_stiffness) {
  constexpr double rate = 1e-3;
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {std::move(part)};
  deck.boundary_conditions = {fix(start, {2}), fix(end, {2}), pulled(start, 4, 0.5 * rate),
                              pulled(end, 4, -0.5 * rate)};
  deck.time.end = 1;
  deck.output.history.forces.emplace().sections = {{"cut", "part", {0.52, 0, 0}, {1, 0, 0}}};
  Model model = build_model(deck);
  bend(model, rate);
  at_each_step(model, 30, [&](const auto& values, double time) {
    const double moment = stiffness * rate * time;
    EXPECT_NEAR(values.at("section.cut_my"), -moment, 1e-6 * moment);
    EXPECT_NEAR(values.at("section.cut_mx"), 0, 1e-6 * moment);
    EXPECT_NEAR(values.at("section.cut_x"), 0, 1e-12 * axial_stiffness);
    EXPECT_NEAR(values.at("section.cut_z"), 0, 1e-6 * moment);
  });
}

TEST(Forces, ABentBeamBearsItsMoment) {
  Beam2 beam;
  beam.section = RectangleSection{.width = 0.04, .height = 0.06};
  beam.orientation = {0, 0, 1};
  beam.linear_bulk_viscosity = 0;
  expect_bending({"part", LineMesh{{0, 0, 0}, {1, 0, 0}, 10}, {}, beam, "material"}, "part.start", "part.end",
                 1e9 * 0.04 * std::pow(0.06, 3) / 12, 1e9 * 0.04 * 0.06);
}

TEST(Forces, ABentStripOfShellsBearsItsMoment) {
  Shell4 shell;
  shell.thickness = 0.02;
  PlateMesh mesh;
  mesh.size = {1, 0.1};
  mesh.elements = {10, 1};
  Placement placement;
  placement.translate = {0.5, 0, 0};
  expect_bending({"part", mesh, placement, shell, "material"}, "part.xmin", "part.xmax",
                 1e9 * 0.1 * std::pow(0.02, 3) / 12, 1e9 * 0.1 * 0.02);
}

TEST(Forces, ASectionThatCutsNothingIsRefused) {
  Deck deck = oblique_impact();
  deck.output.history.forces->sections = {{"cut", "block", {9, 0, 0}, {1, 0, 0}, "deck.yaml:3:4"}};
  try {
    build_model(deck);
    FAIL() << "built";
  } catch (const BuildError& error) {
    EXPECT_NE(std::string(error.what()).find("cuts no element of part 'block'"), std::string::npos);
    EXPECT_EQ(error.place, "deck.yaml:3:4");
  }
}

TEST(Forces, OfContactThatTheDeckDoesNotNameAreRefused) {
  Deck deck = oblique_impact();
  deck.contact.reset();
  deck.output.history.forces->contact.place = "deck.yaml:5:6";
  try {
    build_model(deck);
    FAIL() << "built";
  } catch (const BuildError& error) {
    EXPECT_NE(std::string(error.what()).find("the deck has no section 'contact'"), std::string::npos);
    EXPECT_EQ(error.place, "deck.yaml:5:6");
  }
}

// The normal is z: what acts across it is friction, of Coulomb's size while the block slides.
TEST(Forces, FrictionIsWhatActsAlongASurface) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {0.2, 0.2, 0.2}, {2, 2, 2}, {0, 0, 0.1001}, hex8()),
                box("floor", {2, 2, 0.1}, {2, 2, 1}, {0.02, 0.01, -0.05}, Rigid{})};
  deck.boundary_conditions = {fix("floor", {0, 1, 2, 3, 4, 5})};
  deck.initial_conditions = {moving("block", {8, 6, -1})};
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 5e-4;
  deck.output.history.forces = all_forces();
  Model model = build_model(deck);
  ThreadTeam team(1);
  double largest = 0;
  run(model, deck, team, [&](Model& now) {
    const auto values = forces_of(now);
    const Vector3d force = vector_of(values, "contact.block.floor"),
                   friction = vector_of(values, "contact.block.floor.friction");
    const double scale = 1e-6 * std::max(1.0, force[2]);  // the normal is that of points that are near
    EXPECT_NEAR(friction[0], force[0], scale);
    EXPECT_NEAR(friction[1], force[1], scale);
    EXPECT_NEAR(friction[2], 0, scale);
    EXPECT_NEAR(std::hypot(friction[0], friction[1]), 0.3 * force[2], 1e-3 * std::max(1.0, force[2]));
    largest = std::max(largest, force[2]);
    now.forces->begin_interval();
  });
  EXPECT_GT(largest, 1e3);
}

// ---- rows

TEST(Forces, AreColumnsOfTheHistoryAndPartOfTheState) {
  Deck deck = oblique_impact();
  deck.output.history.forces->reactions = {.names = {"east"}};
  Model model = build_model(deck);
  const std::vector<std::string> columns = history_columns(model);
  EXPECT_TRUE(std::ranges::count(columns, "reaction.east_z") == 1);
  EXPECT_TRUE(std::ranges::count(columns, "reaction.west_z") == 0);
  EXPECT_TRUE(std::ranges::count(columns, "contact.plate.plate_x") == 1);
  ThreadTeam team(1);
  make_steps(model, 40, 1, team);
  std::vector<double> row;
  observe_history(model, row);
  EXPECT_EQ(row.size(), columns.size());
  std::stringstream state;
  save_state(model, state);
  Model restored = build_model(deck);
  restore_state(restored, state, state.str().size());
  EXPECT_EQ(restored.forces->impulses(), model.forces->impulses());
  EXPECT_GT(model.forces->duration, 0);
}

}  // namespace
}  // namespace brio
