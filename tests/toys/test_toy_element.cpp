// An element of its own folder and one word in the list is chosen, packed and swept as any.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "elements/block.hpp"

namespace brio {
namespace {

const Elastic steel{.density = 8000, .youngs_modulus = 200e9, .poissons_ratio = 0.3};
constexpr double length = 0.5, area = 1e-4;

/// A free bar along x whose ends fly apart.
struct VibratingBar {
  Nodes nodes{2, false};
  Block block;

  explicit VibratingBar(Precision precision) {
    nodes.record[1].position[0] = length;
    nodes.record[0].velocity[0] = -1;
    nodes.record[1].velocity[0] = 1;
    block = make_block("bar", ToySpring{.area = area}, steel, precision, std::vector<int>{0, 1});
    block.kernel.initialize(block, nodes);
  }
  SweepResult advance(double step) {
    for (NodeVector& force : nodes.force) force = {};
    for (NodeRecord& record : nodes.record) record.position[0] += step * record.velocity[0];
    const SweepResult result = block.kernel.sweep(block, {0, 1, 1}, nodes, step);
    for (std::size_t n = 0; n < 2; ++n)
      nodes.record[n].velocity[0] += step * nodes.force[n].component[0] / nodes.mass[n];
    return result;
  }
};

TEST(ToyElement, IsOneOfTheList) {
  const Element element = ToySpring{.area = area};
  EXPECT_EQ(name_of(element), "toy_spring");
  EXPECT_EQ(nodes_per_element(element), 2);
  EXPECT_EQ(traits_of(element).cell, line_cell);
  EXPECT_TRUE(accepts(element, steel));
}

TEST(ToyElement, HasTheMassAndTheFrequencyOfABar) {
  VibratingBar bar(Precision::double_precision);
  EXPECT_DOUBLE_EQ(bar.nodes.mass[0] + bar.nodes.mass[1], 8000 * area * length);
  EXPECT_DOUBLE_EQ(bar.block.kernel.mass(bar.block, 0), 8000 * area * length);
  EXPECT_NEAR(bar.advance(0).stable_step, length * std::sqrt(8000 / 200e9), 1e-12 * length);
}

TEST(ToyElement, KeepsEnergyAndMomentum) {
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    VibratingBar bar(precision);
    const double step = 0.02 * bar.advance(0).stable_step;
    const double kinetic_start = 0.5 * 8000 * area * length;
    double internal = 0, largest = 0;
    for (int k = 0; k < 5000; ++k) {
      internal += bar.advance(step).internal_energy;
      largest = std::max(largest, internal);
      EXPECT_GT(internal, -0.05 * kinetic_start);
    }
    EXPECT_NEAR(largest, kinetic_start, 0.05 * kinetic_start);
    EXPECT_NEAR(bar.nodes.record[0].velocity[0], -bar.nodes.record[1].velocity[0], 1e-12);
    EXPECT_NEAR(bar.block.kernel.sample(bar.block, bar.nodes, 0, true).internal_energy, internal,
                1e-4 * kinetic_start);
  }
}

TEST(ToyElement, WithoutLengthIsRefusedInItsOwnWords) {
  Nodes nodes(2, false);
  Block block = make_block("bar", ToySpring{}, steel, Precision::double_precision, std::vector<int>{0, 1});
  try {
    block.kernel.initialize(block, nodes);
    FAIL() << "a bar without length was taken";
  } catch (const std::invalid_argument& fault) {
    EXPECT_NE(std::string(fault.what()).find("has no length"), std::string::npos) << fault.what();
  }
}

}  // namespace
}  // namespace brio
