#include <gtest/gtest.h>

#include "io/read_deck.hpp"
#include "tests/io/deck_text.hpp"

namespace brio {
namespace {

TEST(Deck, SaysWhatTheTextSays) {
  const Deck deck = parse_deck(plain_deck, "plain.yaml");
  EXPECT_EQ(deck.title, "Two boxes");
  ASSERT_EQ(deck.materials.size(), 1U);
  EXPECT_EQ(deck.materials[0].first, "steel");
  const auto& steel = std::get<Elastic>(deck.materials[0].second);
  EXPECT_EQ(steel.density, 7.34e-4);
  EXPECT_EQ(steel.youngs_modulus, 30e6);
  EXPECT_EQ(steel.poissons_ratio, 0.3);
  ASSERT_EQ(deck.parts.size(), 2U);
  EXPECT_EQ(deck.parts[0].name, "left");
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[0].mesh).elements, (std::array<int, 3>{2, 2, 4}));
  EXPECT_FALSE(deck.parts[0].placement.rotate);
  const auto& tube = std::get<TubeMesh>(deck.parts[1].mesh);
  EXPECT_EQ(tube.outer_radius, 2);
  EXPECT_EQ(deck.parts[1].placement.rotate->degrees, 90);
  EXPECT_EQ(deck.parts[1].placement.translate, (Triple{0, 0, 19}));
  EXPECT_EQ(name_of(deck.parts[1].element), "hex8");
  ASSERT_EQ(deck.initial_conditions.size(), 2U);
  EXPECT_EQ(deck.initial_conditions[0].where.set, "left");
  EXPECT_EQ(deck.initial_conditions[0].velocity, (Triple{0, 0, -5000}));
  EXPECT_EQ(deck.initial_conditions[1].where.set, "right.top");
  EXPECT_EQ(deck.initial_conditions[1].spin->angular_velocity, (Triple{0, 0, 1}));
  EXPECT_EQ(deck.time.end, 3e-3);
  EXPECT_EQ(deck.output.fields_.every, 5e-5);
  EXPECT_EQ(deck.output.history.every, 1e-6);
  EXPECT_EQ(deck.text, plain_deck);
}

TEST(Deck, ConditionsAndLoadsKeepTheirKind) {
  const Deck deck = parse_deck(plain_deck, "plain.yaml");
  ASSERT_EQ(deck.boundary_conditions.size(), 3U);
  const auto& fixed = std::get<PrescribedMotion>(deck.boundary_conditions[0]);
  EXPECT_EQ(fixed.where.set, "left.bottom");
  ASSERT_EQ(fixed.components.size(), 3U);
  EXPECT_EQ(fixed.components[2].axis, 2);
  EXPECT_EQ(fixed.components[2].curve(0.7), 0);
  const auto& driven = std::get<PrescribedMotion>(deck.boundary_conditions[1]);
  EXPECT_EQ(driven.kind, MotionKind::velocity);
  EXPECT_EQ(std::get<PlaneRegion>(driven.where.region).tolerance, 1e-6);
  EXPECT_EQ(driven.where.part, "left");
  EXPECT_DOUBLE_EQ(driven.components[0].curve(5e-4), 2.5);
  EXPECT_EQ(std::get<RigidWall>(deck.boundary_conditions[2]).point, (Triple{0, 0, -3}));
  ASSERT_EQ(deck.loads.size(), 3U);
  EXPECT_EQ(std::get<Gravity>(deck.loads[0]).factor(0.25), 0.25);
  EXPECT_EQ(std::get<NodalForce>(deck.loads[1]).force, (Triple{1, 2, 3}));
  EXPECT_EQ(std::get<NodalForce>(deck.loads[1]).factor(7), 1);
  EXPECT_EQ(std::get<Pressure>(deck.loads[2]).side_set, "right.inside");
  EXPECT_EQ(std::get<Pressure>(deck.loads[2]).pressure(3), 100);
  ASSERT_TRUE(deck.contact);
  EXPECT_TRUE(deck.contact->surfaces.empty());
  EXPECT_EQ(deck.contact->exclude, std::vector<std::string>{"left"});
  EXPECT_EQ(deck.contact->options.friction, 0.1);
}

}  // namespace
}  // namespace brio
