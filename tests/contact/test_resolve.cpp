#include <gtest/gtest.h>

#include <random>

#include "contact/audit/audit.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"
#include "tests/rotation_about.hpp"

namespace brio::test {
namespace {

Map turned_and_shifted(double angle, const Vector3d& axis, const Vector3d& by) {
  const Tensor<double> turn = rotation_about(angle, axis);
  return [turn, by](const Vector3d& x) -> Vector3d { return turn * x + by; };
}

// Blocks and sheets thrown at each other, each turned at random.
void throw_things(SpringModel& model, unsigned seed, const ContactOptions& options, const Vector3d& offset,
                  const Vector3d& common_velocity) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vector3d{uniform(random), uniform(random), uniform(random)}; };
  int things = 0;
  for (const double x : {0.0, 3.0})
    for (const double y : {0.0, 3.0})
      for (const double z : {0.0, 3.0}) {
        const Vector3d centre = Vector3d{x, y, z} + 0.2 * vector();
        const Map map = turned_and_shifted(3 * uniform(random), vector(), centre + offset);
        const int first = ++things % 3 == 0 ? model.add_sheet({4, 4}, {1.5, 1.5}, 0.1, 10, map)
                                            : model.add_box({2, 2, 2}, {1, 1, 1}, 1, map);
        model.throw_from(first, 2.0 * (Vector3d{1.5, 1.5, 1.5} - centre) + common_velocity);
      }
  model.stiffness = 200;
  model.start(options);
}

// Constraints in the direction of a meeting are asked for as seen by who turns with what meets.
TEST(Momentum, IsKeptToRoundingInRandomScenes) {
  for (const unsigned seed : {1U, 2U, 3U})
    for (const double friction : {0.0, 0.3}) {
      SpringModel model;
      ContactOptions options;
      options.friction = friction;
      throw_things(model, seed, options, Vector3d{}, {0.3, 0, 0});
      const Vector3d linear = model.momentum(), angular = model.angular_momentum();
      double size = 0;
      for (int n = 0; n < model.count(); ++n) size += model.mass(n) * norm(model.v(n));
      const double energy = model.kinetic_energy();
      std::uint64_t active = 0;
      for (int i = 0; i < 800; ++i) {
        model.step(1e-3);
        active += static_cast<std::uint64_t>(model.scene.step.active);
      }
      EXPECT_GT(active, 1000U);
      EXPECT_GT(model.scene.steps_with_hits, 0U);
      EXPECT_LT(norm(model.momentum() - linear), 1e-12 * size);
      EXPECT_LT(norm(model.angular_momentum() - angular), 1e-12 * size * 5) << seed;
      EXPECT_LE(model.scene.totals.largest_normal_work, 1e-3 * energy);
    }
}

TEST(Momentum, IsKeptWithFriction) {
  SpringModel model;
  ContactOptions options;
  options.friction = 0.4;
  throw_things(model, 7, options, Vector3d{}, Vector3d{});
  const Vector3d linear = model.momentum();
  const double energy = model.kinetic_energy();
  for (int i = 0; i < 800; ++i) model.step(1e-3);
  EXPECT_LT(norm(model.momentum() - linear), 1e-12 * std::sqrt(energy));
  EXPECT_LT(model.scene.totals.friction_work, 0);
}

TEST(Resolve, HasTheSameBitsForAnyNumberOfThreads) {
  std::vector<double> reference;
  for (const int threads : {1, 2, 4}) {
    ThreadTeam team(threads);
    SpringModel model;
    ContactOptions options;
    options.friction = 0.3;
    throw_things(model, 5, options, Vector3d{}, Vector3d{});
    for (int i = 0; i < 500; ++i) model.step(1e-3, team);
    std::vector<double> state;
    for (int n = 0; n < model.count(); ++n)
      for (int axis = 0; axis < 3; ++axis) {
        state.push_back(model.x(n)[axis]);
        state.push_back(model.v(n)[axis]);
      }
    state.push_back(model.scene.totals.normal_work);
    if (threads == 1) reference = state;
    for (std::size_t i = 0; i < state.size(); ++i)
      ASSERT_EQ(state[i], reference[i]) << threads << " entry " << i;
  }
}

TEST(Resolve, DoesNotDependOnTheFrame) {
  // Positions a million away and a common velocity a thousand times that of the event: what differs is
  // rounding, so the scene is followed only until its motion is no longer that of the first impacts.
  const auto run = [](const Vector3d& offset, const Vector3d& velocity, double dt, int steps) -> Vector3d {
    SpringModel model;
    model.add_box({3, 3, 3}, {3, 3, 3}, 1, shifted(offset));
    const int upper = model.add_box({2, 2, 2}, {2, 2, 2}, 1, shifted(offset + Vector3d{0.3, 0.4, 3.01}));
    model.throw_from(0, velocity);
    model.throw_from(upper, velocity + Vector3d{0, 0, -1});
    model.stiffness = 200;
    model.start({});
    for (int i = 0; i < steps; ++i) model.step(dt);
    return model.mean_velocity(upper, model.count()) - velocity;
  };
  const Vector3d reference = run(Vector3d{}, Vector3d{}, 0x1p-10, 300);
  EXPECT_GT(reference[2], -0.7);
  // Positions are rounded to 2^-32, which a step of 2^-10 turns into a velocity 300 times.
  EXPECT_LT(norm(run({0x1p20, -0x1p20, 0x1p20}, Vector3d{}, 0x1p-10, 300) - reference), 300 * 0x1p-22);
  EXPECT_LT(norm(run(Vector3d{}, {1024, -1024, 512}, 0x1p-10, 300) - reference), 1e-6);
}

TEST(Friction, NeverLeavesTheCone) {
  SpringModel model;
  ContactOptions options;
  options.friction = 0.25;
  throw_things(model, 11, options, Vector3d{}, Vector3d{});
  int sliding = 0;
  int sticking = 0;
  for (int i = 0; i < 600; ++i) {
    model.step(1e-3);
    for (const Contact& contact : model.scene.contacts) {
      ASSERT_LE(norm(contact.friction), 0.25 * contact.impulse * (1 + 1e-12));
      ASSERT_LE(std::abs(dot(contact.friction, contact.normal)), 1e-12 * contact.impulse);
      if (contact.impulse == 0) continue;
      (norm(contact.friction) > 0.2499 * contact.impulse ? sliding : sticking) += 1;
    }
  }
  EXPECT_GT(sliding, 100);
  EXPECT_GT(sticking, 10);
}

// A block sliding over a fixed floor under gravity.
struct Slide {
  SpringModel model;
  int block = 0;

  Slide(double friction, double speed) {
    model.add_box({12, 4, 1}, {24, 4, 1}, 1, shifted({-2, -1, -1}));
    block = model.add_box({2, 2, 2}, {1, 1, 1}, 1, shifted({0.13, 0.37, 0}));
    model.throw_from(block, {speed, 0, 0});
    model.stiffness = 3000;
    model.gravity = {0, 0, -10};
    ContactOptions options;
    options.friction = friction;
    model.start(options);
    model.hold(0, block);
    model.make_gap();
  }
  double travelled() const { return model.centre(block, model.count())[0] - 0.63; }
  Vector3d speed() const { return model.mean_velocity(block, model.count()); }
};

TEST(FrictionSlow, BlockStopsWhereCoulombSays) {
  Slide slide(0.3, 6);
  slide.model.damping = 0;
  for (int i = 0; i < 24000; ++i) slide.model.step(1e-4);
  EXPECT_NEAR(slide.travelled(), 6.0 * 6.0 / (2 * 0.3 * 10), 0.01 * 6);
  const double there = slide.travelled();
  for (int i = 0; i < 10000; ++i) slide.model.step(1e-4);
  EXPECT_NEAR(slide.travelled(), there, 1e-3);
}

TEST(FrictionSlow, FrictionlessBlockKeepsItsSpeedOverSeams) {
  Slide slide(0, 6);
  for (int i = 0; i < 24000; ++i) slide.model.step(1e-4);
  EXPECT_GT(slide.travelled(), 14);
  EXPECT_NEAR(slide.speed()[0], 6, 1e-3 * 6);
  EXPECT_NEAR(slide.speed()[1], 0, 1e-3 * 6);
}

TEST(FrictionSlow, DampedStackRestsWithoutDrift) {
  SpringModel model;
  model.add_box({2, 2, 1}, {3, 3, 1}, 1, shifted({-1, -1, -1}));
  const int floor_end = model.count();
  for (int i = 0; i < 4; ++i)
    model.add_box({2, 2, 2}, {1, 1, 1}, 1, shifted({0.03 * i, 0.02 * (i % 2), 1.0 * i}));
  model.stiffness = 2000;
  model.gravity = {0, 0, -1};
  model.damping = 5;
  ContactOptions options;
  options.friction = 0.3;
  model.start(options);
  model.hold(0, floor_end);
  model.make_gap();
  for (int i = 0; i < 3000; ++i) model.step(1e-3);
  const Vector3d settled = model.centre(floor_end, model.count());
  for (int i = 0; i < 5000; ++i) model.step(1e-3);
  const double potential = 1 * (0.5 + 1.5 + 2.5 + 3.5);
  EXPECT_LT(norm(model.centre(floor_end, model.count()) - settled), 1e-5);
  EXPECT_LT(model.kinetic_energy(), 5e-7 * potential);
  EXPECT_LT(model.scene.step.deepest_overlap, 1e-4);
}

TEST(FastCrossing, IsStoppedThroughManyFacesAStep) {
  // In one step the small sheet would move over seven faces of the plate and far through it.
  for (const bool thin : {false, true}) {
    SpringModel model;
    if (thin) {
      model.add_sheet({20, 20}, {20, 20}, 0.1, 1, shifted({-10, -10, -0.1}));
    } else {
      model.add_box({20, 20, 1}, {20, 20, 0.1}, 1, shifted({-10, -10, -0.15}));
    }
    const int plate_end = model.count();
    model.add_sheet({1, 1}, {0.5, 0.5}, 0.1, 1, turned_and_shifted(0.2, {1, 2, 0}, {-6.2, -5.3, 2}));
    model.throw_from(plate_end, {7000, 6000, -5000});
    model.stiffness = 0;
    model.start({});
    model.hold(0, plate_end);
    for (int i = 0; i < 2; ++i) {
      model.step(1e-3);
      for (int n = plate_end; n < model.count(); ++n) {
        if (std::abs(model.x(n)[0]) > 10 || std::abs(model.x(n)[1]) > 10) continue;
        EXPECT_GT(model.x(n)[2], -0.1 * 0.1) << thin << " node " << n - plate_end << " step " << i;
      }
    }
  }
}

TEST(ShellSides, NodesEndWhereTheyCameFrom) {
  for (const double side : {1.0, -1.0}) {
    SpringModel model;
    model.add_sheet({4, 4}, {4, 4}, 0.2, 1, shifted({0, 0, 0}));
    const int sheet_end = model.count();
    model.add_sheet({3, 3}, {2, 2}, 0.2, 1, shifted({0.9, 1.1, side * 0.25}));
    model.throw_from(sheet_end, {0, 0, -side * 50});
    model.stiffness = 5000;
    model.start({});
    ThreadTeam team(1);
    for (int i = 0; i < 400; ++i) {
      model.step(1e-3);
      ASSERT_EQ(audit(model.scene, model.nodes, team).missed(), 0) << side << " step " << i;
    }
    EXPECT_GT(side * (model.centre(sheet_end, model.count())[2] - model.centre(0, sheet_end)[2]), 0.2);
  }
}

TEST(Seams, AHitOnASeamIsOneContact) {
  const int floor_end = 18;
  // Its lowest corner stands a gap above a node of the floor, then above a seam.
  for (const double x : {1.0, 0.5}) {
    SpringModel single;
    single.add_box({2, 2, 1}, {2, 2, 1}, 1, shifted({0, 0, -1}));
    single.add_box({1, 1, 1}, {0.5, 0.5, 0.5}, 1,
                   turned_and_shifted(0.8, {1, -0.7, 0.2}, Vector3d{x, 1, 0.0}));
    single.throw_from(floor_end, {0, 0, -1});
    single.stiffness = 0;
    single.start({});
    single.hold(0, floor_end);
    double lowest = 10;
    for (int n = floor_end; n < single.count(); ++n) lowest = std::min(lowest, single.x(n)[2]);
    for (int n = floor_end; n < single.count(); ++n)
      single.nodes.record[index(n)].position[2] -= lowest - 2 * single.scene.features.skin;
    single.step(1e-3);
    int of_corner = 0;
    for (const Contact& contact : single.scene.contacts)
      of_corner += contact.slave >= single.scene.surface.slave(floor_end);
    EXPECT_EQ(of_corner, 1) << x;
  }
}

}  // namespace
}  // namespace brio::test
