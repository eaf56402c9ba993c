// Rotations of nodes as fields.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "src/model/state.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double twist_rate = 1e3, beam_length = 0.5;

PrescribedMotion turning(std::string set, double angular_velocity) {
  PrescribedMotion motion;
  motion.where.set = std::move(set);
  motion.components = {{3, Curve{{{0, angular_velocity}}}}};
  return motion;
}

/// A beam whose ends turn about its axis, the far one faster, a cube beside it, and the field named.
Deck twisted_beam() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Beam2 beam;
  beam.section = CircleSection{.radius = 0.02};
  deck.parts = {{"beam", LineMesh{{0, 0, 0}, {beam_length, 0, 0}, 1}, {}, beam, "material"},
                box("cube", {1, 1, 1}, {1, 1, 1}, {0, 0, 5}, hex8())};
  deck.boundary_conditions = {fix("beam.start", {0, 1, 2}), turning("beam.start", 0.9 * twist_rate),
                              turning("beam.end", twist_rate)};
  deck.time.end = 1;
  deck.output.fields_.variables = {"default", "rotation", "beam_twist"};
  return deck;
}

Vector3d rotation_at(const Snapshot& snapshot, std::size_t point) {
  for (const FieldArray& field : snapshot.point_fields)
    if (field.name == "rotation") return vector_at(&field.values[3 * point]);
  ADD_FAILURE() << "no rotation";
  return {};
}

/// Of an angle about x; beyond half a turn that of the shorter way.
Vector3d about_x(double angle) { return {std::remainder(angle, 2 * std::numbers::pi), 0, 0}; }

// Angles are rates times time; the twist is their difference over the length.
TEST(RotationField, OfATwistedBeamIsTheAngleOfItsEnds) {
  const Deck deck = twisted_beam();
  Model model = build_model(deck);
  FieldObserver observer(model, deck.output.fields_.variables);
  ThreadTeam team(1);
  double largest = 0;
  look_at_steps(model, 60, 1e9, team, [&](int) {
    const Snapshot& now = observer.observe(model);
    const double angle = twist_rate * model.times.time;
    EXPECT_LT(norm(rotation_at(now, 0) - about_x(0.9 * angle)), 1e-12) << model.step;
    EXPECT_LT(norm(rotation_at(now, 1) - about_x(angle)), 1e-12) << model.step;
    EXPECT_NEAR(now.cell_fields.back().values[0], 0.1 * angle / beam_length, 1e-12) << model.step;
    for (std::size_t point = 2; point < 10; ++point)
      EXPECT_TRUE(std::isnan(rotation_at(now, point).x)) << "of a solid";
    largest = angle;
  });
  EXPECT_GT(largest, 1.1 * std::numbers::pi);
}

// Turns about different axes follow each other: a quarter about x, then a quarter about z.
TEST(RotationField, ComposesTurns) {
  Model model = build_model(twisted_beam());
  ThreadTeam team(1);
  for (const Vector3d& axis : {Vector3d{1, 0, 0}, Vector3d{0, 0, 1}})
    for (int step = 0; step < 100; ++step) {
      const Vector3d spin = 0.5 * std::numbers::pi * axis;
      std::copy_n(spin.data(), 3, model.nodes.angular_velocity[0].component);
      turn(model.rotations, model.nodes, 0.01, team);
    }
  const Quaternion<double>& q = model.rotations[0];
  const Quaternion<double> expected =
      rotation_by({0, 0, 0.5 * std::numbers::pi}) * rotation_by({0.5 * std::numbers::pi, 0, 0});
  EXPECT_LT(norm(rotation_vector(conjugate(expected) * q)), 1e-13);
}

TEST(RotationField, IsPartOfTheStateAndOnlyThereIfNamed) {
  Deck deck = twisted_beam();
  Model model = build_model(deck);
  ThreadTeam team(1);
  make_steps(model, 10, 1e9, team);
  std::stringstream state;
  save_state(model, state);
  Model restored = build_model(deck);
  restore_state(restored, state, state.str().size());
  EXPECT_EQ(restored.rotations[1].x, model.rotations[1].x);
  EXPECT_NE(restored.rotations[1].x, 0);
  deck.output.fields_.variables = {"default"};
  EXPECT_TRUE(build_model(deck).rotations.empty());
}

}  // namespace
}  // namespace brio
