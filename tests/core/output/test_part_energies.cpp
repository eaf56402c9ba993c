// Energies of parts in the history.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "src/output/part_energy_columns.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

Deck cubes_that_collide() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("left", {1, 1, 1}, {3, 2, 2}, {0, 0, 0}, hex8()),
                box("right", {1, 1, 1}, {2, 2, 2}, {1.05, 0.2, 0.1}, hex8()),
                box("block", {1, 1, 1}, {1, 1, 1}, {2.2, 0, 0}, Rigid{})};
  deck.initial_conditions = {moving("left", {20, 0, 0}), moving("block", {0, 3, 0})};
  deck.initial_conditions[1].spin = Spin{{2.2, 0, 0}, {0, 0, 4}};
  deck.contact.emplace();
  deck.time.end = 5e-3;
  deck.output.history.part_energies = true;
  return deck;
}

std::size_t column_of(const Model& model, const std::string& name) {
  const std::vector<std::string> columns = history_columns(model);
  const auto found = std::find(columns.begin(), columns.end(), name);
  EXPECT_NE(found, columns.end()) << name;
  return index(found - columns.begin());
}

TEST(PartEnergies, AreThoseOfTheScene) {
  const Deck deck = cubes_that_collide();
  Model model = build_model(deck);
  ThreadTeam team(1);
  std::vector<double> row;
  double largest = 0;
  run(model, deck, team, [&](Model& now) {
    observe_history(now, row);
    const auto value = [&](const std::string& name) { return row.at(column_of(now, name)); };
    for (const char* kind : {"internal", "hourglass"}) {
      const double sum = value(std::string("left.") + kind) + value(std::string("right.") + kind);
      EXPECT_NEAR(sum, value(kind), 1e-12 * value("total"));
      EXPECT_EQ(value(std::string("block.") + kind), 0);
    }
    double kinetic = 0;
    for (const char* part : {"left", "right", "block"}) kinetic += value(std::string(part) + ".kinetic");
    EXPECT_NEAR(kinetic, now.energy.kinetic_half, 1e-12 * value("total"));
    largest = std::max(largest, value("right.internal"));
  });
  EXPECT_GT(largest, 0.01 * row.at(column_of(model, "total")));
}

TEST(PartEnergies, OfABodyThatFliesAndTurnsIsItsOwn) {
  const Deck deck = cubes_that_collide();
  const Model model = build_model(deck);
  std::vector<double> row;
  add_part_energy_values(model, row);
  const double mass = density(deck.materials[0].second);  // of a unit cube
  EXPECT_NEAR(row.at(0), 0.5 * mass * 400, 1e-9 * mass);
  EXPECT_NEAR(row.at(6), 0.5 * mass * 9 + 0.5 * mass / 6 * 16, 1e-9 * mass);
}

TEST(PartEnergies, AreWrittenOnlyWhereTheDeckAsksForThem) {
  Deck deck = cubes_that_collide();
  deck.output.history.part_energies = false;
  const std::vector<std::string> columns = history_columns(build_model(deck));
  EXPECT_EQ(std::find(columns.begin(), columns.end(), "left.kinetic"), columns.end());
}

}  // namespace
}  // namespace brio
