// Beams in whole scenes.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

Beam2 square_beam(double side, double viscosity = 0) {
  Beam2 beam;
  beam.section = RectangleSection{.width = side, .height = side};
  beam.orientation = {0, 0, 1};
  beam.linear_bulk_viscosity = viscosity;
  return beam;
}
Beam2 round_beam(double radius) {
  Beam2 beam;
  beam.section = CircleSection{.radius = radius};
  return beam;
}

Part line(std::string name, Vector3d start, Vector3d end, int elements, const Beam2& beam) {
  return {std::move(name), LineMesh{start, end, elements}, {}, beam, "material"};
}

Deck one_line(const Part& part, double end, const Material& material = elastic()) {
  Deck deck;
  deck.materials = {{"material", material}};
  deck.parts = {part};
  deck.time.end = end;
  return deck;
}

NodalForce push(std::string set, Vector3d force) {
  NodalForce load;
  load.where.set = std::move(set);
  load.force = force;
  return load;
}

const NodeRecord& node_of(const Model& model, int node) {
  return model.nodes.record[index(model.parts[0].node[index(node)])];
}
ElementSample sample_of(const Model& model, int element) {
  const auto slot = index(model.parts[0].element_slot[index(element)]);
  return model.blocks[0].kernel.sample(model.blocks[0], model.nodes, slot, true);
}

TEST(Beams, StepLoadRunsAlongABarAtTheWaveSpeed) {
  Deck deck = one_line(line("bar", {0, 0, 0}, {1, 0, 0}, 100, square_beam(0.01, 0.06)), 0.5e-3);
  deck.loads = {push("bar.start", {100, 0, 0})};  // stress 1e6
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  double front = 0, largest = 0;
  for (int e = 0; e < 100; ++e) {
    const double stress = -sample_of(model, e).stress.xx;
    largest = std::max(largest, stress);
    front += 0.01 * stress / 1e6;  // momentum carried: area under the profile
  }
  EXPECT_NEAR(front, 0.5, 0.005);
  EXPECT_LE(largest, 1.1e6);
}

TEST(Beams, CantileverUnderASuddenLoadSwingsAboutItsStaticDeflection) {
  constexpr double side = 0.05;
  Deck deck = one_line(line("beam", {0, 0, 0}, {1, 0, 0}, 8, square_beam(side)), 1, elastic(0.3));
  deck.boundary_conditions = {fix("beam.start", {0, 1, 2, 3, 4, 5})};
  constexpr double force = 1;
  deck.loads = {push("beam.end", {0, 0, force})};
  const double moment = std::pow(side, 4) / 12;
  const double first = 3.516 * std::sqrt(1e9 * moment / (1000 * side * side));  // circular frequency
  constexpr int swings = 20;
  deck.time.end = swings * 2 * M_PI / first;
  Model model = build_model(deck);
  ThreadTeam team(1);
  double sum = 0;
  run(model, deck, team, [&](Model& m) { sum += node_of(m, 8).position[2] * m.times.next; });
  const double exact = force / (3e9 * moment) + force / (5.0 / 6 * 1e9 / 2.6 * side * side);
  EXPECT_NEAR(sum / deck.time.end / exact, 1, 0.01);
  EXPECT_LT(model.energy.error_max, 1e-3);
}

// Lines that fly, spin and bend, one of them held and pushed.
Deck many_beams() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {line("held", {0, 0, 0}, {40, 3, 1}, 2000, square_beam(0.02, 0.06)),
                line("free", {0, 1, 0}, {0, 5, 0.5}, 300, round_beam(0.03))};
  deck.boundary_conditions = {fix("held.start", {0, 1, 2, 3, 4, 5})};
  InitialCondition spin = moving("free", {1, 2, 3});
  spin.spin = Spin{{0, 2, 0}, {30, 5, 80}};
  deck.initial_conditions = {spin};
  Gravity gravity;
  gravity.acceleration = {0, 0, -9.81};
  deck.loads = {push("held.end", {0, 3, 50}), gravity};
  deck.time.end = 4e-3;
  return deck;
}

TEST(Beams, BitsDoNotDependOnTheNumberOfThreads) {
  const Deck deck = many_beams();
  std::vector<Model> models;
  for (int threads : {1, 2, 4}) {
    models.push_back(build_model(deck));
    ThreadTeam team(threads);
    run(models.back(), deck, team);
  }
  EXPECT_GT(models[0].schedule.tasks.size(), 2u);
  for (std::size_t i = 1; i < models.size(); ++i) {
    ASSERT_EQ(std::memcmp(models[0].nodes.record.data(), models[i].nodes.record.data(),
                          models[0].nodes.size() * sizeof(NodeRecord)),
              0);
    ASSERT_EQ(std::memcmp(models[0].nodes.angular_velocity.data(), models[i].nodes.angular_velocity.data(),
                          models[0].nodes.size() * sizeof(NodeVector)),
              0);
    EXPECT_EQ(models[0].energy.internal, models[i].energy.internal);
  }
}

TEST(Beams, EnergyAndMomentumBalance) {
  const Deck deck = many_beams();
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_LT(model.energy.error_max, 1e-3);
  model.momentum.now = momentum(model.nodes).total;
  EXPECT_LT(model.momentum.linear_imbalance(), 1e-10);
  EXPECT_LT(model.momentum.angular_imbalance(), 1e-10);
}

TEST(Beams, StepAllocatesNothing) {
  const Deck deck = many_beams();
  Model model = build_model(deck);
  ThreadTeam team(2);
  make_steps(model, 5, 1, team);
  const AllocationCount allocations;
  make_steps(model, 20, 1, team);
  EXPECT_EQ(allocations.count(), 0u);
}

TEST(Beams, PowersOfTwoInTheUnitsGiveTheSameBits) {
  const auto end_of = [](double length, double time) {
    Elastic law = elastic(0.3);
    law.density /= length * length * length;
    law.youngs_modulus /= length * time * time;
    Deck deck =
        one_line(line("beam", {0, 0, 0}, {length, 0.25 * length, 0}, 10, square_beam(0.0625 * length)),
                 4e-3 * time, law);
    deck.boundary_conditions = {fix("beam.start", {0, 1, 2, 3, 4, 5})};
    deck.loads = {push("beam.end", {0, 0, 1e4 * length / (time * time)})};
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    return std::array{node_of(model, 10).position[0] / length, node_of(model, 10).position[2] / length,
                      static_cast<double>(model.step)};
  };
  const auto reference = end_of(1, 1);
  EXPECT_GT(reference[1], 0.01);
  EXPECT_EQ(end_of(1024, 1), reference);
  EXPECT_EQ(end_of(0.0078125, 0.03125), reference);
}

TEST(Beams, ResultsShowThemAsLinesWithTheirRadius) {
  Deck deck = one_line(line("beam", {0, 0, 0}, {1, 0, 0}, 4, round_beam(0.03)), 1e-4);
  deck.parts.push_back(box("box", {1, 1, 1}, {1, 1, 1}, {5, 0, 0}, hex8()));
  Model model = build_model(deck);
  FieldObserver observer(model);
  ThreadTeam team(1);
  update_velocities(model, 1, team);
  const Snapshot& snapshot = observer.observe(model);
  ASSERT_EQ(snapshot.topology.cell_type.size(), 5u);
  EXPECT_EQ(snapshot.topology.cell_type[0], line_cell);
  EXPECT_EQ(snapshot.topology.cell_type[4], hexahedron_cell);
  const FieldArray& radius = snapshot.cell_fields.back();
  EXPECT_EQ(radius.name, "radius");
  EXPECT_EQ(std::vector(radius.values.begin(), radius.values.end() - 1), std::vector(4, 0.03));
  EXPECT_TRUE(std::isnan(radius.values.back()));
  const Summary summary = observe_end(model);
  EXPECT_EQ(summary.elements["beam2"], 4);
  EXPECT_EQ(summary.elements["hex8"], 1);
  EXPECT_EQ(summary.elements["shell4"], 0);
}

TEST(Beams, AreHitUnlessTheDeckExcludesThem) {
  Deck deck = one_line(line("beam", {0, 0, -2}, {0, 0, 2}, 8, round_beam(0.03)), 0.02);
  deck.parts.push_back(box("left", {1, 1, 1}, {2, 2, 2}, {-1.2, 0, 0}, hex8()));
  deck.parts.push_back(box("right", {1, 1, 1}, {3, 3, 3}, {1.2, 0, 0}, hex8()));
  deck.initial_conditions = {moving("left", {100, 0, 0})};
  deck.contact.emplace();
  ThreadTeam team(1);
  Model hit = build_model(deck);
  run(hit, deck, team);
  EXPECT_GT(node_of(hit, 4).velocity[0], 10);
  deck.contact->exclude = {"beam"};
  Model model = build_model(deck);
  run(model, deck, team);
  // The boxes went through the beam and met each other.
  EXPECT_GT(mean_velocity(model, 2, 0), 10);
  for (int n = 0; n <= 8; ++n) EXPECT_EQ(node_of(model, n).velocity[0], 0) << n;
}

TEST(Beams, EnergyAndMomentumBalanceWhereTheyFold) {
  const ElasticPlastic law{
      .density = 7850, .youngs_modulus = 200e9, .poissons_ratio = 0.3, .yield_stress = 300e6};
  Deck deck = one_line(line("beam", {0, 0, 0}, {1, 0, 0}, 16, square_beam(0.05, 0.06)), 0.02, law);
  deck.boundary_conditions = {fix("beam.start", {0, 1, 2, 3, 4, 5})};
  deck.loads = {push("beam.end", {0, 1e4, 2e4})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_GT(node_of(model, 16).position[2], 0.3);
  EXPECT_GT(sample_of(model, 0).named("equivalent_plastic_strain"), 0.05);
  EXPECT_LT(model.energy.error_max, 1e-4);
  model.momentum.now = momentum(model.nodes).total;
  EXPECT_LT(model.momentum.angular_imbalance(), 1e-10);
}

TEST(Beams, TornOneIsDeletedAndItsHalvesFlyOn) {
  ElasticPlastic law{.density = 1000,
                     .youngs_modulus = 1e9,
                     .poissons_ratio = 0.3,
                     .yield_stress = 1e6,
                     .hardening_modulus = 1e7};
  law.failure.emplace();
  law.failure->strain = 0.05;
  law.failure->opening_displacement = 0.02;
  Deck deck = one_line(line("beam", {0, 0, 0}, {1, 0, 0}, 10, square_beam(0.05, 0.06)), 0.02, law);
  InitialCondition apart = moving("beam", {0, 0, 0});
  apart.where = {};
  apart.where.region = BoxRegion{{0.44, -1, -1}, {2, 1, 1}};
  apart.velocity = {100, 0, 0};
  deck.initial_conditions = {apart};
  deck.time.step_scale =
      0.3;  // the jump strains an element by percents a step, which is seen in the energy error
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  ASSERT_TRUE(model.erosion.has_value());
  EXPECT_GE(model.erosion->total_deleted(), 1);
  EXPECT_LE(model.erosion->total_deleted(), 3);
  EXPECT_LT(model.energy.error_max, 1e-3);
  EXPECT_GT(model.energy.deleted, 0);
  EXPECT_GT(node_of(model, 10).velocity[0], node_of(model, 0).velocity[0] + 5);
  FieldObserver observer(model);
  EXPECT_EQ(observer.observe(model).topology.cell_type.size(), 10 - index(model.erosion->total_deleted()));
}

TEST(Beams, OneAlongItsOrientationIsRefusedByName) {
  Deck deck = one_line(line("beam", {0, 0, 0}, {0, 0, 2}, 8, square_beam(0.1)), 1);
  try {
    build_model(deck);
    FAIL();
  } catch (const BuildError& error) {
    EXPECT_NE(std::string(error.what()).find("lies along the orientation"), std::string::npos)
        << error.what();
  }
}

// A steel cantilever, 1 m long and 20 mm thick, whose own weight is there at once. Rounding of strains that
// are differences of positions would heat it.
void expect_no_heat_under_own_weight(int steps) {
  Elastic steel = elastic(0.3);
  steel.density = 7800;
  steel.youngs_modulus = 207e9;
  constexpr double side = 0.02;
  Deck deck =
      one_line(line("beam", {0, 0, 0}, {1, 0, 0}, 16, square_beam(side, 0.06)), 9.33e-6 * steps, steel);
  deck.boundary_conditions = {fix("beam.start", {0, 1, 2, 3, 4, 5})};
  Gravity gravity;
  gravity.acceleration = {0, 0, -9.81};
  deck.loads = {gravity};
  deck.numerics.precision = Precision::single_precision;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_GT(model.step, 0.9 * steps);
  EXPECT_LE(model.energy.error_max, 1e-4);
}

TEST(OwnWeight, OfACantileverOfFloatBeamsDoesNotHeatIt) { expect_no_heat_under_own_weight(50000); }
TEST(OwnWeightSlow, OfACantileverOfFloatBeamsDoesNotHeatItInAMillionSteps) {
  expect_no_heat_under_own_weight(1000000);
}

}  // namespace
}  // namespace brio
