// Sliding: Coulomb's law stops a block where it must, and seams between facets do not hold one without
// friction.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "contact/audit/audit.hpp"
#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double gravity_acceleration = 100;  // acceleration of gravity

Gravity gravity(double acceleration) {
  Gravity result;
  result.acceleration = {0, 0, -acceleration};
  return result;
}

// A block on z = 0 that moves along x; what it lies on is added by the caller.
Deck sliding_block(const Vector3d& velocity) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 1, 0.5}, {4, 4, 2}, {0, 0, 0.25}, hex8())};
  deck.initial_conditions = {moving("block", velocity)};
  deck.loads = {gravity(gravity_acceleration)};
  return deck;
}

Deck on_floor(Deck deck, double friction) {
  deck.parts.push_back(box("floor", {3, 2, 0.25}, {11, 7, 1}, {0.5, 0, -0.125}, hex8()));
  deck.boundary_conditions = {fix("floor.zmin", {0, 1, 2})};
  deck.contact.emplace();
  deck.contact->options.friction = friction;
  return deck;
}

Deck on_wall(Deck deck, double friction) {
  RigidWall floor;
  floor.normal = {0, 0, 1};
  floor.friction = friction;
  deck.boundary_conditions = {floor};
  return deck;
}

Vector3d centre_of(const Model& model, std::size_t part) {
  Vector3d sum{};
  for (int entry : model.parts[part].node) {
    const auto node = index(entry);
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += model.nodes.mass[node] * model.nodes.record[node].position[axis] / model.parts[part].mass;
  }
  return sum;
}

struct Slide {
  double distance = 0;  ///< along the initial velocity
  double aside = 0;     ///< across it
  double drift = 0;     ///< of the mean place, from 1.8..2.4 times the time to stop to 2.4..3 times
};

// Slides until well after the block stands.
Slide slide(Deck deck, const Vector3d& velocity, double friction) {
  const double speed = std::hypot(velocity[0], velocity[1]);
  const double stop = speed / (friction * gravity_acceleration);
  deck.time.end = 3 * stop;
  Model model = build_model(deck);
  ThreadTeam team(1);
  const Vector3d start = centre_of(model, 0);
  std::array<Vector3d, 2> rest{};  // means, since the block goes on shaking about its place
  std::array<double, 2> steps{};
  run(model, deck, team, [&](Model& m) {
    if (m.times.time < 1.8 * stop) return;
    const std::size_t half = m.times.time < 2.4 * stop ? 0 : 1;
    const Vector3d centre = centre_of(m, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) rest[half][axis] += centre[axis];
    ++steps[half];
  });
  const Vector3d end = centre_of(model, 0);
  Slide result;
  result.distance = ((end[0] - start[0]) * velocity[0] + (end[1] - start[1]) * velocity[1]) / speed;
  result.aside = ((end[1] - start[1]) * velocity[0] - (end[0] - start[0]) * velocity[1]) / speed;
  result.drift = std::hypot(rest[1][0] / steps[1] - rest[0][0] / steps[0],
                            rest[1][1] / steps[1] - rest[0][1] / steps[0]);
  return result;
}

void expect_coulomb(const Slide& result, double speed, double friction) {
  const double distance = speed * speed / (2 * friction * gravity_acceleration);
  EXPECT_LE(std::hypot(result.distance - distance, result.aside), 0.01 * distance);
  EXPECT_LE(result.drift, 1e-6 * distance);
}

TEST(SlidingBlock, StopsOnAFloorAfterTheDistanceOfCoulomb) {
  for (const Vector3d& velocity : {Vector3d{4, 0, 0}, Vector3d{2.4, -3.2, 0}}) {
    const Slide result = slide(on_floor(sliding_block(velocity), 0.3), velocity, 0.3);
    expect_coulomb(result, 4, 0.3);
  }
}

// dv/dt = -g (a + b exp(-c v)) with a = mu_k, b = mu_s - mu_k has the integral
// a exp(c v) + b = (a exp(c v0) + b) exp(-a c g t).
TEST(SlidingBlock, SlowsByStaticAndKineticFriction) {
  const double friction = 0.3, kinetic = 0.1, decay = 0.8, speed = 4;
  Deck deck = on_floor(sliding_block({speed, 0, 0}), friction);
  deck.contact->options.kinetic_friction = KineticFriction{kinetic, decay};
  const double b = friction - kinetic, rate = kinetic * decay * gravity_acceleration;
  const double start = kinetic * std::exp(decay * speed) + b;
  const double stop = std::log(start / friction) / rate;
  const auto velocity = [&](double time) {
    return std::log((start * std::exp(-rate * std::min(time, stop)) - b) / kinetic) / decay;
  };
  deck.time.end = 1.3 * stop;
  Model model = build_model(deck);
  ThreadTeam team(1);
  const double begin = centre_of(model, 0)[0];
  double travelled = 0, last = 0, largest = 0;
  run(model, deck, team, [&](Model& m) {
    const double time = m.times.time;
    travelled += 0.5 * (velocity(last) + velocity(time)) * (time - last);
    last = time;
    largest = std::max(largest, std::abs(centre_of(m, 0)[0] - begin - travelled));
  });
  EXPECT_GT(stop,
            1.5 * speed / (friction * gravity_acceleration));  // far longer than at the static coefficient
  EXPECT_NEAR(velocity(stop), 0, 1e-12);
  EXPECT_LE(largest, 0.005 * travelled);
}

// Two blocks on one floor, of which one has a coefficient of its own.
TEST(SlidingBlock, HasTheFrictionOfItsPair) {
  Deck deck = on_floor(sliding_block({4, 0, 0}), 0.3);
  deck.parts[1] = box("floor", {3, 4, 0.25}, {11, 13, 1}, {0.5, 1, -0.125}, hex8());
  deck.parts.push_back(box("smooth", {1, 1, 0.5}, {4, 4, 2}, {0, 2, 0.25}, hex8()));
  deck.initial_conditions.push_back(moving("smooth", {2, 0, 0}));
  deck.contact->pairs = {{.parts = {"floor", "smooth"}, .friction = 0.1}};
  deck.time.end = 0.24;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_NEAR(centre_of(model, 0)[0], 16 / (2 * 0.3 * gravity_acceleration),
              0.01 * 16 / (2 * 0.3 * gravity_acceleration));
  EXPECT_NEAR(centre_of(model, 2)[0], 4 / (2 * 0.1 * gravity_acceleration),
              0.01 * 4 / (2 * 0.1 * gravity_acceleration));
}

TEST(SlidingBlock, FallsThroughAFloorThatItMustNotTouch) {
  Deck deck = on_floor(sliding_block({0, 0, 0}), 0.3);
  deck.contact->pairs = {{.parts = {"block", "floor"}, .touch = false}};
  deck.time.end = 0.1;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_NEAR(centre_of(model, 0)[2], 0.25 - 0.5 * gravity_acceleration * 0.01, 1e-3);
  EXPECT_EQ(audit(model.contacts[0], model.nodes, team).missed(), 0);
  EXPECT_EQ(model.contacts[0].totals.contacts, 0U);
}

TEST(SlidingBlock, PairThatSaysWhatAllDoChangesNoBit) {
  std::array<Vector3d, 2> place{};
  for (std::size_t named = 0; named < 2; ++named) {
    Deck deck = on_floor(sliding_block({4, 1, 0}), 0.3);
    if (named == 1) deck.contact->pairs = {{.parts = {"block", "floor"}, .friction = 0.3}};
    deck.time.end = 0.05;
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    place[named] = centre_of(model, 0);
  }
  EXPECT_EQ(place[0], place[1]);
}

TEST(SlidingBlock, PairOfAPartOutsideOfContactIsRefused) {
  Deck deck = on_floor(sliding_block({0, 0, 0}), 0.3);
  deck.contact->exclude = {"floor"};
  deck.contact->pairs = {{.parts = {"block", "floor"}, .friction = 0.1}};
  EXPECT_THROW(build_model(deck), BuildError);
}

TEST(SlidingBlock, StopsOnARigidWallAfterTheDistanceOfCoulomb) {
  for (const Vector3d& velocity : {Vector3d{4, 0, 0}, Vector3d{2.4, -3.2, 0}}) {
    const Slide result = slide(on_wall(sliding_block(velocity), 0.3), velocity, 0.3);
    expect_coulomb(result, 4, 0.3);
  }
}

// ---- seams

// Moves the inner nodes of a floor within its plane by up to `share` of an edge, each column alike.
void jitter(Mesh& mesh, const Vector3d& low, const Vector3d& high, double share, double edge) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> shift(-share * edge, share * edge);
  for (Vector3d& x : mesh.position) {
    const double dx = shift(generator), dy = shift(generator);
    const bool inner =
        x[0] > low[0] + 1e-9 && x[0] < high[0] - 1e-9 && x[1] > low[1] + 1e-9 && x[1] < high[1] - 1e-9;
    if (!inner || x[2] < -1e-9) continue;  // the lower side is held and may stay as it is
    x[0] += dx;
    x[1] += dy;
  }
}

struct Passage {
  double speed_change = 0;  ///< largest change of the mean velocity along x, over the speed
  double aside = 0;         ///< largest mean velocity along y, over the speed
  double travelled = 0;
};

Passage pass_over(const Deck& deck, const std::vector<Mesh>& meshes, double speed) {
  Model model = build(deck, meshes);
  ThreadTeam team(1);
  Passage passage;
  const double start = centre_of(model, 0)[0];
  run(model, deck, team, [&](Model& m) {
    passage.speed_change = std::max(passage.speed_change, std::abs(mean_velocity(m, 0, 0) / speed - 1));
    passage.aside = std::max(passage.aside, std::abs(mean_velocity(m, 0, 1) / speed));
  });
  passage.travelled = centre_of(model, 0)[0] - start;
  return passage;
}

void expect_no_snagging(const Passage& passage) {
  EXPECT_LE(passage.speed_change, 1e-3);
  EXPECT_LE(passage.aside, 1e-3);
  EXPECT_GT(passage.travelled, 1.5);
}

TEST(FrictionlessBlock, KeepsItsSpeedOverAFloorOfRandomFacets) {
  Deck deck = sliding_block({10, 0, 0});
  deck.parts.push_back(box("floor", {5, 2, 0.25}, {20, 8, 1}, {1.5, 0, -0.125}, hex8()));
  deck.boundary_conditions = {fix("floor.zmin", {0, 1, 2})};
  deck.contact.emplace();
  deck.time.end = 0.2;
  std::vector<Mesh> meshes;
  for (const Part& part : deck.parts) meshes.push_back(generate_mesh(part.mesh, part.placement));
  jitter(meshes[1], {-1, -1, 0}, {4, 1, 0}, 0.3, 0.25);
  expect_no_snagging(pass_over(deck, meshes, 10));
}

}  // namespace
}  // namespace brio
