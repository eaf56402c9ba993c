#include <gtest/gtest.h>

#include <new>
#include <utility>
#include <vector>

#include "src/base/parallel.hpp"

namespace brio {
namespace {

TEST(ThreadTeam, RunsEveryTaskOnceForAnyNumberOfThreads) {
  for (int threads : {1, 2, 3, 8}) {
    ThreadTeam team(threads);
    for (std::size_t count : {0u, 1u, 2u, 7u, 1000u}) {
      std::vector<int> runs(count, 0);
      for (int repeat = 0; repeat < 20; ++repeat) team.for_each(count, [&](std::size_t i) { ++runs[i]; });
      for (int n : runs) ASSERT_EQ(n, 20);
    }
  }
}

// More threads than cores, and loops that end at once: threads wake while another loop, of another size, is
// being set up.
TEST(ThreadTeam, ThreadsThatWakeLateTakeNoTaskOfAnotherLoop) {
  for (int threads : {2, 16}) {
    ThreadTeam team(threads);
    std::vector<std::size_t> seen(64);
    for (std::size_t loop = 1; loop <= 100000; ++loop) {
      const std::size_t count = 2 + loop * 7 % 60;
      team.for_each(count, [&](std::size_t i) { seen[i] += i < count ? loop : 1; });
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(std::exchange(seen[i], 0), loop);
    }
  }
}

TEST(ThreadTeam, RangesCoverWithoutOverlap) {
  ThreadTeam team(3);
  std::vector<int> touched(1001, 0);
  team.for_ranges(touched.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++touched[i];
  });
  for (int n : touched) ASSERT_EQ(n, 1);
}

TEST(ThreadTeam, ExceptionOfATaskReachesTheCallerAndTheTeamGoesOn) {
  for (const int threads : {1, 4}) {
    ThreadTeam team(threads);
    for (int repeat = 0; repeat < 100; ++repeat) {
      EXPECT_THROW(team.for_each(50,
                                 [](std::size_t i) {
                                   if (i % 7 == 3) throw std::bad_alloc();
                                 }),
                   std::bad_alloc);
      std::vector<int> runs(50, 0);
      team.for_each(50, [&](std::size_t i) { ++runs[i]; });
      for (const int n : runs) ASSERT_EQ(n, 1);
    }
  }
}

TEST(BackgroundJob, RunsEachJobOnceAndTellsWhatItThrew) {
  int runs = 0;
  {
    BackgroundJob job;
    job.finish();  // of none
    for (int repeat = 1; repeat <= 1000; ++repeat) {
      job.start([&] { ++runs; });
      job.finish();
      ASSERT_TRUE(job.has_ended());
      ASSERT_EQ(runs, repeat);
      if (repeat % 100 != 0) continue;
      job.start([] { throw std::bad_alloc(); });
      EXPECT_THROW(job.finish(), std::bad_alloc);
    }
    job.start([&] { ++runs; });
  }
  EXPECT_EQ(runs, 1001) << "a job that runs is awaited";
}

}  // namespace
}  // namespace brio
