// Resistance of shells to spin about their normal.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "tests/system/program.hpp"

namespace brio {
namespace {

using ProgramDrilling = test::Program;
using ExtremesStripSlow = test::Program;

// A simply supported plate that swings by 0.03 of its thickness; after five periods it should be near its
// place at the start (modes of a Mindlin plate). Free spins of nodes carry the middle of its swing off by a
// tenth of the deflection.
TEST_F(ProgramDrilling, KeepsAPlateSwingingAboutItsPlace) {
  const double largest = 7.03e-4, exact = -9.664e-6;
  std::map<std::string, double> off;
  for (const std::string stiffness : {"0", "0.01"}) {
    const Ending ending =
        brio("run '" BRIO_SOURCE_DIR
             "/inputs/verification/plate.yaml' --threads 1 --output plate --set 'loads.0.gravity=[0,0,1000]'"
             " --set time.end=0.0209604528 --set 'parts.plate.mesh.plate.elements=[16,16]'"
             " --set 'output.history.probes={middle: {point: [0,0,0]}}'"
             " --set parts.plate.element.drilling_stiffness=" +
             stiffness);
    ASSERT_EQ(ending.exit_code, 0) << ending.faults;
    const auto row = last_row("plate/plate.history.csv");
    off[stiffness] = std::abs(row.at("middle.displacement_z") - exact) / largest;
  }
  EXPECT_LT(off["0.01"], 0.02);
  EXPECT_GT(off["0"], 0.05) << "without it, there is something to cure";
}

// A panel that flies, turns and is twisted: what resists takes nothing from momentum.
TEST_F(ProgramDrilling, KeepsMomentumAndEnergy) {
  write("panel.yaml", R"(
materials:
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e7, poissons_ratio: 0.3}
parts:
  panel:
    mesh: {cylinder: {radius: 1, height: 1, elements: [8, 8], arc: 120}}
    element: {type: shell4, thickness: 0.02, drilling_stiffness: 0.1, linear_bulk_viscosity: 0}
    material: rubber
initial_conditions:
  - {part: panel, velocity: [3, 2, 1], spin: {point: [0, 0, 0], angular_velocity: [1, 5, -3]}}
  - {set: panel.top, velocity: [3, 2, 1], spin: {point: [0, 0, 1], angular_velocity: [-4, 2, 9]}}
time: {end: 0.2}
)");
  std::map<std::string, double> error;
  for (const std::string scale : {"0.9", "0.225"}) {
    const Ending ending = brio("run panel.yaml --threads 1 --set time.step_scale=" + scale);
    ASSERT_EQ(ending.exit_code, 0) << ending.faults;
    const auto row = last_row("panel.results/panel.history.csv");
    EXPECT_GT(row.at("step"), 150);
    EXPECT_GT(row.at("hourglass"), 0);
    EXPECT_LT(row.at("linear_imbalance"), 1e-12);
    EXPECT_LT(row.at("angular_imbalance"), 1e-11);
    error[scale] = std::abs(row.at("error_relative"));
  }
  // What is left is the work of a finite step where the velocities jump.
  EXPECT_LT(error["0.225"], 2e-3);
  EXPECT_LT(error["0.225"], 0.25 * error["0.9"]);
}

// Strips of shells as short as thick and shorter, bent to two thirds of their length. Their moments have no
// potential in the nodes' spins: undamped, or soft in torsion, they swing sideways out of rounding and give
// way.
TEST_F(ExtremesStripSlow, StripsOfShortShellsBendWithoutGivingWay) {
  struct Case {
    std::string mesh, force;
  };
  for (const auto& [mesh, force] : {Case{"64,1", "2"}, Case{"128,1", "2"}}) {
    const Ending ending = brio("run '" BRIO_SOURCE_DIR
                               "/inputs/verification/cantilever_end_shear.yaml' --threads 1 --output strip "
                               "--set loads.0.force=[0,0," +
                               force + "] --set 'parts.strip.mesh.plate.elements=[" + mesh +
                               "]' --set 'output.history.probes={tip: {point: [10,0.5,0]}}'");
    ASSERT_EQ(ending.exit_code, 0) << ending.faults;
    const auto row = last_row("strip/cantilever_end_shear.history.csv");
    EXPECT_NEAR(row.at("tip.displacement_z"), 6.70, 0.01) << mesh;
    EXPECT_LT(std::abs(row.at("tip.displacement_y")), 1e-4) << mesh;
    EXPECT_LT(row.at("kinetic"), 1e-6 * row.at("internal")) << mesh;
    EXPECT_LT(row.at("hourglass"), 1e-4 * row.at("internal")) << mesh;
  }
}

}  // namespace
}  // namespace brio
