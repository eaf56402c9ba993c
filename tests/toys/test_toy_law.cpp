// A law of its own header and one word in the list runs in a shipped element, chosen, packed and swept as
// any.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "elements/block.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

constexpr double step = 1e-3;

ToyMaxwell rubber() {
  return {.density = 1000, .youngs_modulus = 1e6, .poissons_ratio = 0.3, .relaxation_time = 0.02};
}

/// A unit cube that is sheared in one step by a small angle and then held.
struct HeldCube {
  Nodes nodes{8, false};
  Block block;

  HeldCube(const Material& material, Precision precision) {
    std::vector<int> connectivity;
    for (int n = 0; n < 8; ++n) {
      connectivity.push_back(n);
      double* x = nodes.record[index(n)].position;
      x[0] = n % 4 == 1 || n % 4 == 2 ? 1 : 0;
      x[1] = n % 4 >= 2 ? 1 : 0;
      x[2] = n < 4 ? 0 : 1;
    }
    block = make_block("cube", Hex8{}, material, precision, connectivity);
    block.kernel.initialize(block, nodes);
    shear(1e-3);
  }
  void shear(double angle) {
    for (NodeRecord& record : nodes.record) {
      record.velocity[0] = angle * record.position[2] / step;
      record.position[0] += angle * record.position[2];
    }
    sweep();
    for (NodeRecord& record : nodes.record) record.velocity[0] = 0;
  }
  SweepResult sweep() { return block.kernel.sweep(block, {0, 1, 1}, nodes, step); }
  ElementSample sample() const { return block.kernel.sample(block, nodes, 0, true); }
};

TEST(ToyLaw, IsOneOfTheList) {
  EXPECT_EQ(name_of(Material(rubber())), "toy_maxwell");
  EXPECT_EQ(density(rubber()), 1000);
  EXPECT_FALSE(has_failure(rubber()));
  EXPECT_TRUE(accepts(Hex8{}, rubber()));
  EXPECT_FALSE(accepts(ToySpring{}, rubber()));  // which has no update_fibre
  EXPECT_THROW(make_block("bar", ToySpring{}, rubber(), Precision::double_precision, std::vector<int>{0, 1}),
               std::invalid_argument);
}

TEST(ToyLaw, RelaxesByTheTimeStepThatTheSweepTellsIt) {
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    HeldCube cube(rubber(), precision);
    const double tolerance = precision == Precision::double_precision ? 1e-12 : 1e-5;
    const double left = 1 / (1 + step / rubber().relaxation_time);
    const double first = cube.sample().stress.xz;
    EXPECT_NEAR(first, left * 1e6 / 2.6 * 1e-3, 1e-3 * first);
    for (int k = 1; k <= 40; ++k) {
      EXPECT_GT(cube.sweep().stable_step, 0);
      EXPECT_NEAR(cube.sample().stress.xz, first * std::pow(left, k), tolerance * first);
    }
  }
}

TEST(ToyLaw, NamesItsHistoryWhichElementsKnowNothingOf) {
  EXPECT_EQ(history_names_of(rubber()), (std::vector<std::string_view>{"dissipation", "temperature_rise"}));
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    HeldCube cube(rubber(), precision);
    for (int k = 1; k <= 400; ++k) cube.sweep();
    // What is left of the elastic energy 2 G e^2 per volume is nothing; backward Euler loses a little of it.
    const double energy = 0.5 * 1e6 / 2.6 * 1e-6;
    EXPECT_NEAR(cube.sample().named("dissipation"), energy, 0.1 * energy);
    EXPECT_DOUBLE_EQ(cube.sample().named("temperature_rise"), 1e-6 * cube.sample().named("dissipation"));
    EXPECT_TRUE(std::isnan(cube.sample().named("equivalent_plastic_strain")));
  }
}

TEST(ToyLaw, IsTheElasticOneWhereNothingRelaxes) {
  ToyMaxwell stiff = rubber();
  stiff.relaxation_time = 1e30;
  const Elastic elastic{.density = 1000, .youngs_modulus = 1e6, .poissons_ratio = 0.3};
  HeldCube toy(stiff, Precision::double_precision), shipped(elastic, Precision::double_precision);
  EXPECT_NEAR(toy.sample().stress.xz, shipped.sample().stress.xz, 1e-9 * shipped.sample().stress.xz);
}

}  // namespace
}  // namespace brio
