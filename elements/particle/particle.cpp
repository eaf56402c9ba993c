#include <algorithm>

#include "elements/particle/particle_kernel.hpp"
#include "elements/particle/particle_pairs.hpp"
#include "elements/sweep.hpp"

namespace brio {

namespace {

using Number = Lanes<double>;
constexpr std::array<double, 2> default_smoothing_bounds{0.5, 2};
constexpr int width = lane_count<double>;

Number lanes_of(const double (&row)[width]) {
  Number number;
  std::memcpy(&number.v, row, sizeof row);
  return number;
}

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
    ParticleForce& own = cloud.force[static_cast<std::size_t>(node[lane] - cloud.first_node)];
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
    const auto i = static_cast<std::size_t>(node[lane] - cloud.first_node);
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

template <class Law>
SweepResult sweep_particles(Block& block, Chunk chunk, Nodes& nodes, double step) {
  using Layout = PackLayout<ParticleKernel, Law, double>;
  const auto kernel = kernel_of<ParticleKernel>(block.element);
  const Law law = law_of<Law>(block.material, step);
  ParticleCloud& cloud = *block.cloud;
  LaneSum<double> internal_energy, hourglass_energy, viscous_energy;
  SweepResult result;
  result.stable_step = HUGE_VAL;
  NeighbourSums sums;
  for (std::size_t done = 0; done < chunk.element_count; done += width) {
    const std::size_t pack = chunk.first_pack + done / width;
    const int* node = block.connectivity.data() + pack * width;
    const int count = static_cast<int>(std::min<std::size_t>(width, chunk.element_count - done));
    if (cloud.is_eulerian()) {
      sum_over_neighbours_now(cloud, nodes, node, count, step, sums);
    } else {
      sum_over_neighbours(cloud, nodes, node, count, sums);
    }
    ParticleForces<Number> forces;
    auto& header = Layout::header(block, pack);
    auto* point = Layout::points(block, pack);
    Increment<Number> increment = kernel.force(motion_of(sums), Number(step), law, header, point, forces);
    if (block.loses_elements) {
      const LostLanes<double> lost =
          lost_lanes<ParticleKernel, Law, double>(kernel, law, block.deletion, header, point,
                                                  MotionOf<ParticleKernel, Number>{}, increment.stable_step);
      if (any(lost.any)) {
        take_back_particles(lost.any, step, forces, increment);
        list_lost<double>(lost, count, chunk.first_pack * width, pack * width, block, result);
      }
      hold<double>(increment, block.held.data() + pack * 2 * width);
    }
    publish(cloud, node, count, forces);
    if (cloud.is_eulerian()) publish_now(cloud, kernel, node, count, header.volume, forces);
    internal_energy.add(increment.internal_energy, count);
    hourglass_energy.add(increment.hourglass_energy, count);
    viscous_energy.add(increment.viscous_energy, count);
    note_stable_step<double>(increment.stable_step, pack, count, result);
  }
  result.internal_energy = internal_energy.sum();
  result.hourglass_energy = hourglass_energy.sum();
  result.viscous_energy = viscous_energy.sum();
  return result;
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

template <class Law>
void initialize_particles(Block& block, Nodes& nodes) {
  using Layout = PackLayout<ParticleKernel, Law, double>;
  const Law law = law_of<Law>(block.material);
  const auto kernel = kernel_of<ParticleKernel>(block.element);
  ParticleCloud& cloud = *block.cloud;
  ElasticModuli<Number> moduli{};
  for (std::size_t pack = 0; pack < block.pack_count; ++pack) {
    const int* node = block.connectivity.data() + pack * width;
    auto& header = Layout::header(block, pack);
    auto* point = Layout::points(block, pack);
    Number hourglass_weight;
    for (int lane = 0; lane < width; ++lane) {
      const auto i = static_cast<std::size_t>(node[lane] - cloud.first_node);
      header.volume.set(lane, cloud.volume[i]);
      hourglass_weight.set(lane, cloud.hourglass_weight[i]);
    }
    header.mass = Number(law.density) * header.volume;
    start(*point);
    if constexpr (requires { law.start(point->history, header.mass); }) {
      Number spacing;
      for (int lane = 0; lane < width; ++lane) spacing.set(lane, edge_of_cube(header.volume[lane]));
      law.start(point->history, spacing);
    }
    moduli = law.moduli(point->history);
    header.stiffness_at_start = moduli.first_lame + 2.0 * moduli.shear;
    header.hourglass_stiffness =
        kernel.residual_stiffness(law, moduli, *point, header.volume, hourglass_weight);
    for (int lane = 0; lane < width && pack * width + static_cast<std::size_t>(lane) < block.element_count;
         ++lane)
      nodes.mass[static_cast<std::size_t>(node[lane])] += header.mass[lane];
  }
  const ElasticModuli<double> at_start{moduli.first_lame[0], moduli.shear[0]};
  cloud.frequency_squared = highest_frequency_squared(
      cloud, nodes, at_start, kernel.stiffness_share() * ParticleKernel::youngs_modulus(at_start));
}

template <class Law>
ElementSample sample_particle(const Block& block, const Nodes&, std::size_t e) {
  ParticleKernel::Header<double, Law> header;
  ParticleKernel::Point<double, Law> point;
  const std::byte* pack = block.state.data() + (e / width) * block.pack_bytes;
  const int lane = static_cast<int>(e % width);
  copy_lane<decltype(header), double>(pack, lane, &header);
  copy_lane<decltype(point), double>(pack + sizeof(typename PackLayout<ParticleKernel, Law, double>::Header),
                                     lane, &point);
  ElementSample sample =
      kernel_of<ParticleKernel>(block.element).sample(law_of<Law>(block.material), header, &point);
  if constexpr (can_fail<Law>) sample.damage = point.history.damage;
  return sample;
}

struct ParticleKernels {
  template <class Law>
  static void set(Block& block) {
    block.pack_bytes = PackLayout<ParticleKernel, Law, double>::bytes({});
    block.kernel = {sweep_particles<Law>,
                    initialize_particles<Law>,
                    sample_particle<Law>,
                    mass_of_element<ParticleKernel, Law, double>,
                    nullptr,
                    exchange_pair_forces};
    block.loses_elements = can_fail<Law> || block.deletion.names_a_criterion();
  }
};

}  // namespace

void choose_kernel(const Particle&, Block& block) {
  if (block.precision != Precision::double_precision)
    throw std::invalid_argument(
        "particles are computed in double precision only; accepted is "
        "numerics: {precision: double}");
  std::visit(
      [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        const auto set = [&]<class Chosen>(std::type_identity<Chosen>) {
          if constexpr (requires { law.failure; }) {
            if (law.failure) {
              ParticleKernels::set<Failing<Chosen>>(block);
              return;
            }
          }
          ParticleKernels::set<Chosen>(block);
        };
        if constexpr (requires { typename Law::Reduced; }) {
          if (law.is_reduced()) {
            set(std::type_identity<typename Law::Reduced>{});
            return;
          }
        }
        set(std::type_identity<Law>{});
      },
      block.material);
}

}  // namespace brio
