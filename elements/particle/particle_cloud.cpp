#include "elements/particle/particle_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "elements/base/bad_element.hpp"
#include "elements/particle/particle_weights.hpp"
#include "src/base/gather.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

Vector3d pair_vector(const Nodes& nodes, int from, int to) {
  const double* a = nodes.record[index(from)].position;
  const double* b = nodes.record[index(to)].position;
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

SymmetricTensor<double> moments(const ParticleCloud& cloud, std::size_t i) {
  SymmetricTensor<double> m{};
  for (std::size_t k = cloud.first[i]; k < cloud.first[i] + index(cloud.count[i]); ++k) {
    const double* w = cloud.pair[k].weighted;
    const double inverse = 1 / w[3];
    m = m + SymmetricTensor<double>{inverse * w[0] * w[0], inverse * w[1] * w[1], inverse * w[2] * w[2],
                                    inverse * w[0] * w[1], inverse * w[1] * w[2], inverse * w[0] * w[2]};
  }
  return m;
}

void correct(ParticleCloud& cloud, std::size_t i) {
  const SymmetricTensor<double> m = moments(cloud, i);
  const SymmetricTensor<double> c = inverse_moments(m);
  cloud.correction[i] = c;
  const bool has_support = trace(c) > 0;
  cloud.hourglass_weight[i] = has_support ? 3 / trace(m) : 0;
  double sum = 0;
  for (std::size_t k = cloud.first[i]; k < cloud.first[i] + index(cloud.count[i]); ++k) {
    const double* w = cloud.pair[k].weighted;
    const double x = c.xx * w[0] + c.xy * w[1] + c.xz * w[2];
    const double y = c.xy * w[0] + c.yy * w[1] + c.yz * w[2];
    const double z = c.xz * w[0] + c.yz * w[1] + c.zz * w[2];
    sum += std::sqrt(x * x + y * y + z * z);
  }
  cloud.gradient_size[i] = sum;
}

void remove_pair(ParticleCloud& cloud, std::size_t from, int to) {
  const std::size_t begin = cloud.first[from];
  const std::size_t end = begin + index(cloud.count[from]);
  std::size_t kept = begin;
  for (std::size_t k = begin; k < end; ++k) {
    if (cloud.neighbour[k] == to) continue;
    cloud.neighbour[kept] = cloud.neighbour[k];
    if (cloud.is_eulerian()) {
      cloud.weight[kept] = cloud.weight[k];
    } else {
      cloud.pair[kept] = cloud.pair[k];
    }
    ++kept;
  }
  cloud.count[from] = static_cast<int>(kept - begin);
  for (; cloud.is_eulerian() && kept < end; ++kept) cloud.neighbour[kept] = cloud.without_volume();
}

/// The three numbers of a row that are a vector.
double sum3(Row4 row) { return row[0] + row[1] + row[2]; }

}  // namespace

ParticleCloud make_particle_cloud(int first_node, std::span<const double> volume, double smoothing,
                                  bool in_packs, const Nodes& nodes, ThreadTeam& team) {
  const std::size_t n = volume.size();
  ParticleCloud cloud;
  cloud.first_node = first_node;
  cloud.volume = AlignedBuffer<double>(n);
  cloud.spacing = AlignedBuffer<double>(n);
  cloud.first = AlignedBuffer<std::size_t>(n);
  cloud.count = AlignedBuffer<int>(n);
  cloud.correction = AlignedBuffer<SymmetricTensor<double>>(n);
  cloud.hourglass_weight = AlignedBuffer<double>(n);
  cloud.gradient_size = AlignedBuffer<double>(n);
  cloud.force = AlignedBuffer<ParticleForce>(n + 1);  // the last one of no particle
  std::vector<ReachingPoint> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    cloud.volume[i] = volume[i];
    cloud.spacing[i] = edge_of_cube(volume[i]);
    std::copy_n(nodes.record[index(first_node) + i].position, 3, points[i].position);
    points[i].reach = smoothing * cloud.spacing[i];
  }
  NeighbourSearch search;
  search.find(points, team);
  std::size_t total = 0;
  for (std::size_t i = 0; i < n; ++i) {
    cloud.first[i] = total;
    const std::size_t found = search.of(i).size();
    total += in_packs ? places_in_packs(found) : found;
  }
  cloud.neighbour = AlignedBuffer<int>(total);
  cloud.pair = AlignedBuffer<ParticlePair>(total);
  std::fill(cloud.neighbour.begin(), cloud.neighbour.end(), cloud.without_volume());
  team.for_ranges(n, particles_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::size_t next = cloud.first[i];
      for (const int j : search.of(i)) {
        const Vector3d x = pair_vector(nodes, first_node + static_cast<int>(i), first_node + j);
        const double length = smoothing * 0.5 * (cloud.spacing[i] + cloud.spacing[index(j)]);
        const double s = volume[i] * volume[index(j)] * kernel_weight(dot(x, x), length);
        if (!(s > 0)) continue;
        cloud.neighbour[next] = j;
        cloud.pair[next++] = {{s * x.x, s * x.y, s * x.z, s}};
      }
      cloud.count[i] = static_cast<int>(next - cloud.first[i]);
      correct(cloud, i);
    }
  });
  for (std::size_t i = 0; i < n; ++i) {
    if (trace(cloud.correction[i]) > 0) {
      cloud.largest_gradient_size = std::max(cloud.largest_gradient_size, cloud.gradient_size[i]);
      continue;
    }
    throw BadElement(
        i, "has no neighbours in three directions; accepted are at least two particles along each axis");
  }
  return cloud;
}

void sum_over_neighbours(const ParticleCloud& cloud, const Nodes& nodes, const int* node, int count,
                         NeighbourSums& sums) {
  for (int lane = 0; lane < count; ++lane) {
    const auto i = index(node[lane] - cloud.first_node);
    const NodeRecord* record = nodes.record.data() + cloud.first_node;
    const Row4 x0 = load_row(record[i].position);
    const Row4 v0 = load_row(record[i].velocity);
    Row4 x_sum[3] = {}, v_sum[3] = {}, xv_sum = {}, vv_sum = {};
    const std::size_t begin = cloud.first[i];
    for (std::size_t k = begin; k < begin + index(cloud.count[i]); ++k) {
      const NodeRecord& other = record[cloud.neighbour[k]];
      const double* w = cloud.pair[k].weighted;
      const Row4 x = load_row(other.position) - x0;
      const Row4 v = load_row(other.velocity) - v0;
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c) {
        x_sum[c] += w[c] * x;
        v_sum[c] += w[c] * v;
      }
      const Row4 weighted_v = w[3] * v;
      xv_sum += weighted_v * x;
      vv_sum += weighted_v * v;
    }
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        sums.position[r][c][lane] = x_sum[c][r];
        sums.velocity[r][c][lane] = v_sum[c][r];
        sums.middle_gradient[r][c][lane] = sums.residual_gradient[r][c][lane] = 0;
      }
    sums.position_by_velocity[lane] = sum3(xv_sum);
    sums.velocity_squared[lane] = sum3(vv_sum);
    const SymmetricTensor<double>& k = cloud.correction[i];
    const double correction[6] = {k.xx, k.yy, k.zz, k.xy, k.yz, k.xz};
    for (int c = 0; c < 6; ++c) sums.correction[c][lane] = correction[c];
    sums.volume[lane] = cloud.volume[i];
    sums.spacing[lane] = cloud.spacing[i];
    sums.hourglass_weight[lane] = cloud.hourglass_weight[i];
    sums.weight[lane] = 0;  // asked for, as gradients and share, by the eulerian form alone
    for (auto& row : sums.share) row[lane] = 0;
    const double growth = std::max(1.0, cloud.gradient_size[i] / cloud.largest_gradient_size);
    sums.frequency_squared[lane] = growth * growth * cloud.frequency_squared;
  }
  repeat_last_lane(sums, count);
}

Row4 pair_forces_on(const ParticleCloud& cloud, const double* position, std::size_t stride, std::size_t i) {
  const Row4 x0 = load_row(position + stride * i);
  const ParticleForce& own = cloud.force[i];
  const Row4 a0 = load_row(own.column[0]), a1 = load_row(own.column[1]), a2 = load_row(own.column[2]);
  Row4 force = {};
  const std::size_t begin = cloud.first[i];
  for (std::size_t k = begin; k < begin + index(cloud.count[i]); ++k) {
    const auto j = index(cloud.neighbour[k]);
    const double* w = cloud.pair[k].weighted;
    const ParticleForce& other = cloud.force[j];
    const Row4 x = load_row(position + stride * j) - x0;
    const Row4 first = a0 + load_row(other.column[0]);
    const double stiffness = first[3];
    force += (w[0] * first + w[1] * (a1 + load_row(other.column[1]))) +
             (w[2] * (a2 + load_row(other.column[2])) + (stiffness * w[3]) * x);
  }
  return force;
}

void add_pair_forces(const ParticleCloud& cloud, Nodes& nodes, const int* node, int count) {
  const double* position = nodes.record[index(cloud.first_node)].position;
  for (int lane = 0; lane < count; ++lane) {
    const Row4 force = pair_forces_on(cloud, position, sizeof(NodeRecord) / sizeof(double),
                                      index(node[lane] - cloud.first_node));
    double* row = nodes.force[index(node[lane])].component;
    store_row(row, load_row(row) + Row4{force[0], force[1], force[2], 0});
  }
}

void cut_particle(ParticleCloud& cloud, int particle) {
  const auto i = index(particle);
  for (std::size_t k = cloud.first[i]; k < cloud.first[i] + index(cloud.count[i]); ++k) {
    const auto j = index(cloud.neighbour[k]);
    remove_pair(cloud, j, particle);
    if (!cloud.is_eulerian()) correct(cloud, j);  // the other form does so in every step
  }
  cloud.count[i] = 0;
  cloud.force[i] = {};
  if (cloud.is_eulerian()) cloud.searched_at[i].component[3] = -1;
}

}  // namespace brio
