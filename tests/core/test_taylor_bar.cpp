// Copper rod on a rigid wall at 227 m/s: the shape that it is left with, against published results.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

struct Shape {
  double length = 0, radius = 0, start_energy = 0, energy_error = 0, hourglass_share = 0;
};

Shape taylor_bar(const Element& element) {
  ElasticPlastic copper;
  copper.density = 8930;
  copper.youngs_modulus = 117e9;
  copper.poissons_ratio = 0.35;
  copper.yield_stress = 400e6;
  copper.hardening_modulus = 100e6;
  RodMesh rod;
  rod.radius = 3.2e-3;
  rod.length = 32.4e-3;
  rod.elements = {12, 60};
  rod.keep_volume = true;
  Deck deck;
  deck.materials = {{"copper", copper}};
  Part part;
  part.name = "bar";
  part.mesh = rod;
  part.element = element;
  part.material = "copper";
  deck.parts = {part};
  deck.initial_conditions = {moving("bar", {0, 0, -227})};
  RigidWall wall;
  wall.normal = {0, 0, 1};
  deck.boundary_conditions = {wall};
  deck.time.end = 80e-6;
  Model model = build_model(deck);
  ThreadTeam team(2);
  run(model, deck, team);
  Shape shape;
  double lowest = 1, highest = -1;
  for (const NodeRecord& record : model.nodes.record) {
    lowest = std::min(lowest, record.position[2]);
    highest = std::max(highest, record.position[2]);
    shape.radius = std::max(shape.radius, std::hypot(record.position[0], record.position[1]));
  }
  shape.length = highest - lowest;
  shape.start_energy = model.energy.kinetic_start;
  shape.energy_error = model.energy.error_max;
  shape.hourglass_share = model.energy.hourglass / model.energy.internal;
  return shape;
}

// Radius 7.22 mm is the converged one-point brick of the literature; lengths are 21.4 to 21.5 mm.
TEST(TaylorBarSlow, OnePointBrickGivesThePublishedShape) {
  const Shape shape = taylor_bar(Hex8{});
  EXPECT_NEAR(shape.start_energy, 239.81, 0.01);
  EXPECT_NEAR(shape.radius, 7.22e-3, 0.02 * 7.22e-3);
  EXPECT_NEAR(shape.length, 21.45e-3, 0.01 * 21.45e-3);
  EXPECT_LT(shape.energy_error, 1e-3);
  EXPECT_LT(shape.hourglass_share, 0.05);
}

TEST(TaylorBarSlow, FullyIntegratedBrickAgrees) {
  const Shape shape = taylor_bar(Hex8Full{});
  EXPECT_NEAR(shape.radius, 7.22e-3, 0.02 * 7.22e-3);
  EXPECT_NEAR(shape.length, 21.45e-3, 0.01 * 21.45e-3);
}

}  // namespace
}  // namespace brio
