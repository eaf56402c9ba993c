// Several ranks that compute one scene have the bits of one process that computes it alone.

#include <gtest/gtest.h>

#include "io/run/deal_domains.hpp"
#include "io/run/run_deck.hpp"
#include "tests/core/domains/thread_ranks.hpp"
#include "tests/core/state/shipped_decks.hpp"

namespace brio::test {

namespace {

constexpr std::size_t small_domain = 48;  // elements: coarse scenes have several

std::string state_after(const Deck& deck, int steps, Ranks* ranks, int threads) {
  Model model = build_scene(deck);
  cut_domains(model, small_domain);
  if (ranks != nullptr) deal_domains(model, *ranks);
  ThreadTeam team(threads);
  make_steps(model, steps, deck.numerics.energy_error_limit, team);
  exchange_state(model, true);
  return state_of(model);
}

void expect_bits_of_one(const Deck& deck, int steps, int count, int threads) {
  const std::string alone = state_after(deck, steps, nullptr, 1);
  std::vector<std::string> state(index(count));
  run_ranks(count,
            [&](Ranks& ranks) { state[index(ranks.number())] = state_after(deck, steps, &ranks, threads); });
  for (int rank = 0; rank < count; ++rank)
    EXPECT_TRUE(state[index(rank)] == alone) << "rank " << rank << " of " << count;
}

}  // namespace

class ShippedDeckRanks : public testing::TestWithParam<std::string> {};

TEST_P(ShippedDeckRanks, HaveTheBitsOfOneProcess) {
  const Deck deck = coarse_deck(GetParam(), 3);
  expect_bits_of_one(deck, 120, 2, 1);
  expect_bits_of_one(deck, 120, 3, 2);
}

INSTANTIATE_TEST_SUITE_P(Inputs, ShippedDeckRanks, testing::ValuesIn(shipped_decks()),
                         [](const auto& deck) { return deck.param; });

// Deleted elements are listed by the rank that sweeps them and taken out by all.
TEST(Ranks, HaveTheBitsOfOneProcessAmongDeletions) {
  expect_bits_of_one(coarse_deck("plate_perforation", 3), 350, 4, 1);
}

}  // namespace brio::test
