#pragma once
/// Runs whose results others begin with: decks, and what is compared.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/deck/read_deck.hpp"
#include "io/results/read_result.hpp"
#include "io/run/run_deck.hpp"
#include "io/yaml/deck_error.hpp"

namespace brio::test {

namespace fs = std::filesystem;

class InitialState : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) /
             (std::string("initial_state_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  /// Runs a deck; its result is NAME.vtkhdf beside it.
  RunOutcome run(const std::string& name, const std::string& text) const {
    RunOptions options;
    options.deck = write(name + ".yaml", text);
    options.output = folder;
    options.overwrite = true;
    RunOutcome outcome = run_deck(options);
    EXPECT_EQ(outcome.summary.exit_code, 0) << outcome.message;
    return outcome;
  }
  Model build(const std::string& name, const std::string& text) const {
    return build_scene(read_deck(write(name + ".yaml", text)));
  }
  std::string fault_of(const std::string& text) const {
    try {
      build("new", text);
    } catch (const DeckError& fault) {
      std::string said = fault.what();
      for (std::size_t at; (at = said.find(folder.string() + "/")) != std::string::npos;)
        said.erase(at, folder.string().size() + 1);
      return said;
    }
    return "no fault";
  }
  ReadField field(const std::string& name, const std::string& what) const {
    const ResultReader reader(folder / (name + ".vtkhdf"));
    return reader.field(what, reader.times().size() - 1);
  }

  fs::path folder;
};

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = a.size() == b.size() ? 0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}
inline double largest(const std::vector<double>& a) {
  return largest_difference(a, std::vector<double>(a.size()));
}

inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) return "'" + from + "' is not there";
  return text.replace(at, from.size(), to);
}

// ---- a block that is pressed, with its supports moved in, and held

inline const std::string steel = R"(
materials:
  steel: {model: elastic_plastic, density: 7800, youngs_modulus: 2e11, poissons_ratio: 0.3, yield_stress: 2e8,
          hardening_modulus: 1e9}
)";
inline const std::string block = R"(
parts:
  block: {mesh: {box: {size: [0.3, 0.2, 0.2], elements: [6, 4, 4]}}, element: ELEMENT, material: steel}
)";
// Uniform compression between four smooth walls, beyond yield, relaxed.
inline const std::string pressing = steel + block + R"(
boundary_conditions:
  - {set: block.xmin, fix: [x]}
  - {set: block.xmax, displacement: {x: [[0, 0], [4e-4, -6e-4]]}}
  - {set: block.ymin, fix: [y]}
  - {set: block.zmin, fix: [z]}
loads: []
time: {end: 4e-3}
output: {fields: {times: [1e-3, 4e-3], variables: [default, state]}}
)";
inline const std::string held = steel + block + R"(
boundary_conditions:
  - {set: block.xmin, fix: [x]}
  - {set: block.xmax, fix: [x]}
  - {set: block.ymin, fix: [y]}
  - {set: block.zmin, fix: [z]}
initial_conditions:
  - {part: block, from: {result: pressing.vtkhdf, fields: [positions, state]}}
time: {end: 3e-4}
output: {fields: {times: [3e-4], variables: [default, state]}}
)";

}  // namespace brio::test
