// What a law names of its history is in the samples of every element that takes the law.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "elements/block.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

JohnsonCook hot_steel() {
  JohnsonCook steel{.density = 7800,
                    .youngs_modulus = 200e9,
                    .poissons_ratio = 0.3,
                    .yield_stress = 400e6,
                    .hardening_constant = 500e6,
                    .hardening_exponent = 0.3};
  steel.thermal = ThermalSoftening{.specific_heat = 450,
                                   .melting_temperature = 1800,
                                   .reference_temperature = 300,
                                   .initial_temperature = 350};
  return steel;
}

ElementSample sample_at_start(const Element& element, const Material& material) {
  Nodes nodes(8, has_rotations(element));
  std::vector<int> connectivity;
  for (int n = 0; n < nodes_per_element(element); ++n) connectivity.push_back(n);
  for (int n = 0; n < 8; ++n) {
    double* x = nodes.record[index(n)].position;
    x[0] = n % 4 == 1 || n % 4 == 2 ? 1 : 0;
    x[1] = n % 4 >= 2 ? 1 : 0;
    x[2] = n < 4 ? 0 : 1;
  }
  Block block = make_block("part", element, material, Precision::double_precision, connectivity);
  block.kernel.initialize(block, nodes);
  return block.kernel.sample(block, nodes, 0, true);
}

std::vector<Element> elements() {
  Beam2 beam;
  beam.section = CircleSection{.radius = 0.1};
  return {Hex8{}, Hex8Full{}, Shell4{.thickness = 0.1}, beam};
}

TEST(NamedHistory, IsInTheSamplesOfAnyElement) {
  for (const Element& element : elements()) {
    const ElementSample sample = sample_at_start(element, hot_steel());
    EXPECT_EQ(sample.named("temperature"), 350) << name_of(element);
    EXPECT_EQ(sample.named("equivalent_plastic_strain"), 0) << name_of(element);
    EXPECT_TRUE(std::isnan(sample.named("damage"))) << name_of(element);
    EXPECT_EQ(sample.named("damage", 0), 0) << name_of(element);
  }
}

TEST(NamedHistory, HoldsDamageWhereTheMaterialFails) {
  JohnsonCook brittle = hot_steel();
  using Names = std::vector<std::string_view>;
  EXPECT_EQ(history_names_of(brittle), (Names{"equivalent_plastic_strain", "temperature"}));
  brittle.failure = Failure{.strain = 0.1, .opening_strain = 0.1};
  EXPECT_EQ(history_names_of(brittle), (Names{"equivalent_plastic_strain", "temperature", "damage"}));
  for (const Element& element : elements()) {
    const ElementSample sample = sample_at_start(element, brittle);
    EXPECT_TRUE(std::ranges::equal(sample.history_names, history_names_of(brittle)));
    EXPECT_EQ(sample.named("temperature"), 350);
  }
}

TEST(NamedHistory, OfALawThatNamesNoneIsEmpty) {
  const Elastic elastic{.density = 1, .youngs_modulus = 1, .poissons_ratio = 0.3};
  EXPECT_TRUE(sample_at_start(Hex8{}, elastic).history_names.empty());
}

}  // namespace
}  // namespace brio
