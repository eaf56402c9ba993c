// Parts that share nodes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/core/output/snapshot_parts.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

Part plate(std::string name, std::array<double, 2> size, std::array<int, 2> elements, Vector3d centre,
           double thickness = 0.05) {
  Shell4 shell;
  shell.thickness = thickness;
  PlateMesh mesh;
  mesh.size = size;
  mesh.elements = elements;
  Placement placement;
  placement.translate = centre;
  return {std::move(name), mesh, placement, shell, "material"};
}

Connection merged(std::string first, std::string second, double tolerance = 1e-6) {
  return Merge{{std::move(first), std::move(second)}, tolerance, "deck.yaml:3:5"};
}

NodalForce push(std::string set, Vector3d force) {
  NodalForce load;
  load.where.set = std::move(set);
  load.force = force;
  return load;
}

Deck one_plate() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {plate("whole", {2, 1}, {8, 4}, {0, 0, 0})};
  deck.boundary_conditions = {fix("whole.xmin", {0, 1, 2, 3, 4, 5})};
  deck.loads = {push("whole.xmax", {0, 20, 50})};
  deck.time.end = 0.05;
  return deck;
}
/// The same in two halves.
Deck two_plates(Vector3d shift = {0, 0, 0}, double tolerance = 1e-6) {
  Deck deck = one_plate();
  deck.parts = {plate("left", {1, 1}, {4, 4}, {-0.5, 0, 0}),
                plate("right", {1, 1}, {4, 4}, {0.5 + shift[0], shift[1], shift[2]})};
  deck.connections = {merged("left", "right", tolerance)};
  deck.boundary_conditions = {fix("left.xmin", {0, 1, 2, 3, 4, 5})};
  deck.loads = {push("right.xmax", {0, 20, 50})};
  return deck;
}

/// Positions at the end, by those at the start.
std::vector<std::array<double, 6>> paths(Model& model, const Deck& deck) {
  std::vector<std::array<double, 6>> all(model.nodes.size());
  for (std::size_t n = 0; n < all.size(); ++n) std::copy_n(model.nodes.record[n].position, 3, all[n].begin());
  ThreadTeam team(1);
  run(model, deck, team);
  for (std::size_t n = 0; n < all.size(); ++n)
    std::copy_n(model.nodes.record[n].position, 3, all[n].begin() + 3);
  std::sort(all.begin(), all.end());
  return all;
}

void expect_same_paths(const Deck& a, const Deck& b) {
  Model one = build_model(a), other = build_model(b);
  const auto reference = paths(one, a), found = paths(other, b);
  ASSERT_EQ(found.size(), reference.size());
  double largest = 0;
  for (std::size_t n = 0; n < found.size(); ++n)
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(found[n][i], reference[n][i], i < 3 ? 0 : 1e-12);
      largest = std::max(largest, std::abs(found[n][i] - (i < 3 ? found[n][i] : found[n][i - 3])));
    }
  EXPECT_GT(largest, 0.01);
}

TEST(MergedParts, TwoPlatesAlongAnEdgeAreOnePlate) { expect_same_paths(one_plate(), two_plates()); }

TEST(MergedParts, TwoPlatesInContactFeelNothingOfEachOther) {
  Deck deck = two_plates();
  deck.contact.emplace();
  expect_same_paths(one_plate(), deck);
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_EQ(model.contacts[0].totals.most_contacts, 0);
}

TEST(MergedParts, TwoBoxesOverASideAreOneBox) {
  Deck one;
  one.materials = {{"material", elastic(0.3)}};
  one.parts = {box("whole", {2, 1, 1}, {8, 4, 4}, {0, 0, 0}, hex8())};
  one.boundary_conditions = {fix("whole.xmin", {0, 1, 2})};
  one.loads = {push("whole.xmax", {5000, 20000, 5000})};
  one.time.end = 5e-3;
  one.contact.emplace();
  Deck two = one;
  two.parts = {box("left", {1, 1, 1}, {4, 4, 4}, {-0.5, 0, 0}, hex8()),
               box("right", {1, 1, 1}, {4, 4, 4}, {0.5, 0, 0}, hex8())};
  two.connections = {merged("left", "right")};
  two.boundary_conditions = {fix("left.xmin", {0, 1, 2})};
  two.loads = {push("right.xmax", {5000, 20000, 5000})};
  expect_same_paths(one, two);
  Model model = build_model(two);
  EXPECT_EQ(model.contacts[0].surface.face.size(), build_model(one).contacts[0].surface.face.size());
}

TEST(MergedParts, PointsAndMassesAreCountedOnce) {
  const Deck deck = two_plates();
  Model model = build_model(deck);
  EXPECT_EQ(model.nodes.size(), 45u);
  ASSERT_EQ(model.merged.size(), 1u);
  EXPECT_EQ(model.merged[0].nodes, 5);
  EXPECT_DOUBLE_EQ(model.parts[0].mass, 50);
  EXPECT_DOUBLE_EQ(model.parts[1].mass, 50);
  double mass = 0;
  for (double m : model.nodes.mass) mass += m;
  EXPECT_DOUBLE_EQ(mass, 100);
  FieldObserver observer(model);
  ThreadTeam team(1);
  update_velocities(model, 1, team);
  const Snapshot& snapshot = observer.observe(model);
  EXPECT_EQ(snapshot.points.size(), 3 * 45u);
  EXPECT_EQ(snapshot.topology.cell_type.size(), 32u);
  expect_parts_hold_their_cells(snapshot);
  std::vector<int> uses(45, 0);
  for (const std::int64_t point : snapshot.topology.connectivity) ++uses[index(point)];
  EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0);
  EXPECT_EQ(observe_end(model).nodes, 45);
  EXPECT_DOUBLE_EQ(observe_end(model).mass.start, 100);
}

TEST(MergedParts, RegionThatHoldsAJointPushesItOnce) {
  Deck deck = two_plates();
  deck.boundary_conditions = {};
  NodalForce force = push("", {1, 0, 0});
  force.where.region = BoxRegion{{-0.01, -1, -1}, {0.01, 1, 1}};
  deck.loads = {force};
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, 1, team);
  EXPECT_DOUBLE_EQ(momentum_of(model)[0], 5 * 0.5 * model.times.next);
}

TEST(MergedParts, NodesOfTheSecondMoveToThoseOfTheFirst) {
  const Deck deck = two_plates({2e-3, 1e-3, 2e-3}, 4e-3);
  Model model = build_model(deck);
  EXPECT_EQ(model.merged[0].nodes, 5);
  EXPECT_NEAR(model.merged[0].farthest, 3e-3, 1e-15);
  int on_the_joint = 0;
  for (const NodeRecord& record : model.nodes.record)
    if (std::abs(record.position[0]) < 0.01) {
      ++on_the_joint;
      EXPECT_EQ(record.position[0], 0);
      EXPECT_EQ(record.position[2], 0);
    }
  EXPECT_EQ(on_the_joint, 5);
}

TEST(MergedParts, BitsDoNotDependOnTheNumberOfThreads) {
  Deck deck = two_plates();
  deck.parts = {plate("left", {1, 1}, {40, 40}, {-0.5, 0, 0}), plate("right", {1, 1}, {40, 40}, {0.5, 0, 0})};
  deck.time.end = 2e-3;
  std::vector<Model> models;
  for (int threads : {1, 2, 4}) {
    models.push_back(build_model(deck));
    ThreadTeam team(threads);
    run(models.back(), deck, team);
  }
  EXPECT_GT(models[0].schedule.tasks.size(), 8u);
  for (std::size_t i = 1; i < models.size(); ++i)
    EXPECT_EQ(std::memcmp(models[0].nodes.record.data(), models[i].nodes.record.data(),
                          models[0].nodes.size() * sizeof(NodeRecord)),
              0);
}

// ---- other elements

constexpr double strip_length = 1, strip_width = 0.1, strip_thickness = 0.02, beam_side = 0.03;

/// A strip of shells with a beam along its middle, clamped at one end; their middle lines coincide.
Deck stiffened_strip() {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  Beam2 beam;
  beam.section = RectangleSection{.width = beam_side, .height = beam_side};
  beam.orientation = {0, 0, 1};
  deck.parts = {
      plate("strip", {strip_length, strip_width}, {16, 2}, {0.5 * strip_length, 0, 0}, strip_thickness),
      {"stiffener", LineMesh{{0, 0, 0}, {strip_length, 0, 0}, 16}, {}, beam, "material"}};
  deck.connections = {merged("strip", "stiffener")};
  deck.boundary_conditions = {fix("strip.xmin", {0, 1, 2, 3, 4, 5})};
  deck.loads = {push("strip.xmax", {0, 0, 0.5})};
  return deck;
}

TEST(MergedParts, StiffenedStripSwingsAsOneBeam) {
  Deck deck = stiffened_strip();
  const double bending = 1e9 * (strip_width * std::pow(strip_thickness, 3) + std::pow(beam_side, 4)) / 12;
  const double line_mass = 1000 * (strip_width * strip_thickness + beam_side * beam_side);
  const double frequency = 3.5160 * std::sqrt(bending / line_mass) / (2 * M_PI);
  constexpr int swings = 10;
  deck.time.end = (swings + 0.75) / frequency;
  Model model = build_model(deck);
  EXPECT_EQ(model.merged[0].nodes, 17);
  EXPECT_NEAR(model.parts[1].mass, 1000 * beam_side * beam_side, 1e-12);
  const auto tip = index(model.parts[1].node[16]);
  const auto tip_inertia = model.nodes.rotational_inertia[tip];
  EXPECT_GT(tip_inertia, 0);
  std::vector<double> crossings;  // of the mean deflection, upwards
  const double mean = 1.5 * std::pow(strip_length, 3) / (3 * bending);
  double before = 0, time_before = 0;
  ThreadTeam team(1);
  run(model, deck, team, [&](Model& m) {
    const double height = m.nodes.record[tip].position[2] - mean;
    if (before < 0 && height >= 0)
      crossings.push_back(time_before + (m.times.time - time_before) * before / (before - height));
    before = height;
    time_before = m.times.time;
  });
  ASSERT_EQ(crossings.size(), index(swings + 1));
  EXPECT_NEAR(swings / (crossings.back() - crossings.front()) / frequency, 1, 0.01);
  EXPECT_LT(model.energy.error_max, 1e-3);
  model.momentum.now = momentum(model.nodes).total;
  EXPECT_LT(model.momentum.angular_imbalance(), 1e-10);
}

TEST(MergedParts, StiffenerDoesNotTouchThePanelThatItIsPartOf) {
  Deck deck = stiffened_strip();
  // Nodes of the panel lie inside the beam.
  deck.parts[0] =
      plate("strip", {strip_length, strip_width}, {16, 8}, {0.5 * strip_length, 0, 0}, strip_thickness);
  deck.loads = {push("strip.xmax", {0, 0, 10})};
  deck.time.end = 0.2;
  Model free = build_model(deck);
  const auto reference = paths(free, deck);
  deck.contact.emplace();
  Model model = build_model(deck);
  const auto found = paths(model, deck);
  EXPECT_EQ(model.contacts[0].totals.most_contacts, 0);
  EXPECT_EQ(found, reference);
  EXPECT_GT(model.nodes.record[index(model.parts[1].node[16])].position[2], 0.1);
}

TEST(MergedParts, ElementWithoutRotationsHoldsABeamAsAHinge) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Beam2 beam;
  beam.section = CircleSection{.radius = 0.05};
  deck.parts = {box("block", {1, 1, 1}, {1, 1, 1}, {-0.5, 0.5, 0.5}, hex8()),
                {"rod", LineMesh{{0, 0, 0}, {1, 0, 0}, 8}, {}, beam, "material"}};
  deck.connections = {merged("block", "rod")};
  deck.boundary_conditions = {fix("block", {0, 1, 2})};
  InitialCondition turning = moving("rod", {0, 0, 0});
  turning.spin = Spin{{0, 0, 0}, {0, 0, 5}};
  deck.initial_conditions = {turning};
  deck.time.end = 2 * M_PI / 5 / 4;
  Model model = build_model(deck);
  EXPECT_EQ(model.merged[0].nodes, 1);
  ThreadTeam team(1);
  run(model, deck, team);
  const double* tip = model.nodes.record[index(model.parts[1].node[8])].position;
  EXPECT_NEAR(tip[0], 0, 1e-2);
  EXPECT_NEAR(tip[1], 1, 1e-2);
  EXPECT_NEAR(model.energy.kinetic / model.energy.kinetic_start, 1, 1e-2);
}

// ---- what cannot be merged

std::string fault_of_merge(const Deck& deck) {
  try {
    build_model(deck);
  } catch (const BuildError& fault) {
    return fault.place + ": " + fault.what();
  }
  return {};
}

TEST(MergedParts, FarFromEachOtherAreRefused) {
  EXPECT_EQ(fault_of_merge(two_plates({1e-3, 0, 0}, 1e-4)),
            "deck.yaml:3:5: no node of 'right' lies within 0.0001 of a node of 'left'; at least one pair of "
            "nodes is expected");
}

TEST(MergedParts, ThatWouldFoldAnElementAreRefused) {
  EXPECT_EQ(fault_of_merge(two_plates({0, 0, 0}, 0.3)),
            "deck.yaml:3:5: two nodes of part 'right' would become one; accepted is a tolerance below the "
            "distance of its nodes");
}

}  // namespace
}  // namespace brio
