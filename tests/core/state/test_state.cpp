// A run that was saved and restored goes on with the bits of one that was not interrupted.

#include <gtest/gtest.h>

#include <sstream>

#include "io/run/run_deck.hpp"
#include "tests/core/state/shipped_decks.hpp"

namespace brio::test {

namespace {

void restore(Model& model, const std::string& state) {
  std::istringstream in(state);
  restore_state(model, in, state.size());
}

void make_steps(Model& model, const Deck& deck, int steps, ThreadTeam& team) {
  run(model, deck.numerics.energy_error_limit, team, [steps](Model&) mutable { return steps-- > 0; });
}

/// A model after its first step.
Model started(const Deck& deck, ThreadTeam& team) {
  Model model = build_scene(deck);
  make_steps(model, deck, 0, team);
  return model;
}

// Compared are all numbers of the state, and what is derived from them by one step more.
void expect_same_bits(const Deck& deck, int before, int after, bool deletes = false) {
  ThreadTeam one(1), two(2);
  Model uninterrupted = build_scene(deck);
  make_steps(uninterrupted, deck, before, one);
  const std::string saved = state_of(uninterrupted);
  const std::int64_t deleted = uninterrupted.erosion ? uninterrupted.erosion->total_deleted() : 0;
  make_steps(uninterrupted, deck, after, one);

  Model continued = build_scene(deck);
  restore(continued, saved);
  EXPECT_EQ(state_of(continued), saved);
  make_steps(continued, deck, after, two);
  EXPECT_EQ(continued.times.time, uninterrupted.times.time);
  EXPECT_EQ(continued.energy.sum(), uninterrupted.energy.sum());
  EXPECT_TRUE(state_of(continued) == state_of(uninterrupted)) << "differs after " << after << " steps";
  if (deletes) {
    EXPECT_GT(deleted, 0);
    EXPECT_GT(uninterrupted.erosion->total_deleted(), deleted);
  }
}

}  // namespace

class ShippedDeckState : public testing::TestWithParam<std::string> {};

TEST_P(ShippedDeckState, GoesOnWithTheSameBits) { expect_same_bits(coarse_deck(GetParam(), 3), 100, 100); }

INSTANTIATE_TEST_SUITE_P(Inputs, ShippedDeckState, testing::ValuesIn(shipped_decks()),
                         [](const auto& deck) { return deck.param; });

// Deletion before and after: surfaces, lists of pairs and packed elements are not those of the start.
TEST(State, GoesOnAmongDeletions) { expect_same_bits(coarse_deck("plate_perforation", 3), 205, 150, true); }

TEST(State, DoesNotFitAnotherModel) {
  ThreadTeam team(1);
  const Deck bar = coarse_deck("taylor_bar", 3), can = coarse_deck("can_buckling", 4);
  const std::string state = state_of(started(bar, team));
  Model other = started(can, team);
  EXPECT_THROW(restore(other, state), StateError);
}

TEST(State, IsRefusedWhereItEndsEarly) {
  ThreadTeam team(1);
  const Deck deck = coarse_deck("taylor_bar", 3);
  const std::string state = state_of(started(deck, team));
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, state.size() / 2, state.size() - 1}) {
    Model model = build_scene(deck);
    EXPECT_THROW(restore(model, state.substr(0, size)), StateError) << size << " bytes";
  }
  Model model = build_scene(deck);
  EXPECT_THROW(restore(model, state + "x"), StateError);
}

}  // namespace brio::test
