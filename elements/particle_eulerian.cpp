// Particles whose pair vectors and weights are those of now.

#include <algorithm>
#include <cmath>

#include "elements/gather.hpp"
#include "elements/particle_pairs.hpp"
#include "elements/particle_weights.hpp"

namespace brio {

namespace {

/// Exponent of the ratio of kernels that switches repulsion on at less than the spacing (Gray, Monaghan &
/// Swift 2001).
double repulsion_share(double kernel_ratio) {
  return kernel_ratio * kernel_ratio * kernel_ratio * kernel_ratio;
}

double sum3(Row4 row) { return row[0] + row[1] + row[2]; }

struct OwnSums {
  Row4 velocity[3] = {}, middle_velocity[3] = {};
  Row4 velocity_squared = {};
  SymmetricTensor<double> moments{}, middle_moments{};
  double weight = 0, largest_weight = 0;
};

void add_moment(SymmetricTensor<double>& m, Row4 sx, Row4 x) {
  m.xx += sx[0] * x[0], m.yy += sx[1] * x[1], m.zz += sx[2] * x[2];
  m.xy += sx[0] * x[1], m.yz += sx[1] * x[2], m.xz += sx[0] * x[2];
}

/// Weighs the pairs of a particle anew and sums over them, where they stand and where they stood in the
/// middle of the step.
OwnSums weigh(ParticleCloud& cloud, const Nodes& nodes, std::size_t i, double step) {
  OwnSums sums;
  const NodeRecord* record = nodes.record.data() + cloud.first_node;
  const Row4 x0 = load_row(record[i].position);
  const Row4 v0 = load_row(record[i].velocity);
  const double own_length = cloud.smoothing_length[i];
  const std::size_t begin = cloud.first[i];
  for (std::size_t k = begin; k < begin + static_cast<std::size_t>(cloud.count[i]); ++k) {
    const auto j = static_cast<std::size_t>(cloud.neighbour[k]);
    const Row4 x = load_row(record[j].position) - x0;
    const double inverse_length = 2 / (own_length + cloud.smoothing_length[j]);
    const Row4 v = load_row(record[j].velocity) - v0;
    const Row4 x_middle = x - (0.5 * step) * v;
    const double weight_now = kernel_weight(sum3(x * x), inverse_length);
    const double weight_middle = kernel_weight(sum3(x_middle * x_middle), inverse_length);
    if (weight_now == 0 && weight_middle == 0) {
      store_row(cloud.pair[k].weighted, Row4{});
      continue;
    }
    const double volumes = cloud.volume[i] * cloud.volume[j];
    const Row4 sx_middle = (volumes * weight_middle) * x_middle;
    for (int c = 0; c < 3; ++c) sums.middle_velocity[c] += sx_middle[c] * v;
    add_moment(sums.middle_moments, sx_middle, x_middle);

    const double s = volumes * weight_now;
    const Row4 sx = s * x;
    store_row(cloud.pair[k].weighted, Row4{sx[0], sx[1], sx[2], s});
    for (int c = 0; c < 3; ++c) sums.velocity[c] += sx[c] * v;
    sums.velocity_squared += s * v * v;
    add_moment(sums.moments, sx, x);
    sums.weight += s;
    sums.largest_weight = std::max(sums.largest_weight, s);
  }
  return sums;
}

bool are_close(const ParticleCloud& cloud, const Nodes& nodes, std::size_t i, std::size_t j) {
  const NodeRecord* record = nodes.record.data() + cloud.first_node;
  const Row4 x = load_row(record[j].position) - load_row(record[i].position);
  const double reach = cloud.smoothing_length[i] + cloud.smoothing_length[j] + cloud.skin;
  return sum3(x * x) < reach * reach;
}

}  // namespace

void start_eulerian(ParticleCloud& cloud, double smoothing, const Nodes& nodes) {
  const std::size_t n = cloud.size();
  cloud.smoothing = smoothing;
  cloud.smoothing_length = AlignedBuffer<double>(n);
  cloud.next_smoothing_length = AlignedBuffer<double>(n);
  cloud.residual = AlignedBuffer<ParticleForce>(n);
  cloud.pair_force = AlignedBuffer<NodeVector>(n);
  cloud.searched_at = AlignedBuffer<NodeVector>(n);
  for (std::size_t i = 0; i < n; ++i)
    cloud.smoothing_length[i] = cloud.next_smoothing_length[i] = smoothing * cloud.spacing[i];
  // What the highest frequency is measured against.
  cloud.largest_gradient_size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const OwnSums sums = weigh(cloud, nodes, i, 0);
    cloud.largest_gradient_size =
        std::max(cloud.largest_gradient_size, sums.largest_weight * trace(inverse_moments(sums.moments)));
  }
}

void set_neighbours(ParticleCloud& cloud, std::span<const int> first, std::span<const int> candidate,
                    const Nodes& nodes) {
  std::size_t total = 0;
  const auto for_each_pair = [&](std::size_t i, const auto& take) {
    for (int k = first[i]; k < first[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(candidate[static_cast<std::size_t>(k)]);
      if (j != i && are_close(cloud, nodes, i, j)) take(static_cast<int>(j));
    }
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.first[i] = total;
    for_each_pair(i, [&](int) { ++total; });
  }
  if (total > cloud.neighbour.size()) {
    const std::size_t room = total + total / 4;
    cloud.neighbour = AlignedBuffer<int>(room);
    cloud.pair = AlignedBuffer<ParticlePair>(room);
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::size_t next = cloud.first[i];
    for_each_pair(i, [&](int j) { cloud.neighbour[next++] = j; });
    cloud.count[i] = static_cast<int>(next - cloud.first[i]);
    if (cloud.is_cut(i)) continue;
    const double* x = nodes.record[static_cast<std::size_t>(cloud.first_node) + i].position;
    cloud.searched_at[i] = {{x[0], x[1], x[2], cloud.smoothing_length[i]}};
  }
}

void sum_over_neighbours_now(ParticleCloud& cloud, const Nodes& nodes, const int* node, int count,
                             double step, NeighbourSums& sums) {
  for (int lane = 0; lane < count; ++lane) {
    const auto i = static_cast<std::size_t>(node[lane] - cloud.first_node);
    const OwnSums own = weigh(cloud, nodes, i, step);
    const SymmetricTensor<double>& m = own.moments;
    const SymmetricTensor<double> k = inverse_moments(m);
    cloud.correction[i] = k;
    const SymmetricTensor<double> middle = inverse_moments(own.middle_moments);
    const double columns[3][3] = {{middle.xx, middle.xy, middle.xz},
                                  {middle.xy, middle.yy, middle.yz},
                                  {middle.xz, middle.yz, middle.zz}};
    const double moments[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        sums.position[r][c][lane] = moments[r][c];
        sums.velocity[r][c][lane] = own.velocity[c][r];
        sums.middle_gradient[r][c][lane] = own.middle_velocity[0][r] * columns[0][c] +
                                           own.middle_velocity[1][r] * columns[1][c] +
                                           own.middle_velocity[2][r] * columns[2][c];
      }
    sums.position_by_velocity[lane] = own.velocity[0][0] + own.velocity[1][1] + own.velocity[2][2];
    sums.velocity_squared[lane] = sum3(own.velocity_squared);
    const double correction[6] = {k.xx, k.yy, k.zz, k.xy, k.yz, k.xz};
    for (int c = 0; c < 6; ++c) sums.correction[c][lane] = correction[c];
    sums.volume[lane] = cloud.volume[i];
    sums.spacing[lane] = cloud.spacing[i];
    sums.hourglass_weight[lane] = trace(k) > 0 ? 3 / trace(m) : 0;
    sums.weight[lane] = own.weight;
    sums.frequency_squared[lane] =
        cloud.frequency_squared * (own.largest_weight * trace(k) / cloud.largest_gradient_size);
  }
  repeat_last_lane(sums, count);
}

double add_pair_forces_now(ParticleCloud& cloud, Nodes& nodes, const int* node, int count, double repulsion,
                           double step) {
  double work = 0;
  const double inverse_shape_at_start = 1 / kernel_shape(1 / cloud.smoothing);
  for (int lane = 0; lane < count; ++lane) {
    const auto i = static_cast<std::size_t>(node[lane] - cloud.first_node);
    const NodeRecord* record = nodes.record.data() + cloud.first_node;
    const Row4 x0 = load_row(record[i].position);
    const Row4 v0 = load_row(record[i].velocity);
    const ParticleForce& own = cloud.force[i];
    const ParticleForce& own_residual = cloud.residual[i];
    Row4 force = {}, other_force = {};
    const std::size_t begin = cloud.first[i];
    for (std::size_t k = begin; k < begin + static_cast<std::size_t>(cloud.count[i]); ++k) {
      const double* w = cloud.pair[k].weighted;
      if (w[3] == 0) continue;
      const auto j = static_cast<std::size_t>(cloud.neighbour[k]);
      const ParticleForce& other = cloud.force[j];
      const ParticleForce& residual = cloud.residual[j];
      const Row4 x = load_row(record[j].position) - x0;
      const Row4 v = load_row(record[j].velocity) - v0;
      Row4 stress_force = {};
      const double viscosity = own_residual.column[0][3] + residual.column[0][3];
      Row4 residual_force = (viscosity * w[3]) * v;
      for (int c = 0; c < 3; ++c) {
        stress_force += w[c] * (load_row(own.column[c]) + load_row(other.column[c]));
        residual_force -= w[c] * (load_row(own_residual.column[c]) + load_row(residual.column[c]));
      }
      force += stress_force;
      other_force += residual_force;
      // Tension along the pair, as far as the two have come closer than they stood at the start.
      const double squared = sum3(x * x);
      const double tension = sum3(stress_force * x) / squared;
      if (tension > 0 && repulsion > 0) {
        const double length = 0.5 * (cloud.smoothing_length[i] + cloud.smoothing_length[j]);
        const double ratio = inverse_shape_at_start * kernel_shape(std::sqrt(squared) / length);
        other_force -= (repulsion * repulsion_share(ratio) * tension) * x;
      }
    }
    NodeVector& last = cloud.pair_force[i];
    const Row4 mean = 0.5 * (load_row(last.component) + other_force);
    work += step * sum3(mean * v0);
    store_row(last.component, other_force);
    double* row = nodes.force[static_cast<std::size_t>(node[lane])].component;
    const Row4 sum = force + other_force;
    store_row(row, load_row(row) + Row4{sum[0], sum[1], sum[2], 0});
  }
  return work;
}

}  // namespace brio
