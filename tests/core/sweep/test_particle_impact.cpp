// Particles that hit each other or a wall: rubber rings, and the copper rod of Taylor's test.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "tests/core/sweep/particle_scene.hpp"

namespace brio {
namespace {

using namespace test;

/// Two rings in one mesh, so that their particles see each other.
Mesh two_rings(double spacing, double distance) {
  ParticleMesh ring;
  ring.cylinder = ParticleCylinder{0.04, 2 * spacing, spacing, 0.03};
  const Mesh one = generate_mesh(ring, {});
  Mesh both;
  both.nodes_per_element = 1;
  for (const double side : {-1.0, 1.0})
    for (std::size_t i = 0; i < one.position.size(); ++i) {
      both.connectivity.push_back(static_cast<int>(both.position.size()));
      both.position.push_back(one.position[i]);
      both.position.back()[0] += 0.5 * side * distance;
      both.volume.push_back(one.volume[i]);
    }
  both.node_sets["all"] = both.connectivity;
  return both;
}

// Rings of Gray, Monaghan & Swift (2001): radii 0.03 and 0.04, E 1e7, nu 0.3975, each at 0.059 of the speed
// of sound; plane strain. Without measures against the tensile instability they break.
TEST(ParticleRingsSlow, ReboundWithoutNumericalFracture) {
  const double spacing = 0.002;
  Elastic rubber;
  rubber.density = 1000;
  rubber.youngs_modulus = 1e7;
  rubber.poissons_ratio = 0.3975;
  const double sound =
      std::sqrt(rubber.youngs_modulus / (3 * (1 - 2 * rubber.poissons_ratio)) / rubber.density);
  const double speed = 0.059 * sound;
  Deck deck;
  deck.materials = {{"material", rubber}};
  deck.parts = {particles("rings", ParticleMesh{}, particle(ParticleFrame::eulerian))};
  InitialCondition left = moving("", {speed, 0, 0}), right = moving("", {-speed, 0, 0});
  left.where = {"", BoxRegion{{-1, -1, -1}, {0, 1, 1}}, "rings"};
  right.where = {"", BoxRegion{{0, -1, -1}, {1, 1, 1}}, "rings"};
  deck.initial_conditions = {left, right};
  deck.boundary_conditions = {fix("rings.all", {2})};
  deck.time.end = 0.09 / speed;
  const std::vector<Mesh> meshes{two_rings(spacing, 0.084)};
  Model model = build(deck, meshes);
  const Momentum start = momentum(model.nodes);
  ThreadTeam team(2);
  const ParticleCloud& cloud = *model.blocks[0].cloud;
  int fewest_neighbours = 1000;
  run(model, deck, team, [&](Model& m) {
    if (m.step % 20 != 0) return;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      int neighbours = 0;
      for (std::size_t k = cloud.first[i]; k < cloud.first[i] + index(cloud.count[i]); ++k)
        neighbours += cloud.weight[k] > 0 ? 1 : 0;
      fewest_neighbours = std::min(fewest_neighbours, neighbours);
    }
  });
  // Those at a free corner of a ring have as many at the start; a crack would leave fewer.
  EXPECT_GE(fewest_neighbours, 20);
  double mass = 0, place = 0, velocity = 0;
  const std::vector<int>& node = model.parts[0].node;
  for (std::size_t i = 0; i < node.size() / 2; ++i) {
    const auto n = index(node[i]);
    mass += model.nodes.mass[n];
    place += model.nodes.mass[n] * model.nodes.record[n].position[0];
    velocity += model.nodes.mass[n] * model.nodes.record[n].velocity[0];
  }
  EXPECT_LT(place / mass, -0.045);
  EXPECT_LT(velocity / mass, -0.7 * speed);
  EXPECT_GT(velocity / mass, -0.85 * speed);
  const Momentum end = momentum(model.nodes);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(end.total.linear[i], start.total.linear[i], 1e-12 * start.linear_size);
  }
  EXPECT_NEAR(end.total.angular[2], start.total.angular[2], 1e-12 * start.angular_size);
  EXPECT_LT(model.energy.error_max, 1e-2);
}

// A lump that flows as water does: its halves meet at a tenth of its speed of sound and spread to a sheet,
// which breaks into threads.
TEST(ParticleSplashSlow, BalancesEnergyAndKeepsItsTimeStep) {
  ElasticPlastic water;
  water.density = 1000;
  water.youngs_modulus = 66e6;
  water.poissons_ratio = 0.495;
  water.yield_stress = 1e5;
  water.hardening_modulus = 0;
  Deck deck;
  deck.materials = {{"material", water}};
  deck.parts = {
      particles("lump", box_of_particles({0.08, 0.07, 0.14}, 0.01), particle(ParticleFrame::eulerian))};
  InitialCondition down = moving("", {0, 0, -150}), up = moving("", {20, 0, 150});
  down.where = {"", BoxRegion{{-1, -1, 0}, {1, 1, 1}}, "lump"};
  up.where = {"", BoxRegion{{-1, -1, -1}, {1, 1, 0}}, "lump"};
  deck.initial_conditions = {down, up};
  deck.time.end = 2.5e-3;
  Model model = build_model(deck);
  const Momentum start = momentum(model.nodes);
  double smallest_step = 1;  // over the first one
  ThreadTeam team(2);
  double energy_error = 0;
  run(model, deck, team, [&](Model& m) {
    if (m.step == 0) return;
    smallest_step = std::min(smallest_step, m.control.stable / m.control.first);
    energy_error = std::max(energy_error, std::abs(m.energy.relative_error()));
  });
  const Momentum end = momentum(model.nodes);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(end.total.linear[i], start.total.linear[i], 1e-12 * start.linear_size);
    EXPECT_NEAR(end.total.angular[i], start.total.angular[i], 1e-12 * start.angular_size);
  }
  EXPECT_LT(energy_error, 1e-2);
  EXPECT_GT(smallest_step, 0.25);
  double reach = 0;
  for (const NodeRecord& record : model.nodes.record)
    reach = std::max(reach, std::hypot(record.position[0], record.position[1]));
  EXPECT_GT(reach, 0.2);
}

// As the rod of hexahedra: its length is 21.5 mm, its foot 7.34 to 7.38 mm in radius, by what holds hourglass
// modes (published: 7.22, 7.12, 7.11).
/// \param length_tolerance, radius_tolerance of the foot: relative
void expect_shape_of_hexahedra(ParticleFrame kernel, double spacing, double length_tolerance,
                               double radius_tolerance) {
  ElasticPlastic copper;
  copper.density = 8930;
  copper.youngs_modulus = 117e9;
  copper.poissons_ratio = 0.35;
  copper.yield_stress = 400e6;
  copper.hardening_modulus = 100e6;
  ParticleMesh rod;
  rod.cylinder = ParticleCylinder{3.2e-3, 32.4e-3, spacing, 0};
  Deck deck;
  deck.materials = {{"material", copper}};
  deck.parts = {particles("bar", rod, particle(kernel))};
  deck.initial_conditions = {moving("bar", {0, 0, -227})};
  RigidWall wall;
  wall.point = {0, 0, 0.5 * spacing};
  wall.normal = {0, 0, 1};
  deck.boundary_conditions = {wall};
  deck.time.end = 80e-6;
  Model model = build_model(deck);
  const auto extent = [&](double& length, double& radius) {
    double lowest = 1, highest = -1;
    radius = 0;
    for (const NodeRecord& record : model.nodes.record) {
      lowest = std::min(lowest, record.position[2]);
      highest = std::max(highest, record.position[2]);
      radius = std::max(radius, std::hypot(record.position[0], record.position[1]));
    }
    length = highest - lowest;
  };
  double start_length = 0, start_radius = 0, length = 0, radius = 0;
  extent(start_length, start_radius);
  ThreadTeam team;
  run(model, deck, team);
  extent(length, radius);
  EXPECT_NEAR(model.energy.kinetic_start, 239.81, 0.01);
  // The free end keeps its half spacing; the rim of the foot stretches with what is inside it.
  EXPECT_NEAR(length + spacing, 21.53e-3, length_tolerance * 21.53e-3);
  EXPECT_NEAR(radius * 3.2e-3 / start_radius, 7.34e-3, radius_tolerance * 7.34e-3);
  EXPECT_LT(model.energy.error_max, 1e-2);
}

TEST(ParticleTaylorBarLong, KernelOfTheStartGivesTheShapeOfHexahedra) {
  expect_shape_of_hexahedra(ParticleFrame::total_lagrangian, 0.4e-3, 0.02, 0.05);
}
// Nothing but viscosity holds what its velocity gradient does not see: the foot is 5.4 % narrower at this
// spacing, and wider by 5.1 % at 0.4 mm, in four times the time (docs/particles.md).
TEST(ParticleTaylorBarLong, KernelOfNowGivesTheShapeOfHexahedra) {
  expect_shape_of_hexahedra(ParticleFrame::eulerian, 0.5e-3, 0.02, 0.06);
}
// Regression, spacing 0.8 mm: with four particles in the radius the foot is narrower by a seventh.
TEST(ParticleTaylorBarSlow, BothKernelsComeNearTheShapeOfHexahedraWithFourInTheRadius) {
  expect_shape_of_hexahedra(ParticleFrame::total_lagrangian, 0.8e-3, 0.03, 0.15);
  expect_shape_of_hexahedra(ParticleFrame::eulerian, 0.8e-3, 0.03, 0.15);
}

}  // namespace
}  // namespace brio
