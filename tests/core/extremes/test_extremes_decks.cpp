// Decks that come with Brio, shortened, where an invalid operation, a division by zero or an overflow stops
// the program.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "io/run/run_deck.hpp"
#include "tests/core/floating_point_traps.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

double quotient(std::atomic<double>& below) { return 1 / below.load(); }

TEST(ExtremesTrapsDeathTest, StopTheCallerAndEveryThreadStartedLater) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  std::atomic<double> zero = 0;
  EXPECT_GT(quotient(zero), 1e308) << "no trap without the guard";
  EXPECT_DEATH(
      {
        const FloatingPointTraps traps;
        std::printf("%g", quotient(zero));
      },
      "");
  EXPECT_DEATH(
      {
        const FloatingPointTraps traps;
        ThreadTeam team(2);
        std::atomic<int> caller_waits = 1;
        const auto caller = std::this_thread::get_id();
        team.for_each(2, [&](std::size_t) {
          if (std::this_thread::get_id() != caller) {
            std::printf("%g", quotient(zero));
            caller_waits = 0;
          } else {
            while (caller_waits != 0) std::this_thread::yield();
          }
        });
      },
      "");
}

struct Shortened {
  const char* name;
  std::vector<std::string> overrides;
};

void run_with_traps(const Shortened& shortened) {
  SCOPED_TRACE(shortened.name);
  const FloatingPointTraps traps;
  Model model;
  const Deck deck = load_deck(std::string(BRIO_SOURCE_DIR "/inputs/") + shortened.name + ".yaml",
                              shortened.overrides, 2, model);
  ThreadTeam team(2);
  run(model, deck, team);
  EXPECT_EQ(model.times.time, deck.time.end);
  EXPECT_LT(model.energy.error_max, 0.02);
}

TEST(ExtremesShippedDecks, OfSolidsRunWithTraps) {
  for (const Shortened& deck :
       {Shortened{"bar_impact", {}}, Shortened{"taylor_bar", {"time.end=5e-6"}},
        Shortened{"taylor_bar", {"time.end=5e-6", "numerics.precision=float"}},
        Shortened{"taylor_bar_johnson_cook", {"time.end=5e-6", "parts.bar.mesh.rod.elements=[8,40]"}},
        Shortened{"torn_bar", {"time.end=1e-4", "parts.bar.mesh.box.elements=[20,4,4]"}},
        Shortened{"plate_perforation", {"time.end=2e-5", "parts.plate.mesh.box.elements=[30,30,2]"}},
        Shortened{"brick_stack", {"time.end=5e-4"}}, Shortened{"resting_stack", {"time.end=0.02"}}})
    run_with_traps(deck);
}

TEST(ExtremesShippedDecks, OfShellsAndBeamsRunWithTraps) {
  for (const Shortened& deck :
       {Shortened{"can_buckling", {"time.end=1e-3", "parts.can.mesh.cylinder.elements=[32,20]"}},
        Shortened{"can_buckling",
                  {"time.end=5e-4", "parts.can.mesh.cylinder.elements=[32,20]", "numerics.precision=float"}},
        Shortened{"can_buckling_solid", {"time.end=5e-4", "parts.can.mesh.tube.elements=[32,20,1]"}},
        Shortened{"net", {"time.end=6e-3"}}})
    run_with_traps(deck);
}

TEST(ExtremesShippedDecks, OfParticlesRunWithTraps) {
  for (const Shortened& deck :
       {Shortened{"bird_strike", {"time.end=1e-3", "parts.bird.mesh.particles.cylinder.spacing=0.02"}},
        Shortened{"rubber_rings", {"time.end=3e-4"}}, Shortened{"taylor_bar_particles", {"time.end=3e-6"}}})
    run_with_traps(deck);
}

TEST(ExtremesShippedDecksSlow, PipeIsCutWithTraps) {
  run_with_traps({"pipe_cutting",
                  {"time.end=1.2e-3", "parts.pipe.mesh.tube.elements=[24,16,2]",
                   "parts.blade.mesh.wedge.elements=[2,3,24]", "parts.left.mesh.tube.elements=[48,2,1]",
                   "parts.right.mesh.tube.elements=[48,2,1]"}});
}

}  // namespace
}  // namespace brio
