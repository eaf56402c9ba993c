#include <algorithm>

#include "elements/particle/particle_kernel.hpp"
#include "elements/particle/particle_pairs.hpp"
#include "elements/sweep.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using Number = Lanes<double>;
constexpr std::array<double, 2> default_smoothing_bounds{0.5, 2};
constexpr int width = lane_count<double>;

SymmetricTensor<Number> symmetric_of(const double (&row)[6][width]) {
  return {lanes_of(row[0]), lanes_of(row[1]), lanes_of(row[2]),
          lanes_of(row[3]), lanes_of(row[4]), lanes_of(row[5])};
}

ParticleMotion<Number> motion_of(const NeighbourSums& sums) {
  Tensor<Number> x, v;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      x.m[r][c] = lanes_of(sums.position[r][c]);
      v.m[r][c] = lanes_of(sums.velocity[r][c]);
    }
  ParticleMotion<Number> motion =
      particle_motion(x, v, lanes_of(sums.position_by_velocity), lanes_of(sums.velocity_squared),
                      symmetric_of(sums.correction));
  motion.volume = lanes_of(sums.volume);
  motion.spacing = lanes_of(sums.spacing);
  motion.hourglass_weight = lanes_of(sums.hourglass_weight);
  motion.frequency_squared = lanes_of(sums.frequency_squared);
  motion.weight = lanes_of(sums.weight);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      motion.middle_gradient.m[r][c] = lanes_of(sums.middle_gradient[r][c]);
      motion.residual_gradient.m[r][c] = lanes_of(sums.residual_gradient[r][c]);
    }
  motion.share = symmetric_of(sums.share);
  return motion;
}

void publish(ParticleCloud& cloud, const int* node, int count, const ParticleForces<Number>& forces) {
  for (int lane = 0; lane < count; ++lane) {
    ParticleForce& own = cloud.force[index(node[lane] - cloud.first_node)];
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) own.column[c][r] = forces.a.m[r][c][lane];
      own.column[c][3] = c == 0 ? forces.stiffness[lane] : 0;
    }
  }
}

/// Updated-Lagrangian kernel. \param volume at the end of the step
void publish_now(ParticleCloud& cloud, const Particle& particle, const int* node, int count, Number volume,
                 const ParticleForces<Number>& forces) {
  const auto [least, largest] = particle.smoothing_bounds.value_or(default_smoothing_bounds);
  for (int lane = 0; lane < count; ++lane) {
    const auto i = index(node[lane] - cloud.first_node);
    ParticleForce& own = cloud.residual[i];
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) own.column[c][r] = forces.residual.m[r][c][lane];
      own.column[c][3] = c == 0 ? forces.viscosity[lane] : 0;
    }
    const double stretch = edge_of_cube(volume[lane]) / cloud.spacing[i];
    cloud.next_smoothing_length[i] = cloud.smoothing * cloud.spacing[i] * std::clamp(stretch, least, largest);
  }
}

/// Of lost lanes: their energy acts no more, and their half of the step's work is taken back (lose.hpp).
void take_back_particles(LaneMask<double> lost, double step, ParticleForces<Number>& forces,
                         Increment<Number>& increment) {
  const Number zero(0.0);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      forces.a.m[r][c] = where(lost, zero, forces.a.m[r][c]);
      forces.residual.m[r][c] = where(lost, zero, forces.residual.m[r][c]);
    }
  forces.stiffness = where(lost, zero, forces.stiffness);
  forces.viscosity = where(lost, zero, forces.viscosity);
  const auto broken = lost & (increment.stable_step <= zero);
  const Number internal = increment.internal_energy - where(lost, (0.5 * step) * forces.power, zero);
  increment.internal_energy = where(broken, zero, internal);
  increment.hourglass_energy = where(broken, zero, increment.hourglass_energy);
  increment.viscous_energy = where(broken, zero, increment.viscous_energy);
  increment.stable_step = where(lost, Number(HUGE_VAL), increment.stable_step);
}

double exchange_pair_forces(Block& block, Chunk chunk, Nodes& nodes, double step) {
  ParticleCloud& cloud = *block.cloud;
  const int* node = block.connectivity.data() + chunk.first_pack * width;
  const int count = static_cast<int>(chunk.element_count);
  if (cloud.is_eulerian()) {
    const double repulsion = std::get<Particle>(block.element).artificial_stress.value_or(0.3);
    return -add_pair_forces_now(cloud, nodes, node, count, repulsion, step);
  }
  add_pair_forces(cloud, nodes, node, count);
  return 0;
}

}  // namespace

/// Between the particles of a chunk and their neighbours: sums over pairs, and what pairs need to exert
/// forces, which is the second part of the sweep.
template <>
class NodeExchange<ParticleKernel, double> {
 public:
  NodeExchange(Block& block, Nodes& nodes, double step)
      : settings_(std::get<Particle>(block.element)), cloud_(*block.cloud), nodes_(nodes), step_(step) {}

  void gather_start(const int* node, ParticleMotion<Number>& motion) const {
    for (int lane = 0; lane < width; ++lane) {
      const auto i = index(node[lane] - cloud_.first_node);
      motion.volume.set(lane, cloud_.volume[i]);
      motion.hourglass_weight.set(lane, cloud_.hourglass_weight[i]);
    }
  }
  /// \param history of a particle at the start, where all are alike
  template <class Law, class History>
  void finish_start(const ParticleKernel& kernel, const Law& law, const History& history) const {
    const ElasticModuli<Number> moduli = law.moduli(history);
    const ElasticModuli<double> at_start{moduli.first_lame[0], moduli.shear[0]};
    cloud_.frequency_squared = highest_frequency_squared(
        cloud_, nodes_, at_start, kernel.stiffness_share() * ParticleKernel::youngs_modulus(at_start));
  }
  double volume(const int* node, int lane, double, double) const {
    return cloud_.volume[index(node[lane] - cloud_.first_node)];
  }

  void gather(const int* node, int count, ParticleMotion<Number>& motion) {
    if (cloud_.is_eulerian()) {
      sum_over_neighbours_now(cloud_, node, count, step_, sums_);
    } else {
      sum_over_neighbours(cloud_, nodes_, node, count, sums_);
    }
    motion = motion_of(sums_);
  }
  void take_back(LaneMask<double> lost, const ParticleMotion<Number>&, ParticleForces<Number>& forces,
                 Increment<Number>& increment) const {
    take_back_particles(lost, step_, forces, increment);
  }
  template <class Header>
  void scatter(const int* node, int count, const Header& header, const ParticleForces<Number>& forces) const {
    publish(cloud_, node, count, forces);
    if (cloud_.is_eulerian()) publish_now(cloud_, settings_, node, count, header.volume, forces);
  }

 private:
  const Particle& settings_;
  ParticleCloud& cloud_;
  Nodes& nodes_;
  double step_;
  NeighbourSums sums_;
};

void choose_kernel(const Particle&, Block& block) {
  choose_kernel_of<ParticleKernel>(block);
  block.kernel.exchange = exchange_pair_forces;
}

}  // namespace brio
