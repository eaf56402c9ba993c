#include "src/particles.hpp"

#include <algorithm>
#include <stdexcept>

#include "contact/global_search.hpp"

namespace brio {

void find_neighbours(Block& block, std::span<const double> volume, const Nodes& nodes) {
  const auto& particle = std::get<Particle>(block.element);
  if (particle.is_eulerian())
    throw std::invalid_argument("kernel: eulerian is not computed yet; accepted is total_lagrangian");
  const int first_node = block.node(0, 0);
  const double reach =
      2 * particle.smoothing_length * edge_of_cube(*std::max_element(volume.begin(), volume.end()));
  std::vector<Vector3<double>> point;
  std::vector<CaptureBox> box;
  for (std::size_t i = 0; i < volume.size(); ++i) {
    const double* x = nodes.record[static_cast<std::size_t>(first_node) + i].position;
    point.push_back({x[0], x[1], x[2]});
    box.push_back({{x[0] - reach, x[1] - reach, x[2] - reach}, {x[0] + reach, x[1] + reach, x[2] + reach}});
  }
  GlobalSearch search;
  ThreadTeam team(1);
  CandidatePairs pairs;
  SearchCounts counts;
  search.find(point, box, team, pairs, counts);
  block.cloud =
      make_particle_cloud(first_node, volume, pairs.first, pairs.node, particle.smoothing_length, nodes);
}

}  // namespace brio
