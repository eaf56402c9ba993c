/// Constraints depend on where features are, not on when they were searched for: neither a body far away nor
/// the search margin changes a bit of the others, and the body wakes none of their pairs.

#include <gtest/gtest.h>

#include "src/base/index.hpp"
#include "src/base/parallel.hpp"
#include "tests/core/scene.hpp"

namespace brio::test {
namespace {

struct Course {
  std::uint64_t looked_at = 0, searches = 0;
  double top = 0;  ///< velocity of the last cube
};

// A plate of bricks under a heap of cubes that is thrown at it, and a splinter at a hundred times its speed.
Course course(bool with_splinter, double search_margin = ContactOptions().reach_buffer) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts.push_back(box("plate", {8, 8, 1}, {8, 8, 1}, {0, 0, -0.55}, hex8()));
  int count = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = 0; z <= 1; ++z) {
        const std::string name = "cube" + std::to_string(count++);
        deck.parts.push_back(
            box(name, {1, 1, 1}, {2, 2, 2}, {1.05 * x + 0.2 * z, 1.05 * y, 0.55 + 1.05 * z}, hex8()));
        deck.initial_conditions.push_back(moving(name, {0, 0, -5}));
      }
  if (with_splinter) {
    deck.parts.push_back(box("splinter", {1, 1, 1}, {2, 2, 2}, {0, 0, 100}, hex8()));
    deck.initial_conditions.push_back(moving("splinter", {0, 0, 500}));
  }
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.contact->options.reach_buffer = search_margin;
  deck.time.end = 0.1;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  const ContactScene& contact = model.contacts[0];
  return {contact.proximity.looked_at, contact.pairs.searches(), mean_velocity(model, index(count), 2)};
}

TEST(FarSplinter, WakesNoPairOfOthers) {
  const Course alone = course(false), with = course(true);
  EXPECT_GT(alone.top, -4.9) << "the heap has met the plate";
  EXPECT_EQ(with.top, alone.top);
  EXPECT_LT(static_cast<double>(with.looked_at), 1.05 * static_cast<double>(alone.looked_at));
}

TEST(SearchMargin, ChangesNoBit) {
  const Course usual = course(false);
  for (const double margin : {0.05, 0.5}) {
    const Course other = course(false, margin);
    EXPECT_NE(other.searches, usual.searches) << margin;
    EXPECT_EQ(other.top, usual.top) << margin;
  }
}

}  // namespace
}  // namespace brio::test
