// Dumps have the times that were asked for, whatever the time step.

#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "io/results/read_result.hpp"
#include "io/run/run_deck.hpp"
#include "tests/io/results/result_scene.hpp"

namespace brio {
namespace {

using test::Folder;

constexpr const char* flying_cube = R"(
materials: {steel: {model: elastic, density: 8000, youngs_modulus: 2e11, poissons_ratio: 0.3}}
parts:
  cube: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, element: hex8, material: steel}
initial_conditions: [{part: cube, velocity: [30, -20, 10]}]
time: {end: 7.3e-3}
)";

ResultReader result_of(const Folder& folder, const std::string& output) {
  std::ofstream(folder / "cube.yaml") << flying_cube << output;
  RunOptions options;
  options.deck = folder / "cube.yaml";
  options.output = folder / "results";
  options.overwrite = true;
  return ResultReader(run_deck(options).vtkhdf);
}

void expect_free_flight(const ResultReader& result) {
  const std::vector<double> start = result.field("position", 0).values;
  for (std::size_t dump = 0; dump < result.times().size(); ++dump) {
    const std::vector<double> now = result.field("position", dump).values,
                              moved = result.field("displacement", dump).values;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double way = std::array{30.0, -20.0, 10.0}[i % 3] * result.times()[dump];
      EXPECT_NEAR(now[i], start[i] + way, 1e-14);
      EXPECT_NEAR(moved[i], way, 1e-14);
    }
  }
}

TEST(DumpTimes, AreMultiplesOfTheIntervalAndPositionsThoseOfThen) {
  const Folder folder;
  const ResultReader result = result_of(folder, "output: {fields: {every: 1e-3}}");
  ASSERT_EQ(result.times().size(), 9U);
  for (std::size_t dump = 0; dump < 8; ++dump)
    EXPECT_EQ(result.times()[dump], 1e-3 * static_cast<double>(dump));
  EXPECT_EQ(result.times()[8], 7.3e-3);
  expect_free_flight(result);
}

TEST(DumpTimes, AreThoseOfAList) {
  const Folder folder;
  const ResultReader result = result_of(folder, "output: {fields: {times: [1.234567e-3, 5e-4, 6.6e-3]}}");
  EXPECT_EQ(result.times(), (std::vector<double>{0, 5e-4, 1.234567e-3, 6.6e-3, 7.3e-3}));
  expect_free_flight(result);
}

// From which other runs start: stress and positions are of the same step.
TEST(DumpTimes, WithTheStateAreThoseOfSteps) {
  const Folder folder;
  const ResultReader result =
      result_of(folder, "output: {fields: {every: 1e-3, variables: [default, state]}}");
  ASSERT_EQ(result.times().size(), 9U);
  EXPECT_NE(result.times()[1], 1e-3);
  EXPECT_NEAR(result.times()[1], 1e-3, 1e-4);
  expect_free_flight(result);
}

}  // namespace
}  // namespace brio
