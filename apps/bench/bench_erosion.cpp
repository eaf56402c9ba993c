// What deletion costs a run: a block of N^3 hexahedra lies on a plate; in every step, which does all that a
// step does, some elements of the block are deleted, drawn at random or layer by layer from the top.
//
//     bench_erosion [N = 100] [deletions a step = 100] [steps = 60] [random | front]
//
// Times are of the processor: there is one thread, and the machine may be busy.

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <numeric>
#include <random>
#include <string_view>

#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/step/advance.hpp"
#include "src/step/sweep_stage.hpp"

namespace {

using namespace brio;

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Mesh bricks(std::array<int, 3> cells, double edge, Vector3d lowest) {
  Mesh mesh;
  const auto at = [&](int i, int j, int k) { return i + (cells[0] + 1) * (j + (cells[1] + 1) * k); };
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i)
        mesh.position.push_back({lowest[0] + edge * i, lowest[1] + edge * j, lowest[2] + edge * k});
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i)
        for (int node : {at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1),
                         at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)})
          mesh.connectivity.push_back(node);
  return mesh;
}

Part part(const char* name, bool erodes) {
  Part part;
  part.name = name;
  part.element = Hex8{};
  part.material = "material";
  if (erodes) part.deletion.emplace().inverted = true;
  return part;
}

Model block_on_plate(int cells) {
  Deck deck;
  Elastic law;
  law.density = 1000;
  law.youngs_modulus = 1e9;
  law.poissons_ratio = 0.3;
  deck.materials = {{"material", law}};
  deck.parts = {part("block", true), part("plate", false)};
  InitialCondition fall;
  fall.where.set = "block";
  fall.velocity = {0, 0, -1};
  deck.initial_conditions = {fall};
  deck.contact.emplace();
  deck.time.end = 1;
  const double edge = 1.0 / cells;
  const std::array<Mesh, 2> meshes{
      bricks({cells, cells, cells}, edge, {0, 0, 0}),
      bricks({cells / 2, cells / 2, 2}, 2.1 * edge, {-0.01, -0.01, -4.2001 * edge})};
  return build(deck, meshes);
}

/// Lets the elements at these places go in the next deletion. \param places ascending
void give_up(Model& model, const std::vector<std::size_t>& places) {
  for (std::size_t t = 0; t < model.schedule.tasks.size(); ++t) {
    const SweepTask& task = model.schedule.tasks[t];
    model.sweep_results[t].lost = 0;
    if (task.block != 0) continue;
    Block& block = model.blocks[0];
    const std::size_t first = task.chunk.first_pack * index(block.lanes);
    const auto begin = std::lower_bound(places.begin(), places.end(), first);
    const auto end = std::lower_bound(begin, places.end(), first + task.chunk.element_count);
    for (auto place = begin; place != end; ++place)
      block.lost[first + model.sweep_results[t].lost++] = static_cast<int>(*place);
  }
}

struct Sums {
  double step = 0, deletion = 0, elements = 0, contact = 0;
  int steps = 0;
};

void print(const Sums& sums, const Model& model) {
  std::size_t lanes = 0;
  for (const SweepTask& task : model.schedule.tasks) {
    const auto width = index(model.blocks[task.block].lanes);
    lanes += (task.chunk.element_count + width - 1) / width * width;
  }
  const double per_step = 1e3 / sums.steps;
  fmt::print("{:>9} {:>9} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.2f} {:>7.1f} %\n",
             model.blocks[0].element_count + model.blocks[1].element_count, lanes, per_step * sums.step,
             per_step * sums.elements, per_step * sums.contact, per_step * sums.deletion,
             100 * sums.deletion / sums.step);
}

}  // namespace

int main(int argc, char** argv) {
  const int cells = argc > 1 ? std::atoi(argv[1]) : 100;
  const std::size_t at_once = argc > 2 ? index(std::atoi(argv[2])) : 100;
  const int steps = argc > 3 ? std::atoi(argv[3]) : 60;
  const bool random = argc <= 4 || std::string_view(argv[4]) == "random";
  Model model = block_on_plate(cells);
  ThreadTeam team(1);
  std::vector<int> order(model.parts[0].element_order.size());
  std::iota(order.begin(), order.end(), 0);
  if (random) std::shuffle(order.begin(), order.end(), std::mt19937(1));

  fmt::print("   living     lanes   ms/step  elements   contact  deletion    share\n");
  Sums sums, total;
  std::vector<std::size_t> places;
  const auto stage = [&](Stage of) { return model.stages[of]; };
  for (int step = 0; step < steps; ++step) {
    places.clear();
    for (std::size_t k = 0; k < at_once && !order.empty(); ++k, order.pop_back())
      places.push_back(index(model.parts[0].element_slot[index(order.back())]));
    std::sort(places.begin(), places.end());
    const double elements = stage(Stage::elements);
    const double contact = stage(Stage::contact) + stage(Stage::contact_search);
    const double start = seconds();
    run(model, 1, team, [once = true](Model&) mutable { return std::exchange(once, false); });
    const double stepped = seconds();
    give_up(model, places);
    const double chosen = seconds();
    model.energy += erode_elements(model, team);
    const double end = seconds();
    for (Sums* s : {&sums, &total}) {
      s->step += end - chosen + stepped - start;
      s->deletion += end - chosen;
      s->elements += stage(Stage::elements) - elements;
      s->contact += stage(Stage::contact) + stage(Stage::contact_search) - contact;
      ++s->steps;
    }
    if (sums.steps < std::max(1, steps / 6)) continue;
    print(sums, model);
    sums = {};
  }
  fmt::print("all steps:\n");
  print(total, model);
  const ContactErosion& erosion = *model.contacts[0].erosion;
  const auto deleted = static_cast<double>(model.erosion->total_deleted());
  fmt::print("an element deleted: {:.0f} faces, sides and nodes looked at; {} searches\n",
             static_cast<double>(erosion.topology.visits) / deleted, model.contacts[0].pairs.searches());
  return 0;
}
