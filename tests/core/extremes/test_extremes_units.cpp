// Units that differ by powers of two: the same bits, for each kind of element, with erosion, and all kinds in
// contact.

#include <gtest/gtest.h>

#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

void expect_same_bits(const Watched& reference, const Watched& other, const Units& u) {
  ASSERT_EQ(reference.model.step, other.model.step);
  EXPECT_EQ(reference.contacts, other.contacts);
  EXPECT_EQ(reference.active, other.active);
  EXPECT_EQ(reference.deleted, other.deleted);
  const Nodes &a = reference.model.nodes, &b = other.model.nodes;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(a.record[i].position[axis] * u.length, b.record[i].position[axis]) << i;
      ASSERT_EQ(a.record[i].velocity[axis] * u.speed(), b.record[i].velocity[axis]) << i;
      if (a.has_rotations()) {
        ASSERT_EQ(a.angular_velocity[i].component[axis] / u.time, b.angular_velocity[i].component[axis]) << i;
      }
    }
  const auto energies = [](const Model& model) {
    const EnergyBalance& energy = model.energy;
    return std::array{energy.kinetic,           energy.internal,          energy.hourglass,
                      energy.viscous,           energy.deleted,           energy.external.at_step(),
                      energy.contact.at_step(), energy.friction.at_step()};
  };
  auto expected = energies(reference.model);
  for (double& energy : expected) energy *= u.energy();
  EXPECT_EQ(expected, energies(other.model));
}

void expect_same_bits_in_all_units(const Deck& deck) {
  const Watched reference(deck);
  EXPECT_GT(reference.touched(), 0);
  for (const Units& u : powers_of_two) {
    SCOPED_TRACE(testing::Message() << u.length << ' ' << u.time << ' ' << u.mass);
    expect_same_bits(reference, Watched(in_units(deck, u)), u);
  }
}

class ExtremesUnits : public testing::TestWithParam<Kind> {};

TEST_P(ExtremesUnits, ImpactOnAnElasticBlockIsTheSameBits) {
  const FloatingPointTraps traps;
  Deck deck = impact(GetParam(), Kind::hex8);
  deck.time.end = 0x1p-8;
  expect_same_bits_in_all_units(deck);
}

TEST_P(ExtremesUnits, ImpactOnAnotherOfItsKindThatYieldsIsTheSameBits) {
  const FloatingPointTraps traps;
  Deck deck = impact(GetParam(), GetParam(), tough());
  deck.time.end = 0x1p-8;
  expect_same_bits_in_all_units(deck);
}

INSTANTIATE_TEST_SUITE_P(EachKind, ExtremesUnits, testing::ValuesIn(all_kinds),
                         [](const auto& kind) { return std::string(name_of_kind(kind.param)); });

TEST(ExtremesUnitsOfScenes, AllKindsAtASheetThatTearsAreTheSameBits) {
  const FloatingPointTraps traps;
  Deck deck = all_kinds_at_once();
  deck.time.end = 0x1p-8;
  const Watched reference(deck);
  EXPECT_GT(reference.model.erosion->total_deleted(), 10);
  expect_same_bits_in_all_units(deck);
}

}  // namespace
}  // namespace brio
