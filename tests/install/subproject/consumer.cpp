// A sum by a team of threads.

#include <atomic>

#include "src/base/parallel.hpp"

int main() {
  brio::ThreadTeam team(2);
  std::atomic<std::size_t> sum = 0;
  team.for_each(100, [&](std::size_t i) { sum += i; });
  return sum == 4950 ? 0 : 1;
}
