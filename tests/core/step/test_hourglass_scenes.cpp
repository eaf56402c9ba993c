// Hourglass control over whole scenes: it never adds energy, and a run warns where its energy is large.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/output/run_warnings.hpp"
#include "tests/core/sweep/particle_scene.hpp"

namespace brio::test {
namespace {

/// A body squeezed along z between its ends, which hold their shape.
Deck squeezed(Part part, const Material& material, double height, double speed, double share) {
  Deck deck;
  deck.materials = {{"material", material}};
  const std::string name = part.name;
  deck.parts = {std::move(part)};
  PrescribedMotion foot = fix(name + ".zmin", {0, 1, 2}), head = fix(name + ".zmax", {0, 1});
  head.components.push_back({2, Curve{{{0, -speed}}}});
  deck.boundary_conditions = {foot, head};
  deck.time.end = share * height / speed;
  deck.numerics.energy_error_limit = 0.05;
  return deck;
}

/// Least hourglass energy on the way, over the largest energy.
double least_hourglass(Model& model, const Deck& deck) {
  ThreadTeam team;
  double least = 0;
  run(model, deck, team, [&](Model& m) { least = std::min(least, m.energy.hourglass); });
  EXPECT_GT(model.energy.hourglass, 0);
  return least / model.energy.reference;
}

Part cube() { return box("cube", {1, 1, 1}, {4, 4, 4}, {0, 0, 0}, Hex8{}); }

TEST(HourglassScenes, BricksSqueezedToAFifthAreNotDriven) {
  for (const Material& material : {Material(elastic(0.3)), Material(yielding())})
    for (const double speed : {20.0, 150.0}) {
      const Deck deck = squeezed(cube(), material, 1, speed, 0.8);
      Model model = build_model(deck);
      EXPECT_GE(least_hourglass(model, deck), -1e-12) << speed;
    }
}

TEST(HourglassScenes, ParticlesThatFlowAreNotDriven) {
  for (const Material& material : {Material(elastic(0.3)), Material(yielding())}) {
    Part block =
        particles("block", box_of_particles({1, 1, 1}, 0.2), particle(ParticleFrame::total_lagrangian));
    const Deck deck = squeezed(std::move(block), material, 1, 20, 0.3);
    Model model = build_model(deck);
    EXPECT_GE(least_hourglass(model, deck), -1e-12);
  }
}

// One corner of a brick's face pulled: all that answers is hourglass control.
TEST(HourglassScenes, TellWhichPartHourglassesAndSinceWhen) {
  for (const double limit : {0.1, 1e6}) {
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {box("calm", {1, 1, 1}, {2, 2, 2}, {5, 0, 0}, Hex8{}),
                  box("bent", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, Hex8{})};
    deck.initial_conditions = {moving("calm", {0, 0, 1})};
    // The hourglass mode x = xi eta of all eight nodes.
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5}) {
        InitialCondition bend = moving("", {x * y > 0 ? 1.0 : -1.0, 0, 0});
        bend.where = {"", BoxRegion{{x - 0.1, y - 0.1, -1}, {x + 0.1, y + 0.1, 1}}, "bent"};
        deck.initial_conditions.push_back(bend);
      }
    deck.time.end = 0.02;
    deck.numerics.hourglass_warning = limit;
    Model model = build_model(deck);
    ThreadTeam team;
    double time_of_warning = -1;
    run(model, deck, team, [&](Model& m) {
      if (time_of_warning < 0 && m.part_energy[1].time_of_warning >= 0) time_of_warning = m.times.time;
    });
    EXPECT_NEAR(model.part_energy[0].hourglass + model.part_energy[1].hourglass, model.energy.hourglass,
                1e-12 * model.energy.reference);
    EXPECT_EQ(part_of_largest_ratio(model.part_energy), 1u);
    EXPECT_GT(model.part_energy[1].largest_ratio, 1);
    EXPECT_EQ(model.part_energy[0].largest_ratio, 0);
    const std::vector<std::string> warnings = run_warnings(model);
    ASSERT_EQ(warnings.size(), limit < 1 ? 1u : 0u);
    EXPECT_EQ(model.part_energy[1].time_of_warning, time_of_warning);
    if (warnings.empty()) continue;
    EXPECT_GT(time_of_warning, 0);
    EXPECT_LT(time_of_warning, model.part_energy[1].time_of_largest);
    EXPECT_NE(warnings[0].find("part 'bent': hourglass energy passed 10 %"), std::string::npos)
        << warnings[0];
  }
}

}  // namespace
}  // namespace brio::test
