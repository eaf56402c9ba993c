#include "src/sweep/particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elements/particle/particle_pairs.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Largest search margin (Verlet skin) over the largest smoothing length; what a step moves is covered in any
/// case.
constexpr double largest_skin = 0.3;
/// Of the first search, where it is not known yet how fast particles move.
constexpr double first_skin = 0.05;
/// Price of a search over that of the pairs of a step.
constexpr double price_of_search = 0.3;

const double* position(const ParticleCloud& cloud, const Nodes& nodes, std::size_t i) {
  return nodes.record[index(cloud.first_node) + i].position;
}

ParticleDrift drift_of_range(const ParticleCloud& cloud, std::size_t begin, std::size_t end) {
  ParticleDrift drift;
  for (std::size_t i = begin; i < end; ++i) {
    if (cloud.is_cut(i)) continue;
    const double* x = cloud.place[i].position;
    const double* then = cloud.searched_at[i].component;
    for (int axis = 0; axis < 3; ++axis) {
      drift.lower[axis] = std::min(drift.lower[axis], x[axis] - then[axis]);
      drift.upper[axis] = std::max(drift.upper[axis], x[axis] - then[axis]);
    }
    drift.growth = std::max(drift.growth, cloud.smoothing_length[i] - then[3]);
  }
  return drift;
}

// Pairs cost (1 + skin / reach)^3 times as much as without a skin, and there is a search every skin /
// approach steps: the skin of the least price. It covers the motion of a step, which pairs are weighed in the
// middle of.
double skin_of_least_price(double approach_of_step, double largest_length) {
  const double reach = 2 * largest_length;
  const double cheapest = std::sqrt(price_of_search / 3 * approach_of_step * reach);
  return std::max(std::min(cheapest, largest_skin * largest_length), approach_of_step);
}

void search_anew(ParticleSearch& search, ParticleCloud& cloud, const Nodes& nodes, ThreadTeam& team) {
  search.points.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ReachingPoint& point = search.points[i];
    std::copy_n(cloud.place[i].position, 3, point.position);
    point.reach = cloud.is_cut(i) ? -1 : cloud.smoothing_length[i] + 0.5 * cloud.skin;
  }
  search.search.find(search.points, team);
  set_neighbours(cloud, search.search, nodes, team);
  ++search.searches;
  search.steps_since = 0;
}

}  // namespace

void ParticleDrift::join(const ParticleDrift& other) {
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = std::min(lower[axis], other.lower[axis]);
    upper[axis] = std::max(upper[axis], other.upper[axis]);
  }
  growth = std::max(growth, other.growth);
}

// No two particles have moved further towards each other than the displacements of all are apart.
double ParticleDrift::approach() const {
  if (!(lower[0] <= upper[0])) return 0;
  return std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]) + 2 * growth;
}

void find_neighbours(Block& block, std::span<const double> volume, const Nodes& nodes, ThreadTeam& team) {
  const auto& particle = std::get<Particle>(block.element);
  block.cloud = make_particle_cloud(block.node(0, 0), volume, particle.smoothing(), particle.is_eulerian(),
                                    nodes, team);
  if (particle.is_eulerian()) start_eulerian(*block.cloud, particle.smoothing(), nodes);
}

void follow_neighbours(ParticleSearch& search, Block& block, const Nodes& nodes, ThreadTeam& team) {
  ParticleCloud& cloud = *block.cloud;
  search.drifts.resize((cloud.size() + nodes_per_range - 1) / nodes_per_range);
  team.for_ranges(cloud.size(), nodes_per_range, [&](std::size_t begin, std::size_t end) {
    place_particles(cloud, nodes, begin, end);
    search.drifts[begin / nodes_per_range] = drift_of_range(cloud, begin, end);
  });
  ParticleDrift drift;
  for (const ParticleDrift& of_range : search.drifts) drift.join(of_range);
  const double approach = drift.approach();
  ++search.steps_since;
  if (search.searches > 0 && approach < cloud.skin) return;
  const double largest = *std::max_element(cloud.smoothing_length.begin(), cloud.smoothing_length.end());
  cloud.skin = search.searches == 0
                   ? first_skin * largest
                   : skin_of_least_price(approach / static_cast<double>(search.steps_since), largest);
  search_anew(search, cloud, nodes, team);
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
