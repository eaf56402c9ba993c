// What the machine gives: bandwidth of memory (triad a = b + s c, 24 bytes a number) and fused multiply-adds
// in registers, by one thread and by two. Other benches are read beside it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>

#include "apps/bench/options.hpp"
#include "src/base/aligned.hpp"
#include "src/base/lanes.hpp"
#include "src/base/parallel.hpp"

namespace brio {
namespace {

using Clock = std::chrono::steady_clock;

/// Best of the repeats, of units a second.
template <class Work>
double best_rate(int repeats, double units, Work&& work) {
  double best = 0;
  for (int i = 0; i <= repeats; ++i) {  // the first one warms up
    const Clock::time_point start = Clock::now();
    work();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (i > 0) best = std::max(best, units / seconds);
  }
  return best;
}

double triad(int size, int repeats, ThreadTeam& team) {
  const std::size_t count = static_cast<std::size_t>(size) << 17;  // size MiB an array
  constexpr std::size_t a_task = std::size_t{1} << 15;
  AlignedBuffer<double> a(count), b(count), c(count);
  const double bytes = 3.0 * sizeof(double) * static_cast<double>(count);
  return 1e-9 * best_rate(repeats, bytes, [&] {
           team.for_ranges(count, a_task, [&](std::size_t begin, std::size_t end) {
             for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + 3.0 * c[i];
           });
         });
}

template <Floating Real>
double multiply_adds(int repeats, ThreadTeam& team) {
  using T = Lanes<Real>;
  constexpr int chains = 8, rounds = 1 << 16;  // as many as hide the latency of one
  constexpr std::size_t tasks = 64;
  std::array<T, tasks> result;
  result.fill(T(0.0));
  const double operations = 2.0 * tasks * rounds * chains * lane_count<Real>;
  const double rate = 1e-9 * best_rate(repeats, operations, [&] {
                        team.for_each(tasks, [&](std::size_t task) {
                          T sum[chains];
                          std::fill(sum, sum + chains, result[task]);
                          const T factor(0.999), added(1e-3);
                          for (int round = 0; round < rounds; ++round)
#pragma GCC unroll 8
                            for (int k = 0; k < chains; ++k) sum[k] = sum[k] * factor + added;
                          for (const T& one : sum) result[task] += T(1.0 / chains) * one;
                        });
                      });
  return all(result[0] == result[0]) ? rate : 0;  // so that it is computed at all
}

void print(const BenchOptions& options, std::string_view quantity, int threads, double rate) {
  fmt::print(fmt::runtime(options.csv ? "{},{},{:.2f}\n" : "{:<24} {:>7} {:>9.2f}\n"), quantity, threads,
             rate);
}

}  // namespace
}  // namespace brio

int main(int count, char** words) {
  using namespace brio;
  const BenchOptions options = bench_options("bench_machine", {.size = 128, .repeats = 7}, count, words);
  fmt::print(fmt::runtime(options.csv ? "{},{},{}\n" : "{:<24} {:>7} {:>9}\n"), "quantity", "threads",
             "best");
  for (const int threads : {1, 2}) {
    ThreadTeam team(threads);
    print(options, "triad GB/s", threads, triad(options.size, options.repeats, team));
    print(options, "multiply-add double GFLOP/s", threads, multiply_adds<double>(options.repeats, team));
    print(options, "multiply-add float GFLOP/s", threads, multiply_adds<float>(options.repeats, team));
  }
  return 0;
}
