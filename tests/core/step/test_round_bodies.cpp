// Round bodies with closed solutions: a spinning disc, a ring that breathes.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

Elastic elastic_steel() {
  Elastic law;
  law.density = 7800;
  law.youngs_modulus = 207e9;
  law.poissons_ratio = 0.3;
  return law;
}

// Timoshenko, Goodier: (3 + nu)/8 rho w^2 R^2 at the centre of a thin disc, radially and around. The disc
// starts without stress and breathes about that state: the mean over many periods is the state itself.
TEST(SpinningDisc, MeanStressAtTheCentreIsThatOfTheRotatingDisc) {
  constexpr double radius = 0.1, spin = 1000;
  Deck deck;
  deck.materials = {{"steel", elastic_steel()}};
  RodMesh disc;
  disc.radius = radius;
  disc.length = 0.01;
  disc.elements = {16, 1};
  disc.keep_volume = true;
  deck.parts = {{"disc", disc, {}, hex8(), "steel"}};
  InitialCondition turning;
  turning.where.set = "disc";
  turning.spin = Spin{{0, 0, 0}, {0, 0, spin}};
  deck.initial_conditions = {turning};
  deck.time.end = 3e-3;  // about 50 periods
  Model model = build_model(deck);
  std::vector<std::size_t> central;
  const Block& block = model.blocks[0];
  for (std::size_t e = 0; e < block.element_count; ++e) {
    double x = 0, y = 0;
    for (int k = 0; k < 8; ++k) {
      x += model.nodes.record[index(block.node(e, k))].position[0] / 8;
      y += model.nodes.record[index(block.node(e, k))].position[1] / 8;
    }
    if (std::hypot(x, y) < 0.1 * radius) central.push_back(e);
  }
  ASSERT_EQ(central.size(), 4u);
  ThreadTeam team(1);
  double sum = 0, duration = 0;
  run(model, deck, team, [&](Model& m) {
    for (std::size_t e : central) {
      const auto stress = block.kernel.sample(block, m.nodes, e, true).stress;
      sum += m.times.next * 0.125 * (stress.xx + stress.yy);
    }
    duration += m.times.next;
  });
  const double exact = (3 + 0.3) / 8 * 7800 * spin * spin * radius * radius;
  EXPECT_NEAR(exact, 32.175e6, 1);
  EXPECT_NEAR(sum / duration, exact, 0.02 * exact);
}

// A short thin ring that expands and contracts at sqrt(E/rho)/R.
TEST(Ring, BreathesAtTheSpeedOfARodOverItsRadius) {
  constexpr double radius = 0.1;
  Deck deck;
  deck.materials = {{"steel", elastic_steel()}};
  Shell4 shell;
  shell.thickness = 0.001;
  deck.parts = {{"ring", CylinderMesh{radius, 0.008, {64, 1}}, {}, shell, "steel"}};
  const double frequency = std::sqrt(207e9 / 7800) / radius;
  deck.numerics.energy_error_limit = 1e9;  // the motion is set after the balance was started
  constexpr int half_periods = 20;
  deck.time.end = (half_periods + 0.9) * 3.141592653589793 / frequency;
  Model model = build_model(deck);
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    for (std::size_t axis = 0; axis < 2; ++axis)
      model.nodes.record[i].velocity[axis] = model.nodes.record[i].position[axis] / radius;  // 1 m/s outward
  ThreadTeam team(1);
  std::vector<double> turned;  // times at which the radial velocity changes sign
  double before = 1, time_before = 0;
  run(model, deck, team, [&](Model& m) {
    double radial = 0;
    for (std::size_t i = 0; i < m.nodes.size(); ++i) {
      const NodeRecord& node = m.nodes.record[i];
      radial += (node.position[0] * node.velocity[0] + node.position[1] * node.velocity[1]) / radius;
    }
    const double time = m.times.time + 0.5 * m.times.next;
    if (radial * before < 0)
      turned.push_back(time_before + (time - time_before) * before / (before - radial));
    before = radial;
    time_before = time;
  });
  ASSERT_EQ(turned.size(), index(half_periods + 1));
  const double measured = half_periods * 3.141592653589793 / (turned.back() - turned.front());
  EXPECT_NEAR(measured, frequency, 0.01 * frequency);
}

}  // namespace
}  // namespace brio
