// Springs between all nodes of two sets: which nodes they join, and what their stiffness is of.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;
using std::numbers::pi;

constexpr double mounted_mass = 500;  // 1 x 1 x 0.5
constexpr double mount_stiffness = 2e4;

SpringEnd all_of(std::string set) {
  SpringEnd end;
  end.set = NodeSelection{};
  end.set->set = std::move(set);
  return end;
}

/// A rigid block on springs between its left side and the right side of a plate of elements that is held.
Deck mounted(SpringValues values, SpringPairing pairing = SpringPairing::nearest) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("mass", {1, 1, 0.5}, {2, 2, 2}, {0, 0, 0}, Rigid{}),
                box("wall", {0.2, 1, 0.5}, {1, 2, 2}, {-1, 0, 0}, hex8())};
  deck.boundary_conditions = {fix("mass", {1, 2, 3, 4, 5}), fix("wall", {0, 1, 2})};
  deck.initial_conditions = {moving("mass", {0.3, 0, 0})};
  Spring mount{.name = "mount", .from = all_of("mass.xmin"), .to = all_of("wall.xmax")};
  mount.stiffness = mount_stiffness;
  mount.values = values;
  mount.pairing = pairing;
  mount.place = "deck.yaml:7:3";
  deck.springs = {mount};
  deck.time.step = 2e-5;
  return deck;
}

TEST(SpringSets, JoinEachNodeWithTheNearest) {
  const Model model = build_model(mounted(SpringValues::each));
  ASSERT_EQ(model.springs.spring.size(), 9u);
  for (const SpringInRun& spring : model.springs.spring) {
    const double* a = model.nodes.record[index(spring.end[0].node)].position;
    const double* b = model.nodes.record[index(spring.end[1].node)].position;
    EXPECT_EQ(a[1], b[1]);
    EXPECT_EQ(a[2], b[2]);
    EXPECT_NEAR(spring.length, 0.4, 1e-15);
  }
  EXPECT_EQ(model.springs.spring[8].name, "mount.9");
  ASSERT_EQ(model.springs.set.size(), 1u);
  EXPECT_EQ(model.springs.set[0].count, 9u);
  EXPECT_NEAR(model.springs.set[0].shortest, 0.4, 1e-15);
  EXPECT_NEAR(model.springs.set[0].longest, 0.4, 1e-15);
}

// Of meshes that do not match, against all distances.
TEST(SpringSets, JoinNodesOfMeshesThatDoNotMatch) {
  Deck deck = mounted(SpringValues::each);
  deck.parts[0] = box("mass", {1.3, 0.9, 0.7}, {5, 7, 4}, {0.2, 0.1, 0}, Rigid{});
  deck.parts[1] = box("wall", {0.4, 1.1, 0.6}, {3, 8, 5}, {-1, 0, 0.05}, hex8());
  deck.springs[0].from = all_of("mass");
  deck.springs[0].to = all_of("wall");
  const Model model = build_model(deck);
  const auto place = [&](int node) { return vector_at(model.nodes.record[index(node)].position); };
  ASSERT_EQ(model.springs.spring.size(), 6u * 8 * 5);
  for (const SpringInRun& spring : model.springs.spring) {
    double least = 1e9;
    for (const int node : model.parts[1].node)
      least = std::min(least, norm(place(node) - place(spring.end[0].node)));
    EXPECT_EQ(spring.length, least);
  }
}

// A stiffness of each pair acts as often as there are pairs, one in total once.
TEST(SpringSets, OscillateByTheStiffnessOfEachOrInTotal) {
  for (const auto& [values, pairing, pairs] : {std::tuple{SpringValues::each, SpringPairing::nearest, 9.0},
                                               std::tuple{SpringValues::total, SpringPairing::nearest, 1.0},
                                               std::tuple{SpringValues::total, SpringPairing::order, 1.0}}) {
    Deck deck = mounted(values, pairing);
    const double mount_rate = std::sqrt(pairs * mount_stiffness / mounted_mass);
    deck.time.end = 2 * pi / mount_rate;
    Model model = build_model(deck);
    ThreadTeam team(1);
    double error = 0, largest = 0, force = 0;
    const std::vector<std::string> columns = history_columns(model);
    const auto at =
        index(std::find(columns.begin(), columns.end(), "spring.mount.elongation") - columns.begin());
    ASSERT_LT(at + 2, columns.size());
    EXPECT_EQ(columns[at + 1], "spring.mount.force");
    EXPECT_EQ(columns[at + 2], "spring.mount.broken");
    std::vector<double> row;
    run(model, deck, team, [&](Model& m) {
      const double exact = 0.3 / mount_rate * std::sin(mount_rate * m.times.time);
      error = std::max(error, std::abs(m.rigid.body[0].centre[0] - exact));
      observe_history(m, row);
      largest = std::max(largest, std::abs(row[at] - m.rigid.body[0].centre[0]));
      force = std::max(force, std::abs(row[at + 1] - pairs * mount_stiffness * row[at]));
    });
    EXPECT_LE(error, 1e-5 * 0.3 / mount_rate);
    EXPECT_LE(largest, 1e-12);
    EXPECT_LE(force, 1e-9 * mount_stiffness);
  }
}

TEST(SpringSets, BreakOneByOneAtTheirShareOfTheStrength) {
  Deck deck = mounted(SpringValues::total);
  deck.springs[0].strength =
      0.5 * 0.3 * std::sqrt(mount_stiffness * mounted_mass);  // half of the largest force
  const double mount_rate = std::sqrt(mount_stiffness / mounted_mass);
  deck.time.end = 2 / mount_rate;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  for (const SpringInRun& spring : model.springs.spring) EXPECT_TRUE(spring.is_broken);
  EXPECT_NEAR(model.rigid.motion[0].velocity[0], 0.3 * std::sqrt(0.75), 1e-3);
  std::vector<std::string> columns;
  add_columns(model.springs, columns);
  std::vector<double> row;
  add_values(model.springs, row);
  EXPECT_EQ(row, (std::vector<double>{0, 0, 9}));
  EXPECT_EQ(columns.size(), 3u);
}

// A set and one node, as spokes; the table and the dashpot are divided as the stiffness is.
TEST(SpringSets, JoinASetWithOneNode) {
  Deck deck = mounted(SpringValues::total);
  deck.springs[0].pairing.reset();
  deck.springs[0].to = {.point = Vector3d{-0.9, 0, 0}, .part = "wall"};
  deck.springs[0].stiffness = 0;
  deck.springs[0].force = {{-1, -90}, {0, 0}, {1, 9}};
  deck.springs[0].damping = 18;
  const Model model = build_model(deck);
  ASSERT_EQ(model.springs.spring.size(), 9u);
  for (const SpringInRun& spring : model.springs.spring) {
    EXPECT_EQ(spring.end[1].node, model.springs.spring[0].end[1].node);
    EXPECT_NEAR(spring.stiffness, 10, 1e-12);
    EXPECT_NEAR(spring.table.back()[1], 1, 1e-12);
    EXPECT_NEAR(spring.damping, 2, 1e-12);
  }
}

// By numbers in the mesh, whatever the order in memory.
TEST(SpringSets, JoinInTheOrderOfNumbers) {
  const Model model = build_model(mounted(SpringValues::each, SpringPairing::order));
  const auto number = [&](std::size_t part, int node) {
    const std::vector<int>& nodes = model.parts[part].node;
    return std::find(nodes.begin(), nodes.end(), node) - nodes.begin();
  };
  for (std::size_t i = 1; i < 9; ++i)
    for (const std::size_t end : {0u, 1u})
      EXPECT_LT(number(end, model.springs.spring[i - 1].end[end].node),
                number(end, model.springs.spring[i].end[end].node));
}

TEST(SpringSets, OfUnequalSizeAreRefusedInOrder) {
  Deck deck = mounted(SpringValues::each, SpringPairing::order);
  deck.springs[0].to = all_of("wall");
  try {
    build_model(deck);
    ADD_FAILURE() << "it was built";
  } catch (const BuildError& fault) {
    EXPECT_NE(std::string(fault.what()).find("have 9 and 18 nodes"), std::string::npos) << fault.what();
    EXPECT_EQ(fault.place, "deck.yaml:7:3");
  }
}

TEST(SpringSets, SayWhatTheyAccept) {
  Spring spring{.name = "mount", .from = all_of("a.b"), .to = {.point = Vector3d{0, 0, 0}}};
  spring.stiffness = 1;
  EXPECT_EQ(spring.fault(), "");
  spring.pairing = SpringPairing::order;
  EXPECT_NE(spring.fault().find("where both ends are sets"), std::string::npos);
  SpringEnd end = all_of("a.b");
  end.fixed = true;
  EXPECT_NE(end.fault().find("not beside 'set'"), std::string::npos);
  EXPECT_NE(SpringEnd{}.fault().find("either a 'point' or a 'set'"), std::string::npos);
}

}  // namespace
}  // namespace brio
