// Measures enforcement on a plane of contact between two bodies of bricks whose meshes do not match, every
// node on a face of the other: nanoseconds a row for a solve of one iteration, for each further iteration,
// and how many iterations an impact with uneven velocities takes.
//
//     bench_enforcement [REPETITIONS [THREADS [NODES ALONG AN EDGE]]]

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "contact/enforcement/impulse_solver.hpp"

namespace brio {
namespace {

/// Two square grids of n x n nodes, the second turned a little and finer by a few per cent.
struct Plane {
  std::vector<VelocityBlock> blocks;
  ConstraintRows rows;

  Plane(int n, double friction, double height) : n_(n), friction_(friction), height_(height) {
    std::mt19937_64 engine(5);
    std::uniform_real_distribution<double> uneven(-1, 1);
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < n * n; ++k) {
        const double mass = side == 0 ? 1 : 2;
        const double x = 0.1 * uneven(engine);
        const double y = 0.1 * uneven(engine);
        const double z = (side == 0 ? -1 : 0) + 0.3 * uneven(engine);
        blocks.push_back({{x, y, z}, isotropic(1 / mass)});
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (int side = 0; side < 2; ++side) add_row(side, i, j);
  }

 private:
  // The second grid is x' = scale (x turned) + shift; side 0: its node on a face of the second.
  void add_row(int side, int i, int j) {
    const double scale = side == 0 ? 1 / 1.03 : 1.03;
    const double angle = side == 0 ? -0.02 : 0.02;
    const double shift = side == 0 ? -0.37 : 0.37;
    const double x = scale * (std::cos(angle) * i - std::sin(angle) * j) + shift;
    const double y = scale * (std::sin(angle) * i + std::cos(angle) * j) + shift;
    const double column = std::floor(x);
    const double line = std::floor(y);
    if (column < 0 || line < 0 || column > n_ - 2 || line > n_ - 2) return;
    const double u = x - column;
    const double v = y - line;
    const int own = side * n_ * n_ + i + n_ * j;
    const int first = (1 - side) * n_ * n_ + static_cast<int>(column) + n_ * static_cast<int>(line);
    const Vector3d normal{0, 0, side == 0 ? 1.0 : -1.0};
    FaceFoot foot;
    const int corner[4] = {first, first + 1, first + 1 + n_, first + n_};
    const double weight[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    const double along[4] = {v - 1, 1 - v, v, -v};
    const double across[4] = {u - 1, -u, u, 1 - u};
    const Vector3d place[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (int k = 0; k < 4; ++k) {
      foot.block[k] = corner[k];
      foot.weight[k] = weight[k];
    }
    if (height_ != 0) set_gradients(foot, place, along, across);
    rows.add_row(normal, 0, friction_);
    rows.add_point(own, Side::first);
    rows.add_face(foot, height_, Side::second);
  }

  int n_;
  double friction_;
  double height_;
};

template <class Prepare, class Work>
double best_seconds(int repetitions, Prepare&& prepare, Work&& work) {
  double best = 1e300;
  for (int k = 0; k < repetitions; ++k) {
    prepare();
    const auto begin = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    best = std::min(best, elapsed.count());
  }
  return best;
}

void measure(int n, double friction, double height, int repetitions, int threads) {
  const Plane plane(n, friction, height);
  const double rows = static_cast<double>(plane.rows.size());
  ThreadTeam team(threads);
  ImpulseSolver solver;
  Plane trial = plane;
  const auto seconds = [&](const SolveOptions& options) {
    return best_seconds(
        repetitions,
        [&] {
          trial.rows.row = plane.rows.row;
          trial.blocks = plane.blocks;
        },
        [&] { solver.solve(options, trial.rows, trial.blocks, team); });
  };
  const double once = seconds({1, 0});
  const double often = seconds({21, 0});
  const auto iterations = [&](double tolerance) {
    trial.rows.row = plane.rows.row;
    trial.blocks = plane.blocks;
    return solver.solve({1000, tolerance}, trial.rows, trial.blocks, team).iterations;
  };
  const int coarse = iterations(1e-4);
  const int fine = iterations(1e-8);
  fmt::print("{:>8} {:>8.1f} {:>7.2f} {:>10.1f} {:>10.1f} {:>11} {:>11}\n", rows, friction, height,
             1e9 * once / rows, 1e9 * (often - once) / 20 / rows, coarse, fine);
  std::fflush(stdout);
}

}  // namespace
}  // namespace brio

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 10;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  if (repetitions < 1 || threads < 1) {
    fmt::print(stderr, "bench_enforcement: REPETITIONS and THREADS are numbers above zero\n");
    return 2;
  }
  fmt::print("{:>8} {:>8} {:>7} {:>10} {:>10} {:>11} {:>11}\n", "rows", "friction", "height", "one check",
             "iteration", "its to 1e-4", "its to 1e-8");
  std::vector<int> sizes{92, 290};
  if (argc > 3) sizes = {std::atoi(argv[3])};
  for (int n : sizes)
    for (double friction : {0.0, 0.3})
      for (double height : {0.0, 0.05}) brio::measure(n, friction, height, repetitions, threads);
  return 0;
}
