#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <new>
#include <thread>
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

// Of four tasks the second thread begins with the third, however late it wakes: the first one waits for that,
// and nobody takes the second task before.
TEST(ThreadTeam, ThreadsBeginWithTheSameTasksInEveryLoop) {
  ThreadTeam team(2);
  std::vector<std::thread::id> by(4);
  std::vector<int> turn(4);
  std::thread::id second;
  for (int loop = 0; loop < 50; ++loop) {
    std::atomic<int> started = 0, turns = 0;
    team.for_each(4, [&](std::size_t i) {
      by[i] = std::this_thread::get_id();
      turn[i] = turns++;
      if (i % 2 != 0) return;
      ++started;
      while (started < 2) std::this_thread::yield();
    });
    ASSERT_EQ(by[0], std::this_thread::get_id());
    ASSERT_NE(by[2], by[0]);
    ASSERT_LT(turn[2], turn[1]);
    if (loop > 0) {
      ASSERT_EQ(by[2], second);
    }
    second = by[2];
  }
}

// Who has the first task waits until the others are done, one of which is of the same share: else this never
// ends.
TEST(ThreadTeam, ThreadsThatAreDoneTakeTasksOfOthers) {
  ThreadTeam team(2);
  std::atomic<int> done = 0;
  team.for_each(4, [&](std::size_t i) {
    while (i == 0 && done < 3) std::this_thread::yield();
    ++done;
  });
  EXPECT_EQ(done, 4);
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

TEST(BackgroundJobs, RunInOrderAndTellWhatTheyThrew) {
  std::vector<int> ran;
  {
    BackgroundJobs jobs;
    jobs.finish();  // of none
    for (std::size_t repeat = 0; repeat < 3000; ++repeat) {
      jobs.start([&, repeat] { ran.push_back(static_cast<int>(repeat)); });
      jobs.finish(repeat % 3);
      if (repeat % 3 != 0) continue;
      ASSERT_EQ(ran.size(), repeat + 1);
      ASSERT_TRUE(jobs.have_ended());
    }
    jobs.finish();
    ASSERT_EQ(ran.size(), 3000U);
    EXPECT_TRUE(std::ranges::is_sorted(ran));
  }
  int after = 0;
  {
    BackgroundJobs jobs;
    std::atomic<bool> may_throw = false;
    jobs.start([&] {
      while (!may_throw) std::this_thread::yield();
      throw std::bad_alloc();
    });
    jobs.start([&] { ++after; });
    may_throw = true;
    EXPECT_THROW(jobs.finish(), std::bad_alloc);
    EXPECT_EQ(after, 0) << "what waits behind a job that throws is dropped";
    jobs.start([&] { ++after; });
    jobs.start([&] { ++after; });
  }
  EXPECT_EQ(after, 2) << "jobs that run or wait are awaited";
}

}  // namespace
}  // namespace brio
