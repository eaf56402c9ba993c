// Speed of the shell element: a wavy sheet of n^2 distorted shells in motion, whole steps (stress update at
// the points through the thickness, hourglass control, stable step, energies, scatter, motion and turning of
// the nodes).
//
//     bench_shell [--size N] [--repeats R] [--only WORD,WORD] [--csv]
//
// The slow sheet stays elastic; in the fast one most points yield.

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

struct Scene {
  Nodes nodes;
  std::vector<Block> blocks;
  SweepSchedule schedule;
  std::vector<SweepResult> results;
  std::vector<KineticEnergy> sums;
  double step = 0;
  double energy_at_start = 0;
  double work = 0;
};

constexpr double side = 0.01;
constexpr double thickness = 0.001;
constexpr double distortion = 0.05;
constexpr int steps_a_repeat = 10;
constexpr double share_of_stable_step = 0.5;

double kinetic_energy(const Nodes& nodes) {
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (double v : nodes.record[i].velocity) sum += 0.5 * nodes.mass[i] * v * v;
    for (std::size_t k = 0; k < 3; ++k)
      sum += 0.5 * nodes.rotational_inertia[i] * square(nodes.angular_velocity[i].component[k]);
  }
  return sum;
}

void sweep(Scene& scene, double step, ThreadTeam& team) {
  const NodalRows forces{scene.nodes.force.data(), scene.nodes.moment.data()};
  sweep_domains(scene.schedule, forces, team, [&](std::size_t t) {
    const SweepTask& task = scene.schedule.tasks[t];
    Block& block = scene.blocks[task.block];
    scene.results[t] = block.kernel.sweep(block, task.chunk, scene.nodes, step);
  });
  for (const SweepResult& result : scene.results)
    scene.work += result.internal_energy + result.hourglass_energy + result.viscous_energy;
}

Scene sheet(int n, double speed, const Shell4& shell, const Material& material, Precision precision) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> noise(-1, 1);
  std::vector<int> connectivity;
  const int m = n + 1;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (const int node : {j * m + i, j * m + i + 1, (j + 1) * m + i + 1, (j + 1) * m + i})
        connectivity.push_back(node);
  Scene scene;
  scene.nodes = Nodes(index(m) * index(m), true);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      NodeRecord& node = scene.nodes.record[index(j) * index(m) + index(i)];
      const double x = side * (i + distortion * noise(generator));
      const double y = side * (j + distortion * noise(generator));
      node.position[0] = x;
      node.position[1] = y;
      node.position[2] = 0.3 * std::sin(2 * x) * std::cos(1.5 * y);
      node.velocity[0] = 0.3 * speed * std::sin(2 * y);
      node.velocity[1] = 0.2 * speed * std::sin(1.5 * x);
      node.velocity[2] = speed * std::sin(5 * x) * std::cos(4 * y);
    }
  scene.blocks.push_back(make_block("sheet", shell, material, precision, connectivity));
  scene.schedule = make_schedule(scene.blocks, scene.nodes.size());
  scene.results.resize(scene.schedule.tasks.size());
  scene.blocks[0].kernel.initialize(scene.blocks[0], scene.nodes);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    scene.nodes.record[i].inverse_mass = 1 / scene.nodes.mass[i];
    scene.nodes.angular_velocity[i].component[3] = 1 / scene.nodes.rotational_inertia[i];
  }
  scene.energy_at_start = kinetic_energy(scene.nodes);
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
  const double nodes = static_cast<double>(scene.nodes.size()) *
                       (sizeof(NodeRecord) + 3 * sizeof(NodeVector) + 2 * sizeof(double));
  const Block& block = scene.blocks[0];
  return (nodes + static_cast<double>(block.state.size() + block.connectivity.size() * sizeof(int))) /
         static_cast<double>(block.element_count);
}

/// Share of the elements in which a point has yielded.
double plastic_share(const Scene& scene) {
  const Block& block = scene.blocks[0];
  std::size_t count = 0;
  for (std::size_t e = 0; e < block.element_count; ++e)
    count += block.kernel.sample(block, scene.nodes, e, false).named("equivalent_plastic_strain") > 0;
  return static_cast<double>(count) / static_cast<double>(block.element_count);
}

void measure(const BenchOptions& settings, double speed, const Shell4& shell, const Material& material,
             Precision precision, int threads) {
  const std::string_view number = precision == Precision::double_precision ? "double" : "float";
  const std::string_view sheet_name = speed < 100 ? "slow" : "fast";
  if (!settings.wants(fmt::format("{} {} {} {}", name_of(material), sheet_name, number, threads))) return;
  Scene scene = sheet(settings.size, speed, shell, material, precision);
  ThreadTeam team(threads);
  seconds_per_step(scene, team);
  std::vector<double> seconds;
  seconds.reserve(index(settings.repeats));
  for (int repeat = 0; repeat < settings.repeats; ++repeat) seconds.push_back(seconds_per_step(scene, team));
  std::sort(seconds.begin(), seconds.end());
  const double million = static_cast<double>(scene.blocks[0].element_count) * 1e-6;
  const double energy = (kinetic_energy(scene.nodes) + scene.work) / scene.energy_at_start;
  fmt::print(fmt::runtime(settings.csv
                              ? "{},{},{},{},{:.2f},{:.3f},{:.3f},{:.0f},{:.4f}\n"
                              : "{:<20} {:>6} {:<7} {:>7} {:>8.2f} {:>12.2f} {:>12.2f} {:>10.0f} {:>8.4f}\n"),
             name_of(material), shell.thickness_points, number, threads, plastic_share(scene),
             million / seconds.front(), million / seconds[seconds.size() / 2], bytes_per_element(scene),
             energy);
}

}  // namespace

int main(int count, char** words) {
  const BenchOptions settings = bench_options("bench_shell", {.size = 512, .repeats = 9}, count, words);
  const Elastic elastic{.density = 7850, .youngs_modulus = 200e9, .poissons_ratio = 0.3};
  const ElasticPlastic plastic{.density = 7850,
                               .youngs_modulus = 200e9,
                               .poissons_ratio = 0.3,
                               .yield_stress = 300e6,
                               .hardening_modulus = 1e9};
  const PowerLawHardening power{.density = 7850,
                                .youngs_modulus = 200e9,
                                .poissons_ratio = 0.3,
                                .yield_stress = 300e6,
                                .hardening_constant = 500e6,
                                .hardening_exponent = 0.3};
  fmt::print(fmt::runtime(settings.csv ? "{},{},{},{},{},{},{},{},{}\n"
                                       : "{:<20} {:>6} {:<7} {:>7} {:>8} {:>12} {:>12} {:>10} {:>8}\n"),
             "material", "points", "number", "threads", "plastic", "best_Mel/s", "median_Mel/s", "B/element",
             "energy");
  Shell4 shell;
  shell.thickness = thickness;
  constexpr double slow = 5, fast = 200;
  for (const int threads : {1, 2})
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
      measure(settings, slow, shell, elastic, precision, threads);
      measure(settings, slow, shell, plastic, precision, threads);
      measure(settings, fast, shell, plastic, precision, threads);
      measure(settings, fast, shell, power, precision, threads);
    }
  return 0;
}
