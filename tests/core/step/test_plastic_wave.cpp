// A wave of uniaxial strain in an elastic-plastic metal: an elastic precursor runs ahead of the plastic
// front.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double youngs = 200e9, poisson = 0.3, density = 7800, yield = 400e6, piston = 50;
constexpr int row_elements = 800;  // elements along the row of length 1

// A row of hexahedra without lateral motion; its left end moves at the speed of the piston.
Deck row() {
  ElasticPlastic law;
  law.density = density;
  law.youngs_modulus = youngs;
  law.poissons_ratio = poisson;
  law.yield_stress = yield;
  Deck deck;
  deck.materials = {{"metal", law}};
  const double h = 1.0 / row_elements;
  deck.parts = {box("row", {1, h, h}, {row_elements, 1, 1}, {0.5, 0, 0}, hex8(), "metal")};
  PrescribedMotion push;
  push.where.set = "row.xmin";
  push.components = {{0, Curve{{{0, piston}}}}};
  deck.boundary_conditions = {fix("row", {1, 2}), push};
  deck.time.end = 0.8 / 5900;
  return deck;
}

// Where, in the row at rest, the stress along it falls below a level, from the front end towards the piston.
double front_at(const std::vector<double>& stress, double level) {
  for (std::size_t e = stress.size(); e-- > 1;)
    if (stress[e - 1] >= level) {
      const double share = (stress[e - 1] - level) / (stress[e - 1] - stress[e]);
      return (static_cast<double>(e) - 0.5 + share) / row_elements;
    }
  return 0;
}

// Rankine, Hugoniot, and Wood (J. Appl. Mech. 19, 1952): the elastic front carries (1-nu)/(1-2nu) times the
// yield stress at sqrt((lambda + 2 mu)/rho), the plastic one the rest of the particle velocity at
// sqrt(K/rho).
TEST(ElasticPlasticWave, PrecursorStressAndBothSpeedsAreThoseOfUniaxialStrain) {
  const double bulk = youngs / (3 * (1 - 2 * poisson));
  const double longitudinal = bulk + 4.0 / 3.0 * youngs / (2 * (1 + poisson));
  const double elastic_speed = std::sqrt(longitudinal / density);
  const double plastic_speed = std::sqrt(bulk / density);
  const double precursor = yield * (1 - poisson) / (1 - 2 * poisson);
  const double behind =
      precursor + density * plastic_speed * (piston - precursor / (density * elastic_speed));

  const Deck deck = row();
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  std::vector<double> stress(row_elements);
  for (std::size_t e = 0; e < stress.size(); ++e) {
    const auto slot = index(model.parts[0].element_slot[e]);
    stress[e] = -model.blocks[0].kernel.sample(model.blocks[0], model.nodes, slot, true).stress.xx;
  }
  const double time = deck.time.end;
  const double elastic_front = front_at(stress, 0.5 * precursor);
  const double plastic_front = front_at(stress, 0.5 * (precursor + behind));
  const double middle = 0.5 * (elastic_front + plastic_front);
  const double plateau = stress[static_cast<std::size_t>(middle * row_elements)];
  EXPECT_NEAR(elastic_front, elastic_speed * time, 0.02 * elastic_speed * time);
  EXPECT_NEAR(plastic_front, plastic_speed * time, 0.02 * plastic_speed * time);
  EXPECT_NEAR(plateau, precursor, 0.02 * precursor);
  EXPECT_NEAR(stress[static_cast<std::size_t>(0.5 * plastic_front * row_elements)], behind, 0.02 * behind);
}

}  // namespace
}  // namespace brio
