// What a deck does not name is not built, not run and not listed.

#include <gtest/gtest.h>

#include <set>

#include "src/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// A block that falls onto another, edge on edge.
Deck blocks() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("lower", {1, 1, 1}, {2, 2, 2}, {0, 0, 0}, hex8()),
                box("upper", {1, 1, 1}, {2, 2, 2}, {0, 0, 1.0001}, hex8())};
  deck.parts[1].placement.rotate = Rotation{{0, 0, 1}, 45};
  deck.initial_conditions = {moving("upper", {0, 0, -10})};
  deck.time.end = 2e-3;
  return deck;
}

struct Ran {
  Model model;
  std::set<std::string> stages;
};

Ran run_through(const Deck& deck) {
  Ran ran{build_model(deck), {}};
  ThreadTeam team(1);
  run(ran.model, deck, team);
  for (const auto& [stage, seconds] : observe_end(ran.model).wall_s.by_stage) ran.stages.insert(stage);
  return ran;
}

void expect_only_hexahedra(const Model& model) {
  EXPECT_TRUE(model.particle_searches.empty());
  EXPECT_FALSE(model.nodes.has_rotations());
  EXPECT_TRUE(model.nodes.moment.empty());
  EXPECT_TRUE(model.nodes.angular_velocity_before.empty());
  for (const Block& block : model.blocks) EXPECT_FALSE(block.cloud.has_value());
}

TEST(OnlyWhatIsNamed, HexahedraAloneRunElementsAndNodes) {
  const Ran ran = run_through(blocks());
  EXPECT_EQ(ran.stages, (std::set<std::string>{"elements", "nodes"}));
  EXPECT_TRUE(ran.model.contacts.empty());
  EXPECT_TRUE(ran.model.nodes.velocity_before.empty());
  expect_only_hexahedra(ran.model);
}

TEST(OnlyWhatIsNamed, ContactOfHexahedraWithoutEdgesRunsNoLines) {
  Deck deck = blocks();
  deck.contact.emplace();
  deck.contact->options.edges = false;
  const Ran ran = run_through(deck);
  EXPECT_EQ(ran.stages, (std::set<std::string>{"elements", "nodes", "contact", "contact_search"}));
  ASSERT_EQ(ran.model.contacts.size(), 1u);
  const ContactScene& scene = ran.model.contacts[0];
  EXPECT_GT(scene.totals.contacts, 0u);
  EXPECT_FALSE(scene.lines.has_value());
  EXPECT_TRUE(scene.surface.round.empty());
  EXPECT_FALSE(scene.erosion.has_value());
  expect_only_hexahedra(ran.model);
}

// Edges that may meet are lines; nodes of faces are none of them where there are no beams.
TEST(OnlyWhatIsNamed, ContactOfHexahedraHoldsTheirSharpEdgesAlone) {
  Deck deck = blocks();
  deck.contact.emplace();
  const Ran ran = run_through(deck);
  EXPECT_EQ(ran.stages,
            (std::set<std::string>{"elements", "nodes", "contact", "contact_search", "contact_lines"}));
  const ContactScene& scene = ran.model.contacts[0];
  EXPECT_EQ(scene.lines->candidates.line.size(), 2u * 12 * 2);
  for (const Line& line : scene.lines->candidates.line) EXPECT_EQ(line.kind, LineKind::solid_edge);
  EXPECT_TRUE(scene.surface.round.empty());
  expect_only_hexahedra(ran.model);
}

}  // namespace
}  // namespace brio
