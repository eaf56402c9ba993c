// Newton's cradle: five equal bars in a row that touch, the first of which comes with a speed. With nu = 0 it
// is a matter of one dimension: the pulse is two bars long, so when its front has come back from the free
// end, its tail enters the last bar, which flies off without stress and with all of the speed. The others
// stand still.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double first_speed = 1;  // wave speed 1000

Deck cradle(int along, const std::vector<int>& across, const Hex8& element, double gap = 0) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  for (std::size_t bar = 0; bar < across.size(); ++bar)
    deck.parts.push_back(box("bar" + std::to_string(bar), {1, 0.1, 0.1}, {along, across[bar], across[bar]},
                             {(1 + gap) * static_cast<double>(bar), 0, 0}, element));
  deck.initial_conditions = {moving("bar0", {first_speed, 0, 0})};
  deck.contact.emplace();
  deck.time.end = 8e-3;  // the last leaves at 5e-3
  return deck;
}

struct CradleRun {
  std::array<double, 5> bar{};  ///< mean speeds at the end
  double parted_at = 0;         ///< last time at which contact pushed
  double momentum = 0;          ///< error, over that of the first bar
  double angular = 0;           ///< the same, over momentum and length of the row
  double added = 0;             ///< most that contact has added, over the energy
  double energy = 0;            ///< largest relative energy error
};

CradleRun swing(const Deck& deck) {
  Model model = build_model(deck);
  ThreadTeam team(1);
  CradleRun outcome;
  run(model, deck, team, [&](Model& m) {
    if (m.contacts[0].step.active > 0) outcome.parted_at = m.times.time;
    const Momentum now = momentum(m.nodes);
    const double first = m.parts[0].mass * first_speed;
    const Vector3d error{now.total.linear[0] - first, now.total.linear[1], now.total.linear[2]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      outcome.momentum = std::max(outcome.momentum, std::abs(error[axis]) / first);
      outcome.angular = std::max(outcome.angular, std::abs(now.total.angular[axis]) / (5 * first));
    }
  });
  for (std::size_t bar = 0; bar < 5; ++bar) outcome.bar[bar] = mean_velocity(model, bar, 0);
  outcome.added = model.energy.contact_added_max / model.energy.kinetic_start;
  outcome.energy = model.energy.error_max;
  return outcome;
}

const std::vector<std::vector<int>> meshes_across{{1, 1, 1, 1, 1}, {2, 3, 2, 3, 2}, {3, 2, 3, 2, 3}};

TEST(NewtonsCradleSlow, LastOfFiveBarsLeavesWithTheSpeedAndTheMoreSoTheFinerTheMesh) {
  for (bool viscous : {true, false})
    for (const std::vector<int>& across : meshes_across) {
      SCOPED_TRACE(testing::Message() << across[0] << ' ' << across[1] << " across, viscous " << viscous);
      double missing = 1;
      for (int along : {10, 20, 40}) {
        const CradleRun outcome = swing(cradle(along, across, viscous ? hex8() : inviscid_hex8()));
        EXPECT_GE(outcome.bar[4], viscous ? 0.94 : 0.95) << along;
        EXPECT_LE(outcome.bar[4], 1) << along;
        EXPECT_LE(1 - outcome.bar[4], 0.95 * missing) << along;
        missing = 1 - outcome.bar[4];
        for (std::size_t bar : {0, 1, 2}) EXPECT_NEAR(outcome.bar[bar], 0, 0.015) << along;
        EXPECT_LE(outcome.momentum, 1e-13);
        EXPECT_LE(outcome.angular, 1e-13);
        EXPECT_LE(outcome.added, 1e-4);
        EXPECT_LE(outcome.energy, 1e-3);
      }
      EXPECT_LE(missing, viscous ? 0.035 : 0.015);
    }
}

// Four impacts one after another, each of which loses what two bars lose.
TEST(NewtonsCradleSlow, PassesTheSpeedOnOverGaps) {
  for (bool viscous : {true, false}) {
    Deck deck = cradle(20, meshes_across[1], viscous ? hex8() : inviscid_hex8(), 0.01);
    deck.time.end = 0.05;
    const CradleRun outcome = swing(deck);
    EXPECT_GE(outcome.bar[4], 0.85);
    EXPECT_LE(outcome.bar[4], 1);
    for (std::size_t bar : {0, 1, 2, 3}) EXPECT_NEAR(outcome.bar[bar], 0, 0.03);
    EXPECT_LE(outcome.momentum, 1e-13);
    EXPECT_LE(outcome.added, 1e-4);
    EXPECT_LE(outcome.energy, 1e-3);
  }
}

}  // namespace
}  // namespace brio
