// What a deck does not name is not built, not run and not listed.

#include <gtest/gtest.h>

#include <set>

#include "src/output/observe.hpp"
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

TEST(OnlyWhatIsNamed, ContactOfHexahedraWithoutEdgesPairsNone) {
  Deck deck = blocks();
  deck.contact.emplace();
  deck.contact->options.edges = false;
  const Ran ran = run_through(deck);
  EXPECT_EQ(ran.stages, (std::set<std::string>{"elements", "nodes", "contact", "contact_search"}));
  ASSERT_EQ(ran.model.contacts.size(), 1u);
  const ContactScene& scene = ran.model.contacts[0];
  EXPECT_GT(scene.totals.contacts, 0u);
  EXPECT_GT(scene.pairs.node_face.size(), 0u);
  EXPECT_EQ(scene.pairs.edge_edge.size(), 0u);
  EXPECT_TRUE(scene.surface.round.empty());
  EXPECT_FALSE(scene.erosion.has_value());
  expect_only_hexahedra(ran.model);
}

TEST(OnlyWhatIsNamed, ContactOfHexahedraHoldsNoBeamsNorPoints) {
  Deck deck = blocks();
  deck.contact.emplace();
  const Ran ran = run_through(deck);
  EXPECT_EQ(ran.stages, (std::set<std::string>{"elements", "nodes", "contact", "contact_search"}));
  const ContactScene& scene = ran.model.contacts[0];
  EXPECT_GT(scene.pairs.edge_edge.size(), 0u);
  for (const EdgeFeature& edge : scene.features.edge) EXPECT_TRUE(edge.of_face());
  EXPECT_TRUE(scene.surface.round.empty());
  expect_only_hexahedra(ran.model);
}

}  // namespace
}  // namespace brio
