// Speed of particles: a cube of n^3 in both kernels, that flies freely or whose particles are stirred, so
// that neighbours are searched for again and again. Whole steps without output.
//
//     bench_particle [--size N] [--repeats R] [--only WORD,WORD] [--csv]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string_view>
#include <vector>

#include "apps/bench/options.hpp"
#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/step/advance.hpp"

namespace {

using namespace brio;

constexpr double spacing = 0.01;
constexpr std::int64_t steps_a_repeat = 10;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Mesh cube(int n) {
  Mesh mesh;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) mesh.position.push_back({spacing * i, spacing * j, spacing * k});
  mesh.nodes_per_element = 1;
  mesh.connectivity.resize(mesh.position.size());
  std::iota(mesh.connectivity.begin(), mesh.connectivity.end(), 0);
  mesh.volume.assign(mesh.position.size(), spacing * spacing * spacing);
  return mesh;
}

Model model_of(int n, ParticleFrame kernel, int threads) {
  Deck deck;
  deck.materials = {{"material", ElasticPlastic{.density = 1000,
                                                .youngs_modulus = 1e9,
                                                .poissons_ratio = 0.3,
                                                .yield_stress = 1e6,
                                                .hardening_modulus = 1e7}}};
  Part part;
  part.name = "particles";
  part.element = Particle{.kernel = kernel};
  part.material = "material";
  deck.parts = {part};
  deck.time.end = 1e3;
  const std::vector<Mesh> meshes{cube(n)};
  return build(deck, meshes, threads);
}

/// At a twentieth of the speed of sound, in eddies of a few spacings.
void stir(Nodes& nodes) {
  constexpr double speed = 50, wave = 1.2 / spacing;
  for (NodeRecord& node : nodes.record) {
    const double* x = node.position;
    node.velocity[0] = speed * std::sin(wave * x[1]);
    node.velocity[1] = speed * std::sin(wave * x[2]);
    node.velocity[2] = speed * std::sin(wave * x[0]);
  }
}

void measure(const BenchOptions& settings, ParticleFrame frame, bool is_stirred, int threads) {
  const std::string_view kernel = frame == ParticleFrame::eulerian ? "eulerian" : "total_lagrangian";
  const std::string_view motion = is_stirred ? "stirred" : "free";
  if (!settings.wants(fmt::format("{} {} {}", kernel, motion, threads))) return;
  const double begin = seconds();
  Model model = model_of(settings.size, frame, threads);
  const auto count = static_cast<double>(model.nodes.size());
  const double start = 1e6 * (seconds() - begin) / count;
  if (is_stirred) stir(model.nodes);
  ThreadTeam team(threads);
  std::vector<double> times;
  for (int repeat = 0; repeat <= settings.repeats; ++repeat) {
    const double before = seconds();
    run(model, 1e3, team, [until = model.step + steps_a_repeat](Model& now) { return now.step < until; });
    times.push_back((seconds() - before) / static_cast<double>(steps_a_repeat));
  }
  times.erase(times.begin());  // to warm up
  std::sort(times.begin(), times.end());
  const double million = 1e-6 * count;
  fmt::print(fmt::runtime(settings.csv ? "{},{},{},{:.3f},{:.3f},{:.1f}\n"
                                       : "{:<17} {:<8} {:>7} {:>12.2f} {:>12.2f} {:>12.1f}\n"),
             kernel, motion, threads, million / times.front(), million / times[times.size() / 2], start);
}

}  // namespace

int main(int count, char** words) {
  const BenchOptions settings = bench_options("bench_particle", {.size = 30, .repeats = 5}, count, words);
  fmt::print(fmt::runtime(settings.csv ? "{},{},{},{},{},{}\n" : "{:<17} {:<8} {:>7} {:>12} {:>12} {:>12}\n"),
             "kernel", "motion", "threads", "best_M/s", "median_M/s", "start_us");
  for (const int threads : {1, 2})
    for (const ParticleFrame frame : {ParticleFrame::total_lagrangian, ParticleFrame::eulerian})
      for (const bool is_stirred : {false, true}) measure(settings, frame, is_stirred, threads);
  return 0;
}
