// A free beam that turns a million times about an axis across it: what little drifts.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

/// Means over a number of turns.
struct Means {
  double energy = 0;  ///< of motion, strain and viscosity, over that at the start
  double length = 0;
  double spin = 0;      ///< of the node's own axes, over that at the start
  double momentum = 0;  ///< angular, along the axis, over that at the start
  double across = 0;    ///< largest of the other components, over the same
};

class SpinningBeam {
 public:
  /// About `steps_a_turn` where the beam would not stretch.
  SpinningBeam(double steps_a_turn, double viscosity) {
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    Beam2 beam;
    beam.section = CircleSection{.radius = 0.05};
    beam.linear_bulk_viscosity = viscosity;
    deck.parts = {{"beam", LineMesh{{-0.5, 0, 0}, {0.5, 0, 0}, 1}, {}, beam, "material"}};
    deck.time.end = 1e12;
    Model still = build_model(deck);
    update_velocities(still, 1, team_);
    spin_ = 2 * std::numbers::pi / (steps_a_turn * still.times.next);
    InitialCondition turning;
    turning.where.set = "beam";
    turning.spin = Spin{{0, 0, 0}, {0, 0, spin_}};
    deck.initial_conditions = {turning};
    model_ = build_model(deck);
    start_ = momentum(model_.nodes).total.angular[2];
  }

  Means over(double turns) {
    Means means;
    double samples = 0;
    const double end = turned_ + turns;
    run(model_, 1e9, team_, [&](Model&) {
      const NodeRecord* end_of = model_.nodes.record.data();
      double along[3];
      for (int i = 0; i < 3; ++i) along[i] = end_of[1].position[i] - end_of[0].position[i];
      turned_ += std::remainder(std::atan2(along[1], along[0]) - angle_, 2 * std::numbers::pi) /
                 (2 * std::numbers::pi);
      angle_ = std::atan2(along[1], along[0]);
      means.energy += model_.energy.sum() / model_.energy.kinetic_start;
      means.length += std::hypot(along[0], along[1], along[2]);
      means.spin += model_.nodes.angular_velocity[0].component[2] / spin_;
      ++samples;
      return turned_ < end;
    });
    means.energy /= samples;
    means.length /= samples;
    means.spin /= samples;
    const Vector3d now = momentum(model_.nodes).total.angular;
    means.momentum = now[2] / start_;
    means.across = std::max(std::abs(now[0]), std::abs(now[1])) / start_;
    return means;
  }
  std::int64_t steps() const { return model_.step; }

 private:
  ThreadTeam team_{1};
  Model model_;
  double spin_ = 0, start_ = 0, turned_ = 0, angle_ = 0;
};

void expect_no_drift(const Means& first, const Means& last) {
  constexpr double tolerance = 1e-6;  // of means over vibrations that are cut off at both ends
  std::printf("drift of energy %.0e, length %.0e, spin %.0e, angular momentum %.0e, across %.0e\n",
              last.energy - first.energy, last.length - first.length, last.spin - first.spin,
              last.momentum - 1, last.across);
  EXPECT_NEAR(last.energy, first.energy, tolerance);
  EXPECT_NEAR(last.length, first.length, tolerance);
  EXPECT_NEAR(last.spin, first.spin, tolerance);
  EXPECT_NEAR(last.momentum, 1, 1e-11);
  EXPECT_LT(last.across, 1e-12);
}

// Steps of a twentieth of a turn: the beam is stretched by 7 %, and without viscosity goes on vibrating.
TEST(ExtremesTurnsSlow, KeepsItsEnergyLengthAndMomentumForTwoHundredThousandTurns) {
  SpinningBeam beam(16, 0);
  beam.over(1e3);
  const Means first = beam.over(5e4);
  beam.over(2e5 - 1.01e5);
  const Means last = beam.over(5e4);
  EXPECT_LT(static_cast<double>(beam.steps()), 4e6);
  expect_no_drift(first, last);
}

TEST(SpinningBeam, KeepsItsEnergyLengthAndMomentumForTenThousandTurns) {
  SpinningBeam beam(16, 0.06);
  beam.over(1e3);
  const Means first = beam.over(1e3);
  beam.over(7e3);
  const Means last = beam.over(1e3);
  expect_no_drift(first, last);
}

}  // namespace
}  // namespace brio
