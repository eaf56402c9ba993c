// Deletion of elements: when.

#include <gtest/gtest.h>

#include "tests/core/sweep/erosion_scene.hpp"

namespace brio {
namespace {

using namespace test;

TEST(Erosion, MinimumStepDeletesWhatWouldHoldTheStepDown) {
  Deck deck = stretched_bar(2, elastic(0.0), -1);
  deck.time.end = 0.9;
  deck.time.step_scale = 0.5;
  Model reference = build_model(deck);
  ThreadTeam team(1);
  update_velocities(reference, 1, team);
  deck.parts[0].deletion.emplace();
  deck.parts[0].deletion->minimum_step = 0.4 * reference.control.stable;
  Model model = build_model(deck);
  run_all(model, deck);
  EXPECT_EQ(model.erosion->total_deleted(), 2);
  EXPECT_EQ(model.erosion->deleted_by_cause, (CountByCause{0, 0, 2}));
  EXPECT_GT(model.control.least, 0.5 * 0.39 * reference.control.stable);
}

TEST(Erosion, VolumeRatioDeletesWhatIsCrushed) {
  Deck deck = stretched_bar(2, elastic(0.0), -1);
  deck.parts[0].deletion.emplace();
  deck.parts[0].deletion->volume_ratio = 0.85;
  deck.time.end = 0.3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  double time_of_death = 0;
  run(model, deck, team, [&](Model& m) {
    if (!m.erosion->deleted.empty()) time_of_death = m.times.time;
  });
  EXPECT_EQ(model.erosion->total_deleted(), 2);
  EXPECT_NEAR(time_of_death, 0.15, 2 * model.control.largest);
}

// One node of a cube is driven along an edge: when it passes the node at the other end, after 1, the edges of
// neither span a positive volume any more, though the cube has kept most of its own.
TEST(Erosion, CornerInvertedDeletesWhatIsInsideOutAtACorner) {
  for (const bool named : {false, true}) {
    Deck deck = pulled_bar(1, elastic(0.0));
    PrescribedMotion driven = pull("", 0, -1);
    driven.where.region = BoxRegion{{0.75, 0.25, 0.25}, {9, 9, 9}};
    deck.boundary_conditions = {fix("bar.all", {1, 2}), fix("bar.xmin", {0}), driven};
    for (const auto& [low, high] : {std::pair{-9.0, 0.25}, std::pair{0.25, 9.0}}) {
      PrescribedMotion held = pull("", 0, 0);
      held.where.region = BoxRegion{{0.75, low, -9}, {9, high, low < 0 ? 9 : 0.25}};
      deck.boundary_conditions.push_back(held);
    }
    deck.parts[0].deletion.emplace();
    deck.parts[0].deletion->inverted = true;
    deck.parts[0].deletion->corner_inverted = named;
    deck.time.end = 1.2;
    Model model = build_model(deck);
    ThreadTeam team(1);
    double time_of_death = 0;
    run(model, deck, team, [&](Model& m) {
      if (!m.erosion->deleted.empty()) time_of_death = m.times.time;
    });
    EXPECT_EQ(model.erosion->total_deleted(), named ? 1 : 0);
    EXPECT_NEAR(time_of_death, named ? 1 : 0, 2 * model.control.largest);
  }
}

// Nodes of one side of a soft cube are driven through the other.
Deck crushed_cube() {
  Deck deck = stretched_bar(2, elastic(0.0), 0);
  deck.boundary_conditions = {fix("bar.all", {1, 2}), fix("bar.xmin", {0}), pull("bar.xmax", 0, -2000)};
  deck.numerics.energy_error_limit = 100;
  deck.time.end = 0.01;
  return deck;
}
TEST(Erosion, InvertedElementIsDeletedOrStopsTheRunAsTheDeckSays) {
  Deck deck = crushed_cube();
  deck.parts[0].deletion.emplace();
  Model stopped = build_model(deck);
  ThreadTeam team(1);
  EXPECT_THROW(run(stopped, deck, team), Breakdown);
  deck.parts[0].deletion->inverted = true;
  Model model = build_model(deck);
  run_all(model, deck);
  EXPECT_GE(model.erosion->total_deleted(), 1);
  EXPECT_TRUE(std::isfinite(model.energy.sum()));
}

// One side of a soft shell is driven towards the other, or through it, where its area is positive again, in a
// step.
TEST(Erosion, ShellThatAStepHalvesOrTurnsOverHasInverted) {
  for (const double share : {0.45, 0.55, 0.99, 1.01, 1.4}) {
    Deck deck;
    deck.materials = {{"material", elastic(0.0)}};
    PlateMesh plate;
    plate.size = {1, 1};
    plate.elements = {1, 1};
    Shell4 shell;
    shell.thickness = 0.1;
    deck.parts = {{"sheet", plate, {}, shell, "material"}};
    deck.boundary_conditions = {fix("sheet.all", {1, 2, 3, 4, 5}), fix("sheet.xmin", {0})};
    deck.numerics.energy_error_limit = 100;
    deck.time.step = 1e-4;
    deck.boundary_conditions.push_back(pull("sheet.xmax", 0, -share / 1e-4));
    deck.time.end = 1e-3;
    Model model = build_model(deck);
    ThreadTeam team(1);
    if (share < 0.5) {
      EXPECT_NO_THROW(make_steps(model, 1, 100, team)) << share;
    } else {
      EXPECT_THROW(make_steps(model, 1, 100, team), Breakdown) << share;
    }
  }
}

TEST(Erosion, PressureGoesWithTheElementItPushes) {
  Deck deck = stretched_bar(2, brittle(0.02, 0.05), 1);
  deck.loads = {Pressure{"bar.xmin", Curve{{{0, 1e3}}}}, Pressure{"bar.ymax", Curve{{{0, 1e3}}}}};
  Model model = build_model(deck);
  const auto sides = [&](std::size_t load) {
    return std::get<PressureLoad>(model.loads[load].load).sides.size();
  };
  EXPECT_EQ(sides(0), 1u);
  EXPECT_EQ(sides(1), 2u);
  run_all(model, deck);
  EXPECT_EQ(sides(0), 0u);
  EXPECT_EQ(sides(1), 0u);
}

// A strip that is bent about one end: points far from the middle fail first.
Deck bent_strip(double failed_points) {
  Deck deck;
  ElasticPlastic law = brittle(0.01, 0.01);
  law.failure->failed_points = failed_points;
  deck.materials = {{"material", law}};
  Shell4 shell;
  shell.thickness = 0.1;
  PlateMesh mesh;
  mesh.size = {1, 1};
  mesh.elements = {1, 1};
  deck.parts = {{"strip", mesh, {}, shell, "material"}};
  // Bending and, far less, stretching: the pulled half fails, then the middle.
  PrescribedMotion turn = pull("strip.xmax", 4, -2);
  turn.components.push_back({0, Curve{{{0, 0.05}}}});
  turn.components.push_back({1, Curve{{{0, 0}}}});
  turn.components.push_back({2, Curve{{{0, 0}}}});
  deck.boundary_conditions = {fix("strip.xmin", {0, 1, 2, 3, 4, 5}), turn};
  deck.time.end = 1;
  return deck;
}
TEST(Erosion, ShellGoesWhenTheChosenShareOfItsPointsHasFailed) {
  double last = 0;
  for (const double share : {0.2, 0.4, 0.6}) {
    const Deck deck = bent_strip(share);
    Model model = build_model(deck);
    ThreadTeam team(1);
    double time_of_death = HUGE_VAL;
    run(model, deck, team, [&](Model& m) {
      if (!m.erosion->deleted.empty()) time_of_death = m.times.time;
    });
    EXPECT_LT(time_of_death, HUGE_VAL) << share;
    EXPECT_GT(time_of_death, last) << share;
    last = time_of_death;
  }
}

}  // namespace
}  // namespace brio
