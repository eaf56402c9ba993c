// What `accurate` says it is: no worse than the default where bricks bend and where they meet.

#include <gtest/gtest.h>

#include <cmath>

#include "io/read_deck.hpp"
#include "io/run_deck.hpp"
#include "src/advance.hpp"

namespace brio {
namespace {

Model at_end(const std::string& text, const std::string& preset) {
  const Deck deck = parse_deck(text, "deck.yaml", {"numerics.preset=" + preset});
  Model model = build_scene(deck);
  ThreadTeam team(1);
  while (true) {
    update_velocities(model, deck.numerics.energy_error_limit, team);
    if (model.times.time >= deck.time.end) return model;
    update_positions(model, team);
  }
}

// inputs/verification/brick_cantilever.yaml: relative error of the frequency.
double error_of_bending(const std::string& preset) {
  const Model model = at_end(R"(
materials: {soft: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0}}
parts:
  bar:
    mesh: {box: {size: [1, 0.05, 0.05], elements: [40, 2, 2]}}
    placement: {translate: [0.5, 0, 0]}
    element: hex8
    material: soft
boundary_conditions: [{set: bar.xmin, fix: [x, y, z]}]
loads: [{gravity: [0, 0, 1]}]
numerics: {energy_error_limit: 0.1}
time: {end: 0.154762}
)",
                             preset);
  double tip = 0;
  int count = 0;
  for (const NodeRecord& node : model.nodes.record)
    if (node.position[0] > 0.999) tip += node.position[2], ++count;
  EXPECT_EQ(count, 9);
  constexpr double reference = 0.000589083, shift = 0.00471;  // of 256 beams; static deflection times w t
  return std::abs(tip / count - reference) / shift;
}

// inputs/verification/bar_on_wall.yaml: what is missing of the speed.
double loss_of_speed(const std::string& preset) {
  const Model model = at_end(R"(
materials: {soft: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0}}
parts:
  bar:
    mesh: {box: {size: [1, 0.05, 0.05], elements: [20, 1, 1]}}
    placement: {translate: [0.5, 0, 0]}
    element: hex8
    material: soft
initial_conditions: [{part: bar, velocity: [-1, 0, 0]}]
boundary_conditions: [{rigid_wall: {point: [0, 0, 0], normal: [1, 0, 0]}}]
numerics: {energy_error_limit: 0.1}
time: {end: 3e-3}
)",
                             preset);
  double sum = 0, mass = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    sum += model.nodes.mass[i] * model.nodes.record[i].velocity[0];
    mass += model.nodes.mass[i];
  }
  return std::abs(1 - sum / mass);
}

// A larger step alone changes the frequency by parts in a million.
TEST(PresetAccuracy, AccurateBendsBricksNoWorseThanTheDefault) {
  const double balanced = error_of_bending("balanced");
  EXPECT_LE(error_of_bending("accurate"), balanced + 1e-5);
  EXPECT_LE(balanced, 0.06);
}

TEST(PresetAccuracy, AccurateKeepsMoreOfTheSpeedOfAnImpactThanTheDefault) {
  EXPECT_LT(loss_of_speed("accurate"), 0.8 * loss_of_speed("balanced"));
}

}  // namespace
}  // namespace brio
