/// What deleting elements costs contact: a block of N^3 hexahedra falls on another; every step some elements
/// at the surface of the upper one go.
///
///     bench_erosion [N = 100] [deletions a step = 100] [steps = 40]

#include <fmt/core.h>

#include <cstdlib>
#include <ctime>
#include <random>

#include "contact/scene.hpp"

namespace {

using namespace brio;
/// Of the processor: there is one thread, and the machine may be busy.
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Block {
  std::vector<int> connectivity;
  std::vector<Vector3<double>> position;
};

void add_block(int cells, double size, double height, Block& block) {
  const int first = static_cast<int>(block.position.size());
  const auto at = [&](int i, int j, int k) { return first + i + (cells + 1) * (j + (cells + 1) * k); };
  for (int k = 0; k <= cells; ++k)
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i)
        block.position.push_back({size * i / cells, size * j / cells, height + size * k / cells});
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i)
        for (int node : {at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1),
                         at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)})
          block.connectivity.push_back(node);
}

}  // namespace

int main(int argc, char** argv) {
  const int cells = argc > 1 ? std::atoi(argv[1]) : 100;
  const int at_once = argc > 2 ? std::atoi(argv[2]) : 100;
  const int steps = argc > 3 ? std::atoi(argv[3]) : 40;
  Block both;
  add_block(cells / 2, 1, -1.0001, both);
  const std::vector<int> below = both.connectivity;
  both.connectivity.clear();
  const std::size_t first_upper = both.position.size();
  add_block(cells, 1, 0, both);
  Nodes nodes(both.position.size(), false);
  nodes.velocity_before = AlignedBuffer<NodeVector>(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto& x = both.position[n];
    NodeRecord& record = nodes.record[n];
    record.position[0] = x.x;
    record.position[1] = x.y;
    record.position[2] = x.z;
    record.velocity[2] = n < first_upper ? 0 : -1;
    record.inverse_mass = 1;
  }
  const std::vector<SurfacePart> parts{{.name = "lower", .connectivity = below, .thickness = {}},
                                       {.name = "upper", .connectivity = both.connectivity, .thickness = {}}};
  double start = seconds();
  ContactScene scene = make_contact_scene({}, parts, nodes);
  fmt::print("{} elements: surface of {} faces made in {:.2f} s",
             below.size() / 8 + both.connectivity.size() / 8, scene.surface.face.size(), seconds() - start);
  start = seconds();
  make_erodible(scene, parts, nodes);
  fmt::print(", made erodible in {:.2f} s\n", seconds() - start);

  ThreadTeam team(1);
  const double dt = 0.02 / cells;
  std::mt19937 random(1);
  double time_of_erosion = 0, time_of_contact = 0, first_after_search = 0;
  int searches = 0;
  std::uint64_t deleted = 0;
  for (int step = 0; step < steps; ++step) {
    start = seconds();
    resolve(scene, nodes, dt, team);
    time_of_contact += seconds() - start;
    searches += scene.step.searched ? 1 : 0;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      nodes.record[n].position[2] += dt * nodes.record[n].velocity[2];
    std::vector<SurfaceElement> chosen;
    while (static_cast<int>(chosen.size()) < at_once) {
      const Face& face = scene.surface.face[random() % scene.surface.face.size()];
      if (face.part == 1) chosen.push_back({1, face.element});
    }
    start = seconds();
    erode(scene, chosen, nodes, team);
    const double took = seconds() - start;
    time_of_erosion += took;
    if (scene.step.searched) first_after_search += took;
    deleted += chosen.size();
  }
  const ContactErosion& erosion = *scene.erosion;
  fmt::print(
      "{} steps, {} searches: contact {:.2f} ms a step, erosion {:.2f} ms a step, of which after a search "
      "{:.2f} ms\n",
      steps, searches, 1e3 * time_of_contact / steps, 1e3 * time_of_erosion / steps,
      1e3 * first_after_search / steps);
  fmt::print("visits an element deleted {:.0f}, comparisons {:.0f}\n",
             static_cast<double>(erosion.topology.visits) / static_cast<double>(deleted),
             static_cast<double>(erosion.local.comparisons) / static_cast<double>(deleted));
  return 0;
}
