// Mass that small elements get: the time step gained, and the energy balance.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/breakdown.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// A bar with a thin slice in its middle, two parts on either side of it, that hits a wall.
Deck sliced_bar(const Element& element) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("left", {1, 0.2, 0.2}, {10, 2, 2}, {-0.505, 0, 0}, element),
                box("slice", {0.01, 0.2, 0.2}, {1, 2, 2}, {0, 0, 0}, element),
                box("right", {1, 0.2, 0.2}, {10, 2, 2}, {0.505, 0, 0}, element)};
  deck.connections = {Merge{{"left", "slice"}, 1e-6, ""}, Merge{{"slice", "right"}, 1e-6, ""}};
  for (const char* part : {"left", "slice", "right"})
    deck.initial_conditions.push_back(moving(part, {10, 2, 1}));
  deck.boundary_conditions = {RigidWall{{1.005, 0, 0}, {-1, 0, 0}, {}, 0}};
  deck.time.end = 5e-3;
  return deck;
}

void run_to_end(Model& model, const Deck& deck, int threads = 1) {
  ThreadTeam team(threads);
  run(model, deck, team);
}

double first_step(const Deck& deck) {
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, 1, team);
  return model.control.first;
}

void balance(Model& model) {
  std::vector<double> row;
  observe_history(model, row);
}

double mass_of_nodes(const Model& model) {
  double sum = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) sum += model.nodes.mass[i];
  return sum;
}

TEST(MassScaling, GivesSmallElementsTheStepThatIsAskedFor) {
  for (const Element& element : {Element(hex8()), Element(Hex8Full{})}) {
    Deck deck = sliced_bar(element);
    deck.time.step_bound = StepBound::elements;
    Model plain = build_model(deck);
    run_to_end(plain, deck);
    const double wanted = 5 * plain.control.first;
    deck.time.mass_scaling = MassScaling{wanted, 0.5};
    Model model = build_model(deck);
    const double mass = mass_of_nodes(model);
    run_to_end(model, deck);
    EXPECT_NEAR(model.control.first, wanted, 1e-12 * wanted);
    EXPECT_GT(model.control.least, 0.98 * wanted) << "quadratic viscosity alone takes something off";
    EXPECT_LT(9 * model.step, 2 * plain.step);
    EXPECT_GT(model.added_mass->added[1], 0);
    EXPECT_LT(model.added_mass->added[0], 0.01 * model.added_mass->added[1]);
    EXPECT_NEAR(mass_of_nodes(model), mass + model.added_mass->total(), 1e-12 * mass);
    EXPECT_LT(model.energy.error_max, 1e-3);
    balance(model);
    EXPECT_LT(model.momentum.linear_imbalance(), 1e-12);
    EXPECT_LT(model.momentum.angular_imbalance(), 1e-12);
    const double speed = momentum_of(model)[0] / mass_of_nodes(model);
    EXPECT_NEAR(speed, momentum_of(plain)[0] / mass, 0.02 * 10) << "it comes back as if a little heavier";
  }
}

TEST(MassScaling, OfFourTimesTheMassDoublesTheStep) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("cube", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, hex8())};
  deck.initial_conditions = {moving("cube", {3, 0, 0})};
  deck.time.end = 1;
  const double stable = first_step(deck);
  deck.time.mass_scaling = MassScaling{2 * stable, 4};
  Model model = build_model(deck);
  const double mass = mass_of_nodes(model);
  ThreadTeam team(1);
  update_velocities(model, 1, team);
  EXPECT_NEAR(model.control.first, 2 * stable, 1e-12 * stable);
  EXPECT_NEAR(mass_of_nodes(model), 4 * mass, 1e-12 * mass);
  EXPECT_NEAR(model.energy.kinetic_start, 0.5 * 4 * mass * 9, 1e-10 * mass);
  EXPECT_LT(std::abs(model.energy.relative_error()), 1e-14);
}

Part plate(const std::string& name, std::array<double, 2> size, std::array<int, 2> elements) {
  Shell4 shell;
  shell.thickness = 0.05;
  shell.linear_bulk_viscosity = 0;  // nothing damps what is unstable
  return {name, PlateMesh{size, elements}, {}, shell, "material"};
}

Part beam_along(const std::string& name, const Vector3d& start, const Vector3d& end, int elements) {
  Beam2 element;
  element.section = CircleSection{.radius = 0.02};
  element.linear_bulk_viscosity = 0;
  return {name, LineMesh{start, end, elements}, {}, element, "material"};
}

// Free vibration that a too large step would blow up.
TEST(MassScaling, StepIsStableForEveryElementThatTurns) {
  const Deck shells = [] {
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {plate("plate", {1, 1}, {8, 8}), plate("strip", {0.02, 1}, {1, 8})};
    deck.parts[1].placement.translate = {0.51, 0, 0};
    deck.connections = {Merge{{"plate", "strip"}, 1e-6, ""}};
    deck.initial_conditions = {moving("strip", {1, 0.3, 2})};
    deck.time.end = 0.4;
    return deck;
  }();
  const Deck beams = [] {
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {beam_along("long", {0, 0, 0}, {1, 0, 0}, 10),
                  beam_along("short", {1, 0, 0}, {1.01, 0, 0}, 1)};
    deck.connections = {Merge{{"long", "short"}, 1e-6, ""}};
    deck.initial_conditions = {moving("short", {1, 0.3, 2})};
    deck.time.end = 0.4;
    return deck;
  }();
  for (Deck deck : {shells, beams}) {
    const double stable = first_step(deck);
    deck.time.mass_scaling = MassScaling{4 * stable, 1};
    Model model = build_model(deck);
    ThreadTeam team(1);
    double half_way = 0, late = 0;  // the last two steps are shorter, which shows in the energy error
    run(model, deck, team, [&](Model& m) {
      if (m.times.time < 0.5 * deck.time.end) half_way = m.energy.relative_error();
      if (m.times.time < 0.95 * deck.time.end) late = m.energy.relative_error();
    });
    EXPECT_NEAR(model.control.first, 4 * stable, 1e-12 * stable);
    EXPECT_GT(model.step, 3000);
    EXPECT_GT(model.added_mass->added[1], 0);
    EXPECT_LT(model.energy.error_max, 1e-2) << "a jump of velocity is caught with a large step";
    EXPECT_NEAR(late, half_way, 2e-4) << "what is unstable grows";
    balance(model);
    EXPECT_LT(model.momentum.angular_imbalance(), 1e-11);
  }
}

// Copper that is crushed: elements lose most of their height.
Deck crushed() {
  ElasticPlastic copper;
  copper.density = 8930;
  copper.youngs_modulus = 117e9;
  copper.poissons_ratio = 0.35;
  copper.yield_stress = 400e6;
  copper.hardening_modulus = 100e6;
  Deck deck;
  deck.materials = {{"material", copper}};
  deck.parts = {box("bar", {5e-3, 5e-3, 20e-3}, {4, 4, 16}, {0, 0, 10e-3}, hex8())};
  deck.initial_conditions = {moving("bar", {0, 0, -200})};
  deck.boundary_conditions = {RigidWall{{0, 0, 0}, {0, 0, 1}, {}, 0}};
  deck.time.end = 40e-6;
  return deck;
}

double shortening(const Model& model) {
  double highest = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    highest = std::max(highest, model.nodes.record[i].position[2]);
  return 20e-3 - highest;
}

TEST(MassScaling, HoldsTheStepWhileElementsAreCrushed) {
  Deck deck = crushed();
  deck.time.step_bound = StepBound::elements;
  Model plain = build_model(deck);
  run_to_end(plain, deck);
  ASSERT_LT(plain.control.least, 0.6 * plain.control.first) << "the scene is worth it";
  deck.time.mass_scaling = MassScaling{0.5 * plain.control.first, 0.5};
  Model model = build_model(deck);
  run_to_end(model, deck);
  EXPECT_GT(model.control.least, 0.45 * plain.control.first);
  EXPECT_GT(model.added_mass->share(), 0.01);
  EXPECT_LT(model.energy.error_max, 1e-2);
  balance(model);
  EXPECT_LT(model.momentum.linear_imbalance(), 1e-12);
  const double shortened = shortening(plain), with_mass = shortening(model);
  EXPECT_NEAR(with_mass, shortened, 0.01 * shortened);
}

TEST(MassScaling, IsTheSameForAnyNumberOfThreads) {
  Deck deck = crushed();
  deck.time.mass_scaling = MassScaling{4e-8, 1};
  Model one = build_model(deck), three = build_model(deck);
  run_to_end(one, deck, 1);
  run_to_end(three, deck, 3);
  ASSERT_GT(one.added_mass->total(), 0);
  EXPECT_EQ(one.added_mass->total(), three.added_mass->total());
  for (std::size_t i = 0; i < one.nodes.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      ASSERT_EQ(one.nodes.record[i].velocity[axis], three.nodes.record[i].velocity[axis]);
}

TEST(MassScaling, StopsWhereTooMuchIsAdded) {
  Deck deck = crushed();
  deck.time.mass_scaling = MassScaling{1e-6, 0.05};
  Model model = build_model(deck);
  ThreadTeam team(1);
  try {
    update_velocities(model, 1, team);
    FAIL() << "added " << model.added_mass->share();
  } catch (const Breakdown& stop) {
    EXPECT_NE(std::string(stop.what()).find("most to part 'bar'"), std::string::npos) << stop.what();
  }
}

TEST(MassScaling, RefusesWhatItCannotServe) {
  Deck deck = crushed();
  deck.time.mass_scaling = MassScaling{1e-8, 0.05};
  deck.parts[0].deletion = Deletion{.volume_ratio = 0.1};
  EXPECT_THROW(build_model(deck), BuildError);
}

}  // namespace
}  // namespace brio
