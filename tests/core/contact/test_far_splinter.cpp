/// A body far away changes nothing for the others: neither their pairs nor their results.

#include <gtest/gtest.h>

#include "src/base/index.hpp"
#include "src/base/parallel.hpp"
#include "tests/core/scene.hpp"

namespace brio::test {
namespace {

struct Course {
  std::uint64_t looked_at = 0;
  double top = 0;  ///< velocity of the last cube
};

// A plate of bricks under a heap of cubes that is thrown at it, and a splinter at a hundred times its speed.
Course course(bool with_splinter, double perturbation = 0) {
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
        deck.initial_conditions.push_back(moving(name, {0, 0, -5 * (1 + perturbation)}));
      }
  if (with_splinter) {
    deck.parts.push_back(box("splinter", {1, 1, 1}, {2, 2, 2}, {0, 0, 100}, hex8()));
    deck.initial_conditions.push_back(moving("splinter", {0, 0, 500}));
  }
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 0.06;  // later the heap amplifies what searches at other times pair
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  return {model.contacts[0].proximity.looked_at, mean_velocity(model, index(count), 2)};
}

TEST(FarSplinter, WakesNoPairOfOthers) {
  const Course alone = course(false), with = course(true);
  EXPECT_GT(alone.top, -4.9) << "the heap has met the plate";
  // The heap alone, thrown a little faster, tells how sensitive it is.
  const double spread = std::abs(course(false, 1e-10).top - alone.top);
  EXPECT_NEAR(with.top, alone.top, 1e-3 * std::abs(alone.top) + spread);
  EXPECT_LT(static_cast<double>(with.looked_at), 1.05 * static_cast<double>(alone.looked_at));
}

}  // namespace
}  // namespace brio::test
