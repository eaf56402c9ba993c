#include "src/sweep/particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elements/particle/particle_pairs.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Search margin (Verlet skin) over the smallest initial smoothing length.
constexpr double search_skin_share = 0.3;

const double* position(const ParticleCloud& cloud, const Nodes& nodes, std::size_t i) {
  return nodes.record[index(cloud.first_node) + i].position;
}

// Points and boxes of the particles that live, which reach as far as the search must see.
void fill_boxes(const ParticleCloud& cloud, const Nodes& nodes, ParticleSearch& search) {
  const double largest = *std::max_element(cloud.smoothing_length.begin(), cloud.smoothing_length.end());
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  search.point.assign(cloud.size(), {nowhere, nowhere, nowhere});
  search.box.assign(cloud.size(), empty_box);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.is_cut(i)) continue;
    const double* x = position(cloud, nodes, i);
    const double reach = cloud.smoothing_length[i] + largest + cloud.skin;
    search.point[i] = {x[0], x[1], x[2]};
    search.box[i] = {{x[0] - reach, x[1] - reach, x[2] - reach}, {x[0] + reach, x[1] + reach, x[2] + reach}};
  }
}

// Whether a pair may have come into the reach of its kernel that is in no list: no two particles have moved
// further towards each other than the displacements of all are apart.
bool lists_are_old(const ParticleCloud& cloud, const Nodes& nodes) {
  CaptureBox moved = empty_box;
  double growth = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.is_cut(i)) continue;
    const double* x = position(cloud, nodes, i);
    const double* then = cloud.searched_at[i].component;
    for (int axis = 0; axis < 3; ++axis) {
      moved.lower[axis] = std::min(moved.lower[axis], x[axis] - then[axis]);
      moved.upper[axis] = std::max(moved.upper[axis], x[axis] - then[axis]);
    }
    growth = std::max(growth, cloud.smoothing_length[i] - then[3]);
  }
  if (!moved.holds_anything()) return false;
  const double apart = std::hypot(moved.upper[0] - moved.lower[0], moved.upper[1] - moved.lower[1],
                                  moved.upper[2] - moved.lower[2]);
  return apart + 2 * growth >= cloud.skin;
}

}  // namespace

void find_neighbours(Block& block, std::span<const double> volume, const Nodes& nodes) {
  const auto& particle = std::get<Particle>(block.element);
  const int first_node = block.node(0, 0);
  const double reach =
      2 * particle.smoothing() * edge_of_cube(*std::max_element(volume.begin(), volume.end()));
  ParticleSearch search{};
  for (std::size_t i = 0; i < volume.size(); ++i) {
    const double* x = nodes.record[index(first_node) + i].position;
    search.point.push_back({x[0], x[1], x[2]});
    search.box.push_back(
        {{x[0] - reach, x[1] - reach, x[2] - reach}, {x[0] + reach, x[1] + reach, x[2] + reach}});
  }
  ThreadTeam team(1);
  search.search.find(search.point, search.box, team, search.pairs, search.counts);
  block.cloud = make_particle_cloud(first_node, volume, search.pairs.first, search.pairs.node,
                                    particle.smoothing(), nodes);
  if (!particle.is_eulerian()) return;
  ParticleCloud& cloud = *block.cloud;
  start_eulerian(cloud, particle.smoothing(), nodes);
  cloud.skin =
      search_skin_share * *std::min_element(cloud.smoothing_length.begin(), cloud.smoothing_length.end());
}

void follow_neighbours(ParticleSearch& search, Block& block, const Nodes& nodes, ThreadTeam& team) {
  ParticleCloud& cloud = *block.cloud;
  std::copy(cloud.next_smoothing_length.begin(), cloud.next_smoothing_length.end(),
            cloud.smoothing_length.begin());
  if (search.counts.searches > 0 && !lists_are_old(cloud, nodes)) return;
  fill_boxes(cloud, nodes, search);
  search.search.find(search.point, search.box, team, search.pairs, search.counts);
  set_neighbours(cloud, search.pairs.first, search.pairs.node, nodes);
}

double share_of_paired(const ParticleCloud& cloud, const Nodes& nodes) {
  std::size_t alive = 0, paired = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.is_cut(i)) continue;
    ++alive;
    const double closest = PairedParticles::closer_than * cloud.smoothing_length[i] / cloud.smoothing;
    const double* x = position(cloud, nodes, i);
    const std::span neighbours(cloud.neighbour.data() + cloud.first[i], index(cloud.count[i]));
    const bool is_paired = std::any_of(neighbours.begin(), neighbours.end(), [&](int j) {
      const double* other = position(cloud, nodes, index(j));
      return std::hypot(other[0] - x[0], other[1] - x[1], other[2] - x[2]) < closest;
    });
    if (is_paired) ++paired;
  }
  return alive > 0 ? static_cast<double>(paired) / static_cast<double>(alive) : 0;
}

}  // namespace brio
