// What a change of frame, of units or of place must leave alone.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

/// Units as multiples of those of the scene below.
struct Units {
  double length = 1, time = 1, mass = 1;
};

// Two bars of different meshes that collide askew with friction, seen from a frame, at a place, in units.
Deck collision(const Units& units = {}, const Vector3d& frame = {}, const Vector3d& place = {}) {
  const double speed = units.length / units.time;
  Elastic law = elastic(0.3);
  law.density *= units.mass / (units.length * units.length * units.length);
  law.youngs_modulus *= units.mass / (units.length * units.time * units.time);
  const auto scaled = [](const Vector3d& v, double factor, const Vector3d& shift) {
    return Vector3d{v[0] * factor + shift[0], v[1] * factor + shift[1], v[2] * factor + shift[2]};
  };
  Deck deck;
  deck.materials = {{"material", law}};
  deck.parts = {box("left", scaled({0.5, 0.125, 0.125}, units.length, {}), {10, 3, 3},
                    scaled({-0.251, 0, 0}, units.length, place), hex8()),
                box("right", scaled({0.5, 0.125, 0.125}, units.length, {}), {10, 2, 2},
                    scaled({0.251, 0.01, 0.003}, units.length, place), hex8())};
  deck.initial_conditions = {moving("left", scaled({10, 0, 0}, speed, frame)),
                             moving("right", scaled({-10, -3, 1}, speed, frame))};
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 1.5e-3 * units.time;
  return deck;
}

struct Watched {
  Model model;
  std::vector<int> contacts;  ///< at every step
  std::vector<int> active;
  explicit Watched(const Deck& deck) : model(build_model(deck)) {
    ThreadTeam team(1);
    test::run(model, deck, team, [&](Model& m) {
      contacts.push_back(m.contacts[0].step.contacts);
      active.push_back(m.contacts[0].step.active);
    });
  }
};

// Largest difference of velocities relative to the frame, and of positions less the motion of the frame.
struct Difference {
  double velocity = 0, position = 0;
};
Difference difference(const Model& a, const Model& b, const Vector3d& frame, const Vector3d& place) {
  Difference result;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const NodeRecord& p = a.nodes.record[i];
      const NodeRecord& q = b.nodes.record[i];
      const double moved = q.position[axis] - frame[axis] * b.times.time - place[axis];
      result.velocity =
          std::max(result.velocity, std::abs(p.velocity[axis] - (q.velocity[axis] - frame[axis])));
      result.position = std::max(result.position, std::abs(p.position[axis] - moved));
    }
  return result;
}

TEST(Invariance, PowersOfTwoInLengthTimeAndMassGiveTheSameBits) {
  const Watched reference(collision());
  EXPECT_LT(reference.model.energy.friction.at_step(), 0);
  for (const Units& units : {Units{1024, 1, 1}, Units{1, 0.0078125, 1}, Units{1, 1, 4096},
                             Units{0.0009765625, 0.125, 0.00048828125}}) {
    SCOPED_TRACE(testing::Message() << units.length << ' ' << units.time << ' ' << units.mass);
    const Watched other(collision(units));
    ASSERT_EQ(reference.model.step, other.model.step);
    EXPECT_EQ(reference.contacts, other.contacts);
    const double speed = units.length / units.time;
    const double energy = units.mass * speed * speed;
    for (std::size_t i = 0; i < reference.model.nodes.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const NodeRecord& a = reference.model.nodes.record[i];
        const NodeRecord& b = other.model.nodes.record[i];
        ASSERT_EQ(a.position[axis] * units.length, b.position[axis]) << i;
        ASSERT_EQ(a.velocity[axis] * speed, b.velocity[axis]) << i;
      }
    EXPECT_EQ(reference.model.energy.internal * energy, other.model.energy.internal);
    EXPECT_EQ(reference.model.energy.friction.half * energy, other.model.energy.friction.half);
  }
}

// Elastic bodies that slide with Coulomb friction are unstable (Adams 1995): rounding grows by 3.5 in 0.05 ms
// while they do, so that with friction the end comes early.
TEST(Invariance, FrameAtAThousandTimesTheSpeedOfTheImpactSeesTheSameContacts) {
  const Vector3d frame{10000, -8000, 6000};
  for (const bool has_friction : {false, true}) {
    Deck at_rest = collision(), moving_on = collision({}, frame);
    for (Deck* deck : {&at_rest, &moving_on}) {
      if (has_friction) {
        deck->time.end = 2.5e-4;
      } else {
        deck->contact->options.friction = 0;
      }
    }
    const Watched reference(at_rest);
    const Watched other(moving_on);
    EXPECT_EQ(reference.contacts, other.contacts);
    EXPECT_EQ(reference.active, other.active);
    const Difference found = difference(reference.model, other.model, frame, {});
    // Positions are some 1e5 edges away by then: their rounding tilts closest points a gap apart.
    EXPECT_LE(found.velocity, 1e-6 * 10);
    EXPECT_LE(found.position, 1e-8);
  }
}

// Positions have an ulp of 1e-10 there, and an element an edge of 0.05.
TEST(Invariance, PlaceAMillionSizesAwaySeesTheSameImpact) {
  const Vector3d place{1048576, -524288, 786432};
  Deck here = collision(), there = collision({}, {}, place);
  for (Deck* deck : {&here, &there}) {
    // How many iterations there are depends on rounding: by less than that they may differ.
    deck->contact->options.tolerance = 1e-10;
    deck->contact->options.passes = 500;
  }
  const Watched reference(here), other(there);
  const Difference found = difference(reference.model, other.model, {}, place);
  EXPECT_LE(found.velocity, 1e-3 * 10);
  EXPECT_LE(found.position, 1e-6);
  EXPECT_NEAR(mean_velocity(reference.model, 0, 0), mean_velocity(other.model, 0, 0), 1e-5 * 10);
}

// Rounding alone stirs the hourglass modes: forces that lag behind the turning would make them grow.
struct TurningCube {
  Deck deck;
  double spin;
  TurningCube(double spin_, double turns, ObjectiveRate rate) : spin(spin_) {
    Hex8 element = hex8();
    element.objective_rate = rate;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {box("cube", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, element)};
    InitialCondition turning;
    turning.where.set = "cube";
    turning.spin = Spin{{0, 0, 0}, {0.6 * spin, 0, 0.8 * spin}};
    deck.initial_conditions = {turning};
    deck.time.end = turns * 6.283185307179586 / spin;
  }
};

TEST(Invariance, TwoHundredTurnsOfAFreeCubeKeepEnergyAndAngularMomentum) {
  for (const ObjectiveRate rate : {ObjectiveRate::green_naghdi, ObjectiveRate::jaumann}) {
    const TurningCube cube(30, 200, rate);
    Model model = build_model(cube.deck);
    ThreadTeam team(1);
    const Vector3d start = momentum(model.nodes).total.angular;
    run(model, cube.deck, team);
    const Vector3d end = momentum(model.nodes).total.angular;
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(end[axis], start[axis], 1e-9 * std::sqrt(dot(start, start)));
    EXPECT_LE(model.energy.error_max, 5e-4);
    EXPECT_LE(std::abs(model.energy.hourglass), 1e-12 * model.energy.kinetic_start);
  }
}

// A cube that turns and vibrates in every uniform strain at about 1/s and in every hourglass mode, 170 times
// a turn; 1 % of the energy vibrates. A step in time with the vibrations would feed them, hourglass forces
// that lag behind the turning as well.
void expect_no_gain_of_energy(ObjectiveRate rate, double turns, double step_scale, double largest_error) {
  TurningCube cube(10, turns, rate);
  cube.deck.time.step_scale = step_scale;
  cube.deck.numerics.energy_error_limit = 1e9;  // the motion is set after the balance was started
  Model model = build_model(cube.deck);
  const double gradient[3][3] = {{1, 0.3, -0.2}, {0.3, -0.6, 0.4}, {-0.2, 0.4, 0.2}};
  for (NodeRecord& node : model.nodes.record) {
    const double* x = node.position;
    for (std::size_t i = 0; i < 3; ++i)
      node.velocity[i] += gradient[i][0] * x[0] + gradient[i][1] * x[1] + gradient[i][2] * x[2] +
                          0.4 * (x[0] * x[1] - x[1] * x[2] + 2 * x[0] * x[1] * x[2]);
  }
  ThreadTeam team(1);
  double start = 0, largest = 0, worst_error = 0;
  run(model, cube.deck, team, [&](Model& m) {
    const EnergyBalance& energy = m.energy;
    if (m.step == 0) start = energy.kinetic;
    largest = std::max(largest, energy.kinetic);
    const double sum = energy.kinetic + energy.internal + energy.hourglass + energy.viscous;
    worst_error = std::max(worst_error, std::abs(sum - start));
  });
  EXPECT_LE(largest, 1.001 * start);
  EXPECT_LE(worst_error, largest_error * start);
}

TEST(Invariance, TurningAndVibratingCubeGainsNoEnergy) {
  for (const ObjectiveRate rate : {ObjectiveRate::green_naghdi, ObjectiveRate::jaumann})
    expect_no_gain_of_energy(rate, 300, 0.9, 3e-3);
}

// At half of the default step, which has seven to a vibration, the energy grows by about 1 % in 10,000 turns,
// 1.7 million vibrations. The cause is not shown: hourglass stiffness is that of the end of a step, half a
// step late.
TEST(InvarianceSlow, TurningAndVibratingCubeGainsNoEnergyInThousandsOfTurns) {
  expect_no_gain_of_energy(ObjectiveRate::green_naghdi, 1000, 0.9, 3e-3);
  expect_no_gain_of_energy(ObjectiveRate::green_naghdi, 2500, 0.45, 3e-3);
}

}  // namespace
}  // namespace brio
