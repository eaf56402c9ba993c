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

/// A bar that is fixed at one end, pulled at the other and pressed from the side.
Deck pressed_bar() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("bar", {20, 2, 2}, {40, 4, 4}, {0, 0, 0}, hex8())};
  deck.boundary_conditions = {fix("bar.xmin", {0, 1, 2})};
  deck.initial_conditions = {moving("bar", {1, 2, 3})};
  NodalForce pull;
  pull.where.set = "bar.xmax";
  pull.force = {100, 0, 0};
  deck.loads = {pull, Pressure{"bar.ymax", Curve{{{0, 0}, {1, 1e6}}}}};
  deck.time.end = 1;
  return deck;
}

TEST(Ranks, KnowTheNodesOfTheirDomainsAloneWhereNothingElseIsNeeded) {
  Model model = build_model(pressed_bar());
  cut_domains(model, small_domain);
  ASSERT_EQ(model.schedule.domain_count(), 8u);
  std::vector<std::size_t> known(4, 0);
  run_ranks(4, [&](Ranks& ranks) {
    Model own = model;
    deal_domains(own, ranks);
    ASSERT_EQ(own.nodes.ranks, &ranks);
    for (const NodeRange& range : own.nodes.ranges)
      if (ranks.is_own(range.rank)) known[index(ranks.number())] += range.end - range.begin;
    for (const NodeRange& run : own.nodes.followed) known[index(ranks.number())] += run.end - run.begin;
  });
  // A quarter of 41 layers of 25 nodes, the border, both ends and one side.
  for (const std::size_t count : known) {
    EXPECT_GE(count, 11u * 25u);
    EXPECT_LE(count, 11u * 25u + 2u * 25u + 41u * 5u);
  }
  for (const int count : {2, 4, 7}) expect_bits_of_one(pressed_bar(), 300, count, 1);
}

// What a sweep found rides with the rows of nodes; where all ranks know all nodes that is all of a step.
TEST(Ranks, ExchangeRowsAndResultsAtOnce) {
  constexpr int steps = 50;
  for (const Deck& deck : {pressed_bar(), coarse_deck("can_buckling", 3)})
    run_ranks(3, [&](Ranks& ranks) {
      Model model = build_scene(deck);
      cut_domains(model, small_domain);
      deal_domains(model, ranks);
      ThreadTeam team(1);
      make_steps(model, steps, deck.numerics.energy_error_limit, team);
      EXPECT_NEAR(static_cast<double>(ranks.traffic(Ranks::Kind::rows).exchanges), steps, 1);
      EXPECT_EQ(ranks.traffic(Ranks::Kind::sums).exchanges > 0, model.contacts.empty());
      EXPECT_EQ(ranks.traffic(Ranks::Kind::results).exchanges, 0);
      EXPECT_GT(ranks.traffic(Ranks::Kind::results).bytes, 0);
      EXPECT_EQ(ranks.traffic(Ranks::Kind::agreement).exchanges, 0);
    });
}

// As often as one likes, to the rank that has least to do or not.
TEST(Ranks, HaveTheBitsOfOneProcessWhenDomainsMove) {
  for (const Deck& deck : {pressed_bar(), coarse_deck("plate_perforation", 3)}) {
    const std::string alone = state_after(deck, 350, nullptr, 1);
    std::vector<std::string> state(3);
    run_ranks(3, [&](Ranks& ranks) {
      Model model = build_scene(deck);
      cut_domains(model, small_domain);
      deal_domains(model, ranks);
      ThreadTeam team(1);
      for (int part = 0; part < 7; ++part) {
        make_steps(model, 50, deck.numerics.energy_error_limit, team);
        std::vector<double> cost = model.schedule.exchange->measured_costs();
        EXPECT_EQ(cost.size(), model.schedule.domain_count());
        EXPECT_GT(*std::ranges::max_element(cost), 0);
        for (std::size_t d = 0; d < cost.size() && part % 2 == 0; ++d)
          cost[d] = static_cast<double>(1 + (7 * d + index(part) * 5) % 9);
        exchange_state(model, true);
        deal_domains(model, ranks, cost);
      }
      state[index(ranks.number())] = state_of(model);
    });
    for (const std::string& of_rank : state) EXPECT_TRUE(of_rank == alone);
  }
}

// Elements that get mass are listed by the rank that sweeps them; all hand it out.
TEST(Ranks, HaveTheBitsOfOneProcessWithMassScaling) {
  Deck deck = pressed_bar();
  deck.time.mass_scaling.emplace();
  deck.time.mass_scaling->step = 5e-4;
  deck.time.mass_scaling->largest_share = 10;
  expect_bits_of_one(deck, 100, 3, 2);
}

// Deleted elements are listed by the rank that sweeps them and taken out by all.
TEST(Ranks, HaveTheBitsOfOneProcessAmongDeletions) {
  expect_bits_of_one(coarse_deck("plate_perforation", 3), 350, 4, 1);
}

}  // namespace brio::test
