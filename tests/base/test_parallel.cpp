#include <gtest/gtest.h>

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

TEST(ThreadTeam, RangesCoverWithoutOverlap) {
  ThreadTeam team(3);
  std::vector<int> touched(1001, 0);
  team.for_ranges(touched.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++touched[i];
  });
  for (int n : touched) ASSERT_EQ(n, 1);
}

}  // namespace
}  // namespace brio
