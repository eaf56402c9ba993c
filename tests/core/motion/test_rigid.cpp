// Rigid bodies alone: free flight, spin, mass properties, prescribed motion, walls.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "src/base/index.hpp"
#include "src/deck/mass_properties.hpp"
#include "src/fields/rotation.hpp"
#include "tests/core/scene.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {

using namespace test;
using std::numbers::pi;

// A rigid box with edges 1, 2, 3 and density 1000; nothing else.
Deck lone_box(double end, double step) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("box", {1, 2, 3}, {2, 2, 2}, {5, -4, 3}, Rigid{})};
  deck.time.end = end;
  deck.time.step = step;
  return deck;
}

InitialCondition spinning(std::string part, Vector3d velocity, Vector3d point, Vector3d angular_velocity) {
  InitialCondition condition = moving(std::move(part), velocity);
  condition.spin = Spin{point, angular_velocity};
  return condition;
}

Vector3d angular_momentum_of(const Model& model) {
  Momentum sum = momentum(model.nodes);
  add_momentum(model.rigid, sum);
  return sum.total.angular;
}

// How far the distances between the nodes of a body and its centre are from the initial ones, over the
// size.
double distortion(const RigidBody& body, const Nodes& nodes) {
  double worst = 0, size = 0;
  for (std::size_t i = 0; i < body.node.size(); ++i) {
    const auto x = [&](std::size_t k) { return vector_at(nodes.record[index(body.node[k])].position); };
    const std::size_t j = (7 * i + 3) % body.node.size();
    worst = std::max(worst, std::abs(norm(x(i) - x(j)) - norm(body.arm[i] - body.arm[j])));
    size = std::max(size, norm(body.arm[i]));
  }
  return worst / size;
}

TEST(MassProperties, OfABoxAreExactForAnyMesh) {
  Mesh mesh = generate_mesh(BoxMesh{{1, 2, 3}, {3, 2, 2}}, {Rotation{{1, 2, -1}, 40}, {7, -3, 2}});
  // Inner nodes may stand anywhere.
  for (Vector3d& x : mesh.position) {
    const Vector3d from_centre = x - Vector3d{7, -3, 2};
    if (norm(from_centre) < 0.3) x[0] += 0.1;
  }
  const MassProperties found = mass_properties(mesh, 10, 0);
  EXPECT_NEAR(found.mass, 60, 1e-12);
  EXPECT_LE(norm(found.centre - Vector3d{7, -3, 2}), 1e-13);
  const Tensor<double> turn = rotation_about(40 * pi / 180, Vector3d{1, 2, -1});
  const Vector3d principal{60 * (4 + 9) / 12.0, 60 * (1 + 9) / 12.0, 60 * (1 + 4) / 12.0};
  const Tensor<double> exact = turn * diagonal(principal) * transposed(turn);
  EXPECT_LE(norm(found.inertia - exact), 1e-12 * norm(exact));
}

TEST(MassProperties, OfAShellIncludeItsThickness) {
  const Mesh mesh = generate_mesh(PlateMesh{{2, 3}, {4, 2}}, {std::nullopt, {1, 1, 1}});
  const MassProperties found = mass_properties(mesh, 10, 0.5);
  EXPECT_NEAR(found.mass, 30, 1e-12);
  const Vector3d principal{30 * (9 + 0.25) / 12, 30 * (4 + 0.25) / 12, 30 * (4 + 9) / 12.0};
  EXPECT_LE(norm(found.inertia - diagonal(principal)), 1e-12 * norm(principal));
}

TEST(MassProperties, InvertedElementIsNamed) {
  Mesh mesh = generate_mesh(BoxMesh{{1, 1, 1}, {2, 1, 1}}, {});
  std::swap(mesh.connectivity[8], mesh.connectivity[9]);
  try {
    mass_properties(mesh, 1, 0);
    FAIL();
  } catch (const std::invalid_argument& fault) {
    EXPECT_NE(std::string(fault.what()).find("element 1"), std::string::npos);
  }
}

TEST(RigidBody, FliesAndTurnsFreely) {
  Deck deck = lone_box(2, 1e-3);
  Gravity gravity;
  gravity.acceleration = {0, 0, -10};
  deck.loads = {gravity};
  deck.initial_conditions = {spinning("box", {3, 0, 20}, {5, -4, 3}, {0, 0, 4})};
  Model model = build_model(deck);
  EXPECT_NEAR(model.parts[0].mass, 6000, 1e-9);
  ThreadTeam team(1);
  const Vector3d start = angular_momentum_of(model);
  double worst = 0;
  run(model, deck, team, [&](Model& m) {
    worst = std::max(worst, std::abs(m.energy.relative_error()));
    // Angular momentum grows by the moment of the weight, which is counted as an impulse of loads.
    const Vector3d expected = start + m.momentum.loads.angular;
    EXPECT_LE(norm(angular_momentum_of(m) - expected), 1e-12 * norm(start));
  });
  const RigidBody& body = model.rigid.body[0];
  // Leapfrog is exact for a parabola.
  EXPECT_LE(norm(body.centre - Vector3d{5 + 3 * 2, -4, 3 + 20 * 2 - 0.5 * 10 * 4}), 1e-10);
  const Vector3d axis = rotated(body.attitude, Vector3d{1, 0, 0});
  // 8 radian, with the phase error of the midpoint rule: a third of the square of half the angle of a step.
  EXPECT_LE(norm(axis - Vector3d{std::cos(8), std::sin(8), 0}), 8 * 0.002 * 0.002 / 2.9);
  EXPECT_LE(worst, 1e-12);
  EXPECT_LE(distortion(body, model.nodes), 1e-14);
}

// About the intermediate axis, a little off: the body turns over again and again.
void spin_about_the_intermediate_axis(double turn_a_step, int steps) {
  Deck deck = lone_box(1e9, 1e-3);
  deck.parts[0] = box("box", {1, 2, 3}, {2, 2, 2}, {0, 0, 0}, Rigid{});
  const double rate = turn_a_step / 1e-3;
  deck.initial_conditions = {spinning("box", {0, 0, 0}, {0, 0, 0}, {1e-3 * rate, rate, 1e-4 * rate})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  const double energy = model.energy.kinetic_start;
  const Vector3d momentum_at_start = angular_momentum_of(model);
  double worst_energy = 0, worst_momentum = 0;
  int turned_over = 0;
  double side = 1;
  look_at_steps(model, steps, 0.1, team, [&](int) {
    worst_energy = std::max(worst_energy, std::abs(model.energy.kinetic / energy - 1));
    worst_momentum = std::max(worst_momentum, norm(angular_momentum_of(model) - momentum_at_start));
    const Vector3d axis = rotated(model.rigid.body[0].attitude, Vector3d{0, 1, 0});
    if (axis[1] * side < -0.5) {
      side = -side;
      ++turned_over;
    }
  });
  EXPECT_GT(turned_over, 5);
  EXPECT_LE(worst_energy, 1e-10);
  EXPECT_LE(worst_momentum, 1e-12 * norm(momentum_at_start));
  EXPECT_LE(distortion(model.rigid.body[0], model.nodes), 1e-13);
}

TEST(RigidBody, TurnsOverAboutItsIntermediateAxisAndKeepsEnergyAndMomentum) {
  spin_about_the_intermediate_axis(0.01, 100000);
  spin_about_the_intermediate_axis(0.5, 100000);
}

double angle_between(const Quaternion<double>& a, const Quaternion<double>& b) {
  return norm(rotation_vector(conjugate(a) * b));
}

TEST(RigidBody, PhaseConvergesWithTheSquareOfTheStep) {
  const auto attitude_after = [](double step) {
    Deck deck = lone_box(1, step);
    deck.initial_conditions = {spinning("box", {0, 0, 0}, {5, -4, 3}, {1, 5, 2})};
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    return model.rigid.body[0].attitude;
  };
  const Quaternion<double> fine = attitude_after(1.0 / 16384);
  const double coarse_error = angle_between(attitude_after(1.0 / 128), fine);
  const double error = angle_between(attitude_after(1.0 / 256), fine);
  EXPECT_NEAR(coarse_error / error, 4, 0.05);
}

TEST(RigidBody, SymmetricTopPrecessesAsEulerSays) {
  Deck deck = lone_box(1, 1e-4);
  deck.parts[0] = box("box", {1, 1, 3}, {1, 1, 1}, {0, 0, 0}, Rigid{});
  deck.initial_conditions = {spinning("box", {0, 0, 0}, {0, 0, 0}, {2, 0, 7})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  const double across = model.rigid.body[0].inertia(0, 0), along = model.rigid.body[0].inertia(2, 2);
  const Vector3d momentum_at_start{across * 2, 0, along * 7};
  run(model, deck, team);
  // The axis of the top goes around the angular momentum at the rate |L| / across.
  const Vector3d axis = rotated(model.rigid.body[0].attitude, Vector3d{0, 0, 1});
  const Vector3d expected =
      rotation_about(norm(momentum_at_start) / across, momentum_at_start) * Vector3d{0, 0, 1};
  EXPECT_LE(norm(axis - expected), 1e-6);
}

TEST(RigidBody, OwnMassCentreAndInertiaTakeThePlaceOfThoseOfTheMesh) {
  Deck deck = lone_box(1, 1e-3);
  Rigid rigid;
  rigid.mass = 3;
  rigid.inertia = {{4, 5, 6, 0.5, -0.25, 0.125}};
  rigid.centre = {{5.25, -4, 3}};
  deck.parts[0].element = rigid;
  const Model model = build_model(deck);
  const Tensor<double> expected{{{4, 0.5, 0.125}, {0.5, 5, -0.25}, {0.125, -0.25, 6}}};
  EXPECT_EQ(model.rigid.body[0].mass, 3);
  EXPECT_EQ(model.rigid.body[0].inertia, expected);
  EXPECT_EQ(model.rigid.body[0].centre, (Vector3d{5.25, -4, 3}));

  Rigid heavy;
  heavy.mass = 12000;
  deck.parts[0].element = heavy;
  EXPECT_NEAR(build_model(deck).rigid.body[0].inertia(0, 0), 12000 * (4 + 9) / 12.0, 1e-8);
}

// ---- loads

TEST(RigidBody, ForcesOnItsNodesPushAndTurnIt) {
  Deck deck = lone_box(0.01, 1e-3);
  NodalForce force;
  force.where.set = "box.xmax";
  force.force = {0, 12, 0};
  deck.loads = {force};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  const RigidBody& body = model.rigid.body[0];
  // Nine nodes half a length beside the centre; the body has hardly turned. Velocities are half a step ahead.
  const double impulse = 9 * 12.0 * 0.0105;
  EXPECT_NEAR(model.rigid.motion[0].velocity[1], impulse / body.mass, 1e-12 * impulse);
  EXPECT_NEAR(body.angular_momentum[2], impulse * 0.5, 1e-8 * impulse);
  EXPECT_LE(std::abs(model.energy.relative_error()), 1e-12);
}

TEST(RigidBody, PressureOnItsSideMovesIt) {
  Deck deck = lone_box(0.01, 1e-3);
  Pressure pressure;
  pressure.side_set = "box.xmin";
  pressure.pressure = Curve{{{0, 5}}};
  deck.loads = {pressure};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_NEAR(model.rigid.motion[0].velocity[0], 5 * 6 / 6000.0 * 0.0105, 1e-12);
  EXPECT_LE(norm(model.rigid.motion[0].angular_velocity), 1e-15);
}

// ---- prescribed motion

PrescribedMotion prescribe_component(std::string part, MotionKind kind, int axis, Curve curve) {
  PrescribedMotion motion;
  motion.where.set = std::move(part);
  motion.kind = kind;
  motion.components = {{axis, std::move(curve)}};
  return motion;
}

TEST(PrescribedRigidBody, FollowsItsCurvesAndAccountsForSupports) {
  Deck deck = lone_box(1, 1e-3);
  deck.boundary_conditions = {
      fix("box", {0, 1, 3, 4}),
      prescribe_component("box", MotionKind::displacement, 2, Curve{{{0, 0}, {1, -2}}}),
      prescribe_component("box", MotionKind::velocity, 5, Curve{{{0, 0}, {1, 3}}})};
  deck.parts[0].placement.rotate = Rotation{{1, 1, 0}, 30};  // products of inertia do not vanish
  Model model = build_model(deck);
  ThreadTeam team(1);
  double error = 0;
  run(model, deck, team, [&](Model& m) {
    error = std::max(error, std::abs(m.energy.relative_error()));
    Momentum now = momentum(m.nodes);
    add_momentum(m.rigid, now);
    const Vector3d angular = now.total.angular;
    EXPECT_LE(norm(angular - m.momentum.start.angular - m.momentum.supports.angular),
              1e-11 * now.angular_size);
  });
  const RigidBody& body = model.rigid.body[0];
  EXPECT_LE(norm(body.centre - Vector3d{5, -4, 1}), 1e-12);
  EXPECT_LE(norm(rotation_vector(body.attitude) - Vector3d{0, 0, 1.5}), 1e-9);
  EXPECT_LE(error, 1e-12);
  EXPECT_LE(distortion(body, model.nodes), 1e-14);
}

TEST(PrescribedRigidBody, FreeAlongOneAxisOnlyMovesAlongIt) {
  Deck deck = lone_box(0.5, 1e-3);
  Gravity gravity;
  gravity.acceleration = {3, 4, -10};
  deck.loads = {gravity};
  deck.boundary_conditions = {fix("box", {0, 1, 3, 4, 5})};
  NodalForce force;
  force.where.set = "box.xmax";
  force.force = {0, 0, 1};
  deck.loads.push_back(force);
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  const RigidBody& body = model.rigid.body[0];
  EXPECT_NEAR(body.centre[0], 5, 1e-14);
  EXPECT_NEAR(body.centre[1], -4, 1e-14);
  EXPECT_NEAR(body.centre[2], 3 + 0.5 * (-10 + 9 / 6000.0) * 0.25, 1e-10);
  EXPECT_EQ(body.attitude, no_rotation);
  EXPECT_LE(std::abs(model.energy.relative_error()), 1e-12);
}

// A gimbal: no spin about x is allowed, the rest is free and the supports do no work.
TEST(PrescribedRigidBody, OneForbiddenRotationDoesNoWork) {
  Deck deck = lone_box(5, 1e-3);
  deck.initial_conditions = {spinning("box", {0, 0, 0}, {5, -4, 3}, {0, 2, 1})};
  deck.boundary_conditions = {fix("box", {3})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  double error = 0;
  run(model, deck, team, [&](Model& m) {
    error = std::max(error, std::abs(m.energy.relative_error()));
    EXPECT_LE(std::abs(m.rigid.motion[0].angular_velocity[0]), 1e-12);
  });
  EXPECT_LE(error, 1e-5);
}

// The turn is sought until its change is rounding, which may stay at a few units in the last place.
TEST(PrescribedRigidBody, AnyTurnIsFound) {
  for (int k = 0; k < 60; ++k) {
    Deck deck = lone_box(5, 1e-3);
    deck.initial_conditions = {
        spinning("box", {0, 0, 0}, {5 + 0.37 * k, -4 + 0.21 * k, 3 - 0.53 * k}, {0, 2, 1})};
    deck.boundary_conditions = {fix("box", {3 + k % 3})};
    Model model = build_model(deck);
    ThreadTeam team(1);
    EXPECT_NO_THROW(run(model, deck, team)) << k;
  }
}

// ---- walls

TEST(RigidBodyOnAWall, StopsFlatAndTurnsWhenHitBesideItsCentre) {
  // A corner edge first: impulse J along z at an arm a beside the centre, so that V + J/M + w a = 0.
  Deck deck = lone_box(1e-3, 1e-6);
  deck.parts[0] = box("box", {2, 1, 1}, {2, 2, 2}, {0, 0, 1}, Rigid{});
  deck.parts[0].placement.rotate = Rotation{{0, 1, 0}, 20};
  deck.initial_conditions = {moving("box", {0, 0, -10})};
  RigidWall wall;
  wall.normal = {0, 0, 1};
  const double lowest = 1 - std::sin(pi / 9) - 0.5 * std::cos(pi / 9);
  wall.point = {0, 0, lowest - 5e-3};
  deck.boundary_conditions = {wall};
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  const double arm = std::cos(pi / 9) - 0.5 * std::sin(pi / 9);  // of the lowest edge, along x
  const double mass = 2000, inertia = mass * (4 + 1) / 12.0;
  const double impulse = 10 / (1 / mass + arm * arm / inertia);
  EXPECT_NEAR(model.rigid.motion[0].velocity[2], -10 + impulse / mass, 1e-2);
  EXPECT_NEAR(model.rigid.motion[0].angular_velocity[1], -arm * impulse / inertia, 1e-2);
  EXPECT_NEAR(model.momentum.walls.linear[2], impulse, 1e-3 * impulse);
  Momentum now = momentum(model.nodes);
  add_momentum(model.rigid, now);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(now.total.angular[i] - model.momentum.start.angular[i], model.momentum.walls.angular[i],
                1e-12 * now.angular_size);
  EXPECT_LE(std::abs(model.energy.relative_error()), 1e-12);
}

TEST(RigidBodyOnAWall, StopsAfterTheDistanceOfCoulomb) {
  for (const Vector3d& velocity : {Vector3d{4, 0, 0}, Vector3d{2.4, -3.2, 0}}) {
    Deck deck = lone_box(0.32, 1e-4);
    deck.parts[0] = box("box", {1, 1, 0.5}, {4, 4, 2}, {0, 0, 0.25}, Rigid{});
    deck.initial_conditions = {moving("box", velocity)};
    Gravity gravity;
    gravity.acceleration = {0, 0, -100};
    deck.loads = {gravity};
    RigidWall floor;
    floor.normal = {0, 0, 1};
    floor.friction = 0.3;
    deck.boundary_conditions = {floor};
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    const double distance = 16 / (2 * 0.3 * 100);
    const Vector3d end = model.rigid.body[0].centre;
    EXPECT_NEAR(end[0], distance * velocity[0] / 4, 0.01 * distance);
    EXPECT_NEAR(end[1], distance * velocity[1] / 4, 0.01 * distance);
    EXPECT_NEAR(end[2], 0.25, 1e-6);
    EXPECT_LE(std::abs(model.energy.relative_error()), 1e-10);
    EXPECT_LE(model.energy.contact_added_max, 1e-6 * model.energy.kinetic_start);
  }
}

// ---- what is refused

void expect_refused(const Deck& deck, const std::string& words) {
  try {
    build_model(deck);
    FAIL() << words;
  } catch (const BuildError& fault) {
    EXPECT_NE(std::string(fault.what()).find(words), std::string::npos) << fault.what();
  }
}

TEST(RigidBody, ConditionsOnSomeOfItsNodesAreRefused) {
  Deck deck = lone_box(1, 1e-3);
  deck.boundary_conditions = {fix("box.xmin", {0})};
  expect_refused(deck, "moves as a whole");
  deck = lone_box(1, 1e-3);
  deck.initial_conditions = {moving("box.xmin", {1, 0, 0})};
  expect_refused(deck, "moves as a whole");
}

TEST(RigidBody, AloneItNeedsAGivenStep) {
  Deck deck = lone_box(1, 1e-3);
  deck.time.step.reset();
  expect_refused(deck, "time.step");
}

TEST(RigidBody, BeginningBehindAWallIsRefused) {
  Deck deck = lone_box(1, 1e-3);
  RigidWall wall;
  wall.normal = {1, 0, 0};
  wall.point = {4.75, 0, 0};
  deck.boundary_conditions = {wall};
  expect_refused(deck, "behind a rigid wall");
}

TEST(RigidBody, TurningFartherThanTheStepCanFollowStopsTheRun) {
  Deck deck = lone_box(1, 1e-3);
  deck.initial_conditions = {spinning("box", {0, 0, 0}, {5, -4, 3}, {1e5, 1e6, 1e5})};
  Model model = build_model(deck);
  ThreadTeam team(1);
  EXPECT_THROW(run(model, deck, team), Breakdown);
}

}  // namespace
}  // namespace brio
