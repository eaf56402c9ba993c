/// What one update of each material law costs, in nanoseconds a point: strains below yield, and strains that
/// flow in every step. States stay in the cache, so that arithmetic is measured and not memory.
///
///     bench_material [repeats]

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "materials/material.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

constexpr int packs = 64;
constexpr int steps = 64;
constexpr int preload =
    300;  ///< first increment, in steps: where strains flow, to a plastic strain of a percent

template <class Law, class T>
struct Solid {
  SymmetricTensor<T> stress{};
  typename Law::template History<T> history{};

  BRIO_INLINE void update(const Law& law, T size) {
    const SymmetricTensor<T> strain{size, -0.4 * size, -0.5 * size, 0.3 * size, 0.2 * size, -0.1 * size};
    if constexpr (requires { law.update(strain, stress, history); }) {
      law.update(strain, stress, history);
    } else {
      law.update_from_stretch(isotropic(T(1.0)) + T(steps) * strain, stress, history);
    }
  }
};

template <class Law, class T>
struct Shell {
  ShellTensor<T> stress{};
  typename Law::template History<T> history{};
  T thickness_strain{};

  BRIO_INLINE void update(const Law& law, T size) {
    const ShellTensor<T> strain{size, -0.4 * size, 0.3 * size, 0.02 * size, -0.01 * size};
    law.update_plane_stress(strain, 5.0 / 6.0, stress, history, thickness_strain);
  }
};

template <class Law, class State>
__attribute__((noinline)) void run_steps(const Law& given, std::vector<State>& states, double size) {
  const Law law = given;
  for (int step = 0; step < steps; ++step)
    for (int pack = 0; pack < packs; ++pack)
      states[index(pack)].update(law, size * (1 + pack * (0.3 / packs)));
}

template <class Law, class State>
double nanoseconds(const Law& law, double size, int width, int repeats) {
  double best = HUGE_VAL;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::vector<State> states(packs);
    for (State& state : states) state.update(law, preload * size);
    const auto start = std::chrono::steady_clock::now();
    run_steps(law, states, size);
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    best = std::min(best, taken.count() / (static_cast<double>(packs) * steps * width));
  }
  return best;
}

template <class Law, Floating Real>
void print_row(std::string_view label, const Law& law, int repeats) {
  using T = Lanes<Real>;
  constexpr int width = lane_count<Real>;
  constexpr double below_yield = 2e-6, flowing = 5e-5;
  const std::string_view precision = sizeof(Real) == 8 ? "double" : "float";
  fmt::print("{:<28} {:<7} {:8.2f} {:8.2f}", label, precision,
             nanoseconds<Law, Solid<Law, T>>(law, below_yield, width, repeats),
             nanoseconds<Law, Solid<Law, T>>(law, flowing, width, repeats));
  if constexpr (requires(Shell<Law, T> shell) {
                  law.update_plane_stress(shell.stress, 1.0, shell.stress, shell.history,
                                          shell.thickness_strain);
                })
    fmt::print(" {:8.2f} {:8.2f}", nanoseconds<Law, Shell<Law, T>>(law, below_yield, width, repeats),
               nanoseconds<Law, Shell<Law, T>>(law, flowing, width, repeats));
  fmt::print("\n");
}

template <class Law>
void print_rows(std::string_view label, const Law& law, int repeats) {
  print_row<Law, double>(label, law, repeats);
  print_row<Law, float>(label, law, repeats);
}

}  // namespace
}  // namespace brio

int main(int argc, char** argv) {
  using namespace brio;
  const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 50;
  fmt::print("ns a point and update          precision     solid            plane stress\n");
  fmt::print("{:<36} {:>8} {:>8} {:>8} {:>8}\n", "", "elastic", "plastic", "elastic", "plastic");
  print_rows("elastic", Elastic{7800, 200e9, 0.3}, repeats);
  print_rows("neo_hookean", NeoHookean{7800, 200e9, 0.3}, repeats);
  print_rows("elastic_plastic", ElasticPlastic{7800, 200e9, 0.3, 400e6, 1e9, 0}, repeats);
  print_rows("elastic_plastic, mixed", ElasticPlastic{7800, 200e9, 0.3, 400e6, 1e9, 0.5}, repeats);
  print_rows("power_law_hardening", PowerLawHardening{7800, 200e9, 0.3, 350e6, 600e6, 0.3, 0}, repeats);
  print_rows("power_law_hardening, plateau", PowerLawHardening{7800, 200e9, 0.3, 350e6, 600e6, 0.3, 0.02},
             repeats);
}
