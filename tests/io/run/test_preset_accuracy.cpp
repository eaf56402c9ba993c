// What `accurate` says it is: no worse than the default where bricks bend, where they meet,
// and where waves run through them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/deck/read_deck.hpp"
#include "io/run/run_deck.hpp"
#include "src/step/advance.hpp"

namespace brio {
namespace {

Model at_end(const std::string& text, const std::string& preset) {
  const Deck deck = parse_deck(text, "deck.yaml", {"numerics.preset=" + preset});
  Model model = build_scene(deck);
  ThreadTeam team(1);
  run(model, deck.numerics.energy_error_limit, team, [](Model&) { return true; });
  return model;
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

// inputs/verification/rod_wave.yaml: highest pressure at the end beyond that of the step.
double ringing(const std::string& preset) {
  Model model = at_end(R"(
materials: {soft: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0}}
parts:
  rod:
    mesh: {box: {size: [1, 0.01, 0.01], elements: [100, 1, 1]}}
    placement: {translate: [0.5, 0, 0]}
    element: hex8
    material: soft
loads: [{side_set: rod.xmin, pressure: 1e6}]
numerics: {energy_error_limit: 0.1}
time: {end: 5e-4}
)",
                       preset);
  const Block& block = model.blocks[0];
  double least = 0;
  for (std::size_t e = 0; e < block.element_count; ++e)
    least = std::min(least, block.kernel.sample(block, model.nodes, e, true).stress.xx);
  return -least / 1e6 - 1;
}

// A larger step alone changes the frequency by parts in a million.
TEST(PresetAccuracy, AccurateBendsBricksNoWorseThanTheDefault) {
  const double balanced = error_of_bending("balanced");
  EXPECT_LE(error_of_bending("accurate"), balanced + 1e-5);
  EXPECT_LE(balanced, 0.06);
}

TEST(PresetAccuracy, AccurateKeepsMoreOfTheSpeedOfAnImpactThanTheDefault) {
  EXPECT_LT(loss_of_speed("accurate"), 0.98 * loss_of_speed("balanced"));
}

// Less viscosity alone rings more: 10 % with half of it.
TEST(PresetAccuracy, AccurateRingsBehindAStepOfPressureNoMoreThanTheDefault) {
  const double balanced = ringing("balanced");
  EXPECT_LT(ringing("accurate"), balanced);
  EXPECT_LT(balanced, 0.05);
}

}  // namespace
}  // namespace brio
