// Energies of elements: closed forms, and sums that are those of the balance.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

/// Sum over the elements of density times present volume.
double total_of(Model& model, const std::string& density) {
  const std::vector<std::string> wanted{density};
  FieldObserver observer(model, wanted);
  const FieldArray& field = observer.observe(model).cell_fields.back();
  EXPECT_EQ(field.name, density);
  double sum = 0;
  std::size_t cell = 0;
  for (const PartInModel& part : model.parts)
    for (const int slot : part.element_slot) {
      const Block& block = model.blocks[part.block];
      sum += field.values[cell++] * block.kernel.sample(block, model.nodes, index(slot), true).volume;
    }
  return sum;
}

void expect_energies_of_balance(Deck deck) {
  deck.time.end = 1;
  Model model = build_model(deck);
  // Motions that no element follows by uniform strain alone.
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    NodeRecord& node = model.nodes.record[i];
    const double x = node.position[0], y = node.position[1];
    node.velocity[0] = 2 * y * x;
    node.velocity[1] = -x * x;
    node.velocity[2] = 3 * x * y;
  }
  ThreadTeam team(1);
  make_steps(model, 200, 1, team);
  EXPECT_GT(model.energy.hourglass, 1e-6 * model.energy.internal);
  EXPECT_NEAR(total_of(model, "internal_energy_density"), model.energy.internal,
              1e-12 * model.energy.internal);
  EXPECT_NEAR(total_of(model, "hourglass_energy_density"), model.energy.hourglass,
              1e-10 * model.energy.hourglass);
}

TEST(EnergyFields, AddUpToTheBalance) {
  Deck bricks;
  bricks.materials = {{"material", elastic(0.3)}};
  bricks.parts = {box("brick", {1, 1, 0.3}, {3, 2, 1}, {0, 0, 0}, hex8())};
  expect_energies_of_balance(bricks);
  Deck shells = bricks;
  Shell4 shell;
  shell.thickness = 0.05;
  PlateMesh mesh;
  mesh.size = {1, 1};
  mesh.elements = {3, 2};
  shells.parts = {{"plate", mesh, {}, shell, "material"}};
  expect_energies_of_balance(shells);
}

// A bar of Poisson's ratio 0: over the present volume V0 l the energy is the integral of E ln(l) over dl, E
// (l ln l - l + 1) V0.
TEST(EnergyFields, DensityOfAStretchedBarIsTheIntegralOfItsStress) {
  constexpr double rate = 5;
  Deck deck;
  deck.materials = {{"material", elastic(0)}};
  deck.parts = {box("bar", {1, 0.2, 0.2}, {2, 1, 1}, {0.5, 0, 0}, inviscid_hex8())};
  PrescribedMotion pull;
  pull.where.set = "bar.xmax";
  pull.components = {{0, Curve{{{0, rate}}}}};
  deck.boundary_conditions = {fix("bar.xmin", {0}), pull};
  deck.time.end = 1;
  deck.time.step_bound = StepBound::elements;
  Model model = build_model(deck);
  for (NodeRecord& node : model.nodes.record) node.velocity[0] = rate * node.position[0];
  ThreadTeam team(1);
  const std::vector<std::string> wanted{"internal_energy_density"};
  FieldObserver observer(model, wanted);
  for (NodeRecord& node : model.nodes.record)
    node.inverse_mass = 0;  // velocities stay, and so it stretches evenly
  make_steps(model, 300, 1e9, team);
  const double stretch = 1 + rate * model.times.time;
  const double expected = 1e9 * (stretch * std::log(stretch) - stretch + 1) / stretch;
  for (const double density : observer.observe(model).cell_fields.back().values)
    EXPECT_NEAR(density, expected, 1e-6 * expected);
}

}  // namespace
}  // namespace brio
