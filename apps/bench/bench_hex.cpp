// Speed of the solid elements: a cube of n^3 distorted bricks in violent motion, whole steps (stress update,
// hourglass control, viscosity, stable step, energies, scatter, motion of the nodes).
//
//     bench_hex [--size N] [--repeats R] [--only WORD,WORD] [--csv]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <string_view>
#include <vector>

#include "apps/bench/options.hpp"
#include "elements/block.hpp"
#include "src/base/index.hpp"
#include "src/domains/sweep_domains.hpp"
#include "src/motion/motion.hpp"

namespace {

using namespace brio;
using Point = Vector3d;

struct Scene {
  Nodes nodes;
  std::vector<Block> blocks;
  SweepSchedule schedule;
  std::vector<SweepResult> results;
  std::vector<KineticEnergy> sums;
  double step = 0;
  std::size_t elements = 0;
};

constexpr double side = 0.01;
constexpr double distortion = 0.075;
constexpr int steps_a_repeat = 10;
constexpr double share_of_stable_step = 0.5;

struct Grid {
  std::vector<Point> position;
  std::vector<int> connectivity;
};

Grid cube_of_bricks(int n) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> noise(-1, 1);
  Grid grid;
  const int m = n + 1;
  const auto id = [m](int i, int j, int k) { return (k * m + j) * m + i; };
  for (int k = 0; k < m; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i)
        grid.position.push_back({side * (i + distortion * noise(generator)),
                                 side * (j + distortion * noise(generator)),
                                 side * (k + distortion * noise(generator))});
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (int corner :
             {id(i, j, k), id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k), id(i, j, k + 1),
              id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)})
          grid.connectivity.push_back(corner);
  return grid;
}

// Elements in the order that runs use, nodes in the order in which elements meet them.
Grid ordered(const Grid& grid) {
  Grid result;
  std::vector<int> new_number(grid.position.size(), -1);
  for (const int e : locality_order(grid.position, grid.connectivity, 8))
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const auto node = index(grid.connectivity[index(e) * 8 + corner]);
      if (new_number[node] < 0) {
        new_number[node] = static_cast<int>(result.position.size());
        result.position.push_back(grid.position[node]);
      }
      result.connectivity.push_back(new_number[node]);
    }
  return result;
}

void sweep(Scene& scene, double step, ThreadTeam& team) {
  const NodalRows forces{scene.nodes.force.data(), scene.nodes.moment.data()};
  sweep_domains(scene.schedule, forces, team, [&](std::size_t t) {
    const SweepTask& task = scene.schedule.tasks[t];
    Block& block = scene.blocks[task.block];
    scene.results[t] = block.kernel.sweep(block, task.chunk, scene.nodes, step);
  });
}

Scene make_scene(const Grid& grid, const Element& element, const Material& material, Precision precision) {
  Scene scene;
  scene.elements = grid.connectivity.size() / 8;
  scene.nodes = Nodes(grid.position.size(), false);
  scene.blocks.push_back(make_block("cube", element, material, precision, grid.connectivity));
  scene.schedule = make_schedule(scene.blocks, grid.position.size());
  scene.results.resize(scene.schedule.tasks.size());
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    NodeRecord& record = scene.nodes.record[i];
    const Point& p = grid.position[i];
    for (std::size_t k = 0; k < 3; ++k) record.position[k] = p[k];
    record.velocity[0] = 60 * std::sin(3 * p[1]) + 10 * noise(generator);
    record.velocity[1] = -40 * std::sin(2 * p[0]);
    record.velocity[2] = -100 * std::cos(4 * p[2]);
  }
  scene.blocks[0].kernel.initialize(scene.blocks[0], scene.nodes);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    scene.nodes.record[i].inverse_mass = 1 / scene.nodes.mass[i];
  ThreadTeam alone(1);
  sweep(scene, 0, alone);
  double stable = HUGE_VAL;
  for (const SweepResult& result : scene.results) stable = std::min(stable, result.stable_step);
  scene.step = share_of_stable_step * stable;
  return scene;
}

double seconds_per_step(Scene& scene, ThreadTeam& team) {
  const auto start = std::chrono::steady_clock::now();
  for (int step = 0; step < steps_a_repeat; ++step) {
    accelerate(scene.nodes, scene.step, scene.sums, team);
    move(scene.nodes, scene.step, team);
    sweep(scene, scene.step, team);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / steps_a_repeat;
}

double bytes_per_element(const Scene& scene) {
  const double nodes =
      static_cast<double>(scene.nodes.size()) * (sizeof(NodeRecord) + sizeof(NodeVector) + sizeof(double));
  const Block& block = scene.blocks[0];
  return (nodes + static_cast<double>(block.state.size() + block.connectivity.size() * sizeof(int))) /
         static_cast<double>(scene.elements);
}

void measure(const BenchOptions& settings, const Grid& grid, std::string_view label, const Element& element,
             const Material& material, Precision precision, int threads) {
  const std::string_view number = precision == Precision::double_precision ? "double" : "float";
  if (!settings.wants(
          fmt::format("{} {} {} {} {}", name_of(element), label, name_of(material), number, threads)))
    return;
  Scene scene = make_scene(grid, element, material, precision);
  ThreadTeam team(threads);
  seconds_per_step(scene, team);
  std::vector<double> seconds;
  for (int repeat = 0; repeat < settings.repeats; ++repeat) seconds.push_back(seconds_per_step(scene, team));
  std::sort(seconds.begin(), seconds.end());
  const double million = static_cast<double>(scene.elements) * 1e-6;
  const double best = million / seconds.front(), median = million / seconds[seconds.size() / 2];
  fmt::print(fmt::runtime(settings.csv ? "{},{},{},{},{},{:.3f},{:.3f},{:.0f}\n"
                                       : "{:<10} {:<13} {:<20} {:<7} {:>7} {:>12.2f} {:>12.2f} {:>10.0f}\n"),
             name_of(element), label, name_of(material), number, threads, best, median,
             bytes_per_element(scene));
}

}  // namespace

int main(int count, char** words) {
  const BenchOptions settings = bench_options("bench_hex", {.size = 64, .repeats = 9}, count, words);
  const Grid grid = ordered(cube_of_bricks(settings.size));
  const Elastic elastic{.density = 7850, .youngs_modulus = 200e9, .poissons_ratio = 0.3};
  const ElasticPlastic plastic{.density = 7850,
                               .youngs_modulus = 200e9,
                               .poissons_ratio = 0.3,
                               .yield_stress = 300e6,
                               .hardening_modulus = 1e9};
  fmt::print(fmt::runtime(settings.csv ? "{},{},{},{},{},{},{},{}\n"
                                       : "{:<10} {:<13} {:<20} {:<7} {:>7} {:>12} {:>12} {:>10}\n"),
             "element", "rate", "material", "number", "threads", "best_Mel/s", "median_Mel/s", "B/element");
  Hex8 jaumann, green_naghdi;
  jaumann.objective_rate = ObjectiveRate::jaumann;
  for (const int threads : {1, 2})
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
      measure(settings, grid, "jaumann", jaumann, elastic, precision, threads);
      measure(settings, grid, "jaumann", jaumann, plastic, precision, threads);
      measure(settings, grid, "green_naghdi", green_naghdi, elastic, precision, threads);
      measure(settings, grid, "green_naghdi", green_naghdi, plastic, precision, threads);
    }
  return 0;
}
