// Particles with an updated-Lagrangian kernel: present pair vectors and weights.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "elements/particle/particle_pairs.hpp"
#include "elements/particle/particle_support.hpp"
#include "elements/particle/particle_weights.hpp"
#include "src/base/gather.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using Number = Lanes<double>;
constexpr int width = lane_count<double>;

using PairVector = Vector3<Number>;

Row4 sum_of(const PairVector& a) {
  const Number none(0.0);
  const Row8 sums = sums_over_lanes({a.x.v, a.y.v, a.z.v, none.v, none.v, none.v, none.v, none.v});
  return Row4{sums[0], sums[1], sums[2], 0};
}
double largest(Number a) {
  double most = a[0];
  for (int lane = 1; lane < width; ++lane) most = std::max(most, a[lane]);
  return most;
}

/// Eight of a particle's neighbours; behind the last one a particle without volume.
struct NeighbourPack {
  const int* index;
  double* weight;

  NeighbourPack(ParticleCloud& cloud, std::size_t i, int begin)
      : index(cloud.neighbour.data() + cloud.first[i] + begin),
        weight(cloud.weight.data() + cloud.first[i] + begin) {}
  void store_weights(Number s) const {
    std::memcpy(__builtin_assume_aligned(weight, sizeof s.v), &s.v, sizeof s.v);
  }
  Number weights() const {
    Number s;
    std::memcpy(&s.v, __builtin_assume_aligned(weight, sizeof s.v), sizeof s.v);
    return s;
  }
  /// Rows of a record a particle. \param row of the first record
  template <class Record>
  LaneRows rows(const double* row, const Record*) const {
    return {row, sizeof(Record) / sizeof(double), index};
  }
};

/// Pair vectors, relative velocities, means of the smoothing lengths, and volumes of the neighbours.
struct PairMotion {
  PairVector x, v;
  Number length, volume;

  PairMotion(const ParticleCloud& cloud, std::size_t i, const NeighbourPack& pack) {
    const ParticlePlace& own = cloud.place[i];
    const ParticlePlace* first = cloud.place.data();
    const LaneRows place = pack.rows(first->position, first), motion = pack.rows(first->velocity, first);
    x = {place.x - own.position[0], place.y - own.position[1], place.z - own.position[2]};
    v = {motion.x - own.velocity[0], motion.y - own.velocity[1], motion.z - own.velocity[2]};
    length = 0.5 * (place.w + own.smoothing_length);
    volume = motion.w;
  }
};

/// Eight pairs, and their weights now and in the middle of the step.
struct WeighedPairs {
  PairVector x, v;
  Number s, s_middle;
};

/// Sums of s v x^T, s x x^T, s v.v and s, still by lanes.
struct PairSums {
  static constexpr int velocity = 0, moments = 9, velocity_squared = 15, weight = 16, count = 24;
  Number lane[count];  // whole groups of eight

  PairSums() {
    for (Number& sum : lane) sum = Number(0.0);
  }
  BRIO_INLINE void add(Number s, const PairVector& x, const PairVector& v) {
    const Number sx[3] = {s * x.x, s * x.y, s * x.z};
#pragma GCC unroll 3
    for (int c = 0; c < 3; ++c) {
      lane[velocity + c] += sx[c] * v.x;
      lane[velocity + 3 + c] += sx[c] * v.y;
      lane[velocity + 6 + c] += sx[c] * v.z;
    }
    lane[moments] += sx[0] * x.x, lane[moments + 1] += sx[1] * x.y, lane[moments + 2] += sx[2] * x.z;
    lane[moments + 3] += sx[0] * x.y, lane[moments + 4] += sx[1] * x.z, lane[moments + 5] += sx[0] * x.z;
  }
};

/// Sums of the pairs of particles, where they stand and where they stood in the middle of the step; one
/// particle a lane.
struct ParticleSums {
  double now[PairSums::count][width], middle[PairSums::count][width];
  double largest_weight[width];

  static void total(const PairSums& pairs, int lane, double (&row)[PairSums::count][width]) {
    for (int first = 0; first < PairSums::count; first += width) {
      const Number* of = pairs.lane + first;
      const Row8 sums =
          sums_over_lanes({of[0].v, of[1].v, of[2].v, of[3].v, of[4].v, of[5].v, of[6].v, of[7].v});
      for (int k = 0; k < width; ++k) row[first + k][lane] = sums[k];
    }
  }
};

Tensor<Number> velocity_sum(const double (&row)[PairSums::count][width]) {
  Tensor<Number> sum;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) sum.m[r][c] = lanes_of(row[PairSums::velocity + 3 * r + c]);
  return sum;
}
SymmetricTensor<Number> moment_sum(const double (&row)[PairSums::count][width]) {
  const auto& m = row + PairSums::moments;
  return {lanes_of(m[0]), lanes_of(m[1]), lanes_of(m[2]), lanes_of(m[3]), lanes_of(m[4]), lanes_of(m[5])};
}

/// Weighs the pairs of a particle anew and sums over them. One after the other: one loop over all would keep
/// more numbers than there are registers.
void weigh(ParticleCloud& cloud, std::size_t i, double step, int lane, ParticleSums& sums) {
  constexpr int most = 16;
  WeighedPairs pairs[most];
  PairSums now, middle;
  Number largest_weight(0.0);
  const Number own_volume(cloud.volume[i]);
  for (int begin = 0; begin < cloud.count[i];) {
    int count = 0;
    for (; count < most && begin < cloud.count[i]; ++count, begin += width) {
      const NeighbourPack pack(cloud, i, begin);
      const PairMotion pair(cloud, i, pack);
      const Number volumes = own_volume * pair.volume;
      const PairVector x_middle = pair.x - Number(0.5 * step) * pair.v;
      const Number s = volumes * kernel_weight(dot(pair.x, pair.x), pair.length);
      pack.store_weights(s);
      pairs[count] = {pair.x, pair.v, s, volumes * kernel_weight(dot(x_middle, x_middle), pair.length)};
    }
    PairSums sum = now;
    for (int p = 0; p < count; ++p) {
      const auto& [x, v, s, unused] = pairs[p];
      sum.add(s, x, v);
      sum.lane[PairSums::velocity_squared] += s * dot(v, v);
      sum.lane[PairSums::weight] += s;
      largest_weight = max(largest_weight, s);
    }
    now = sum;
    sum = middle;
    for (int p = 0; p < count; ++p) {
      const auto& [x, v, unused, s] = pairs[p];
      sum.add(s, x - Number(0.5 * step) * v, v);
    }
    middle = sum;
  }
  ParticleSums::total(now, lane, sums.now);
  ParticleSums::total(middle, lane, sums.middle);
  sums.largest_weight[lane] = largest(largest_weight);
}

void store(Number a, double (&row)[width]) { std::memcpy(row, &a.v, sizeof row); }
void store(const Tensor<Number>& a, double (&row)[3][3][width]) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) store(a.m[r][c], row[r][c]);
}
void store(const SymmetricTensor<Number>& a, double (&row)[6][width]) {
  const Number entry[6] = {a.xx, a.yy, a.zz, a.xy, a.yz, a.xz};
  for (int c = 0; c < 6; ++c) store(entry[c], row[c]);
}

/// Matrices of neighbours, and the fourth number of their first columns.
struct Matrices {
  PairVector column[3];
  Number fourth;

  Matrices(const ParticleForce* first, const NeighbourPack& pack) {
#pragma GCC unroll 3
    for (int c = 0; c < 3; ++c) {
      const LaneRows rows = pack.rows(first->column[c], first);
      column[c] = {rows.x, rows.y, rows.z};
      if (c == 0) fourth = rows.w;
    }
  }
  Matrices& operator+=(const ParticleForce& a) {
    for (int c = 0; c < 3; ++c)
      column[c] = column[c] + PairVector{a.column[c][0], a.column[c][1], a.column[c][2]};
    return *this;
  }
  PairVector operator*(const PairVector& x) const {
    const auto& [a, b, c] = column;
    return {a.x * x.x + b.x * x.y + c.x * x.z, a.y * x.x + b.y * x.y + c.y * x.z,
            a.z * x.x + b.z * x.y + c.z * x.z};
  }
};
Row4 product(const ParticleForce& a, Row4 x) {
  return load_row(a.column[0]) * x[0] + load_row(a.column[1]) * x[1] + load_row(a.column[2]) * x[2];
}

/// Repulsion of close particles: a share of the tension along the pair, which grows with the fourth power of
/// the ratio of kernels (Gray, Monaghan & Swift 2001) until the two are as close as they stood at the start.
/// Not further: it is the force of no energy, and where it grew to half of the tension, sheets of particles
/// shook themselves apart.
struct Repulsion {
  double share;
  double inverse_shape_at_start;

  Repulsion(double share_of_tension, const ParticleCloud& cloud)
      : share(share_of_tension), inverse_shape_at_start(1 / kernel_shape(1 / cloud.smoothing)) {}

  /// Force over distance.
  Number operator()(const PairVector& stress_force, const PairMotion& pair) const {
    const Number tension = dot(stress_force, pair.x), none(0.0);
    if (!any(tension > none)) return none;
    const Number inverse = inverse_distance(dot(pair.x, pair.x));
    const Number q = dot(pair.x, pair.x) * inverse / pair.length;
    const Number growth = square(square(inverse_shape_at_start * kernel_shape(q)));
    return share * min(growth, 1.0) * max(tension, none) * square(inverse);
  }
};

}  // namespace

void start_eulerian(ParticleCloud& cloud, double smoothing, const Nodes& nodes) {
  const std::size_t n = cloud.size();
  cloud.smoothing = smoothing;
  cloud.smoothing_length = AlignedBuffer<double>(n);
  cloud.next_smoothing_length = AlignedBuffer<double>(n);
  cloud.place = AlignedBuffer<ParticlePlace>(n + 1);
  cloud.place[n].smoothing_length = smoothing * cloud.spacing[0];  // behind it no volume
  cloud.residual = AlignedBuffer<ParticleForce>(n + 1);
  cloud.pair_force = AlignedBuffer<NodeVector>(n);
  cloud.searched_at = AlignedBuffer<NodeVector>(n);
  for (std::size_t i = 0; i < n; ++i) cloud.next_smoothing_length[i] = smoothing * cloud.spacing[i];
  place_particles(cloud, nodes, 0, n);
  // What the highest frequency is measured against.
  cloud.largest_gradient_size = 0;
  cloud.weight = AlignedBuffer<double>(cloud.neighbour.size());
  for (std::size_t i = 0; i < n; ++i) {
    ParticleSums sums;
    weigh(cloud, i, 0, 0, sums);
    const SymmetricTensor<Number> m = moment_sum(sums.now);
    const ParticleSupport<double> support({m.xx[0], m.yy[0], m.zz[0], m.xy[0], m.yz[0], m.xz[0]},
                                          cloud.volume[i]);
    cloud.largest_gradient_size =
        std::max(cloud.largest_gradient_size, sums.largest_weight[0] * support.stiffness());
  }
}

void set_neighbours(ParticleCloud& cloud, const NeighbourSearch& found, const Nodes& nodes,
                    ThreadTeam& team) {
  cloud.pair = {};  // the initial ones are no longer needed
  std::size_t total = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.first[i] = total;
    total += places_in_packs(found.of(i).size());
  }
  if (total > cloud.neighbour.size()) {
    const std::size_t room = total + total / 4;
    cloud.neighbour = AlignedBuffer<int>(room);
    cloud.weight = AlignedBuffer<double>(room);
  }
  team.for_ranges(cloud.size(), particles_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::span<const int> neighbours = found.of(i);
      int* list = cloud.neighbour.data() + cloud.first[i];
      std::copy(neighbours.begin(), neighbours.end(), list);
      std::fill(list + neighbours.size(), list + places_in_packs(neighbours.size()), cloud.without_volume());
      cloud.count[i] = static_cast<int>(neighbours.size());
      if (cloud.is_cut(i)) continue;
      const double* x = nodes.record[index(cloud.first_node) + i].position;
      cloud.searched_at[i] = {{x[0], x[1], x[2], cloud.smoothing_length[i]}};
    }
  });
}

void place_particles(ParticleCloud& cloud, const Nodes& nodes, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const NodeRecord& record = nodes.record[index(cloud.first_node) + i];
    cloud.smoothing_length[i] = cloud.next_smoothing_length[i];
    ParticlePlace& place = cloud.place[i];
    std::copy_n(record.position, 3, place.position);
    std::copy_n(record.velocity, 3, place.velocity);
    place.smoothing_length = cloud.smoothing_length[i];
    place.volume = cloud.volume[i];
  }
}

void sum_over_neighbours_now(ParticleCloud& cloud, const int* node, int count, double step,
                             NeighbourSums& sums) {
  ParticleSums found;
  for (int lane = 0; lane < width; ++lane) {
    const auto i = index(node[std::min(lane, count - 1)] - cloud.first_node);
    weigh(cloud, i, step, lane, found);
    sums.volume[lane] = cloud.volume[i];
    sums.spacing[lane] = cloud.spacing[i];
  }
  const SymmetricTensor<Number> moments = moment_sum(found.now);
  const Tensor<Number> velocity = velocity_sum(found.now);
  const Number volume = lanes_of(sums.volume), spacing = lanes_of(sums.spacing);
  const Number weight = lanes_of(found.now[PairSums::weight]);
  const ParticleSupport now(moments, volume), middle(moment_sum(found.middle), volume);
  const SymmetricTensor<Number> unbounded = inverse_moments(moments);
  store(full(now.raised(moments)), sums.position);
  store(velocity, sums.velocity);
  store(middle.velocity_gradient(velocity_sum(found.middle)), sums.middle_gradient);
  store(velocity * full(unbounded), sums.residual_gradient);
  store(now.inverse(), sums.correction);
  store(now.share(), sums.share);
  store(trace(velocity), sums.position_by_velocity);
  store(lanes_of(found.now[PairSums::velocity_squared]), sums.velocity_squared);
  store(weight, sums.weight);
  const auto has_support = trace(unbounded) > Number(0.0);
  const Number size = where(has_support, max(trace(moments), weight * square(spacing)), Number(1.0));
  store(where(has_support, 3.0 / size, Number(0.0)), sums.hourglass_weight);
  store(cloud.frequency_squared / cloud.largest_gradient_size * lanes_of(found.largest_weight) *
            now.stiffness(),
        sums.frequency_squared);
}

double add_pair_forces_now(ParticleCloud& cloud, Nodes& nodes, const int* node, int count, double repulsion,
                           double step) {
  const Repulsion repulsion_of(repulsion, cloud);
  const PairVector none{0.0, 0.0, 0.0};
  double work = 0;
  for (int lane = 0; lane < count; ++lane) {
    const auto i = index(node[lane] - cloud.first_node);
    const double viscosity = cloud.residual[i].column[0][3];
    PairVector stress = none, other = none, weighted = none;
    for (int begin = 0; begin < cloud.count[i]; begin += width) {
      const NeighbourPack pack(cloud, i, begin);
      const PairMotion pair(cloud, i, pack);
      const Number s = pack.weights();
      const PairVector sx = s * pair.x;
      Matrices a(cloud.force.data(), pack);
      const PairVector stress_force = (a += cloud.force[i]) * sx;
      const Matrices residual(cloud.residual.data(), pack);
      stress = stress + stress_force;
      other = other + (s * (residual.fourth + viscosity)) * pair.v - residual * sx -
              repulsion_of(stress_force, pair) * pair.x;
      weighted = weighted + sx;
    }
    const Row4 force = sum_of(stress),
               other_force = sum_of(other) - product(cloud.residual[i], sum_of(weighted));
    NodeVector& last = cloud.pair_force[i];
    const Row4 mean = 0.5 * (load_row(last.component) + other_force);
    const double* v = cloud.place[i].velocity;
    work += step * (mean[0] * v[0] + mean[1] * v[1] + mean[2] * v[2]);
    store_row(last.component, other_force);
    double* row = nodes.force[index(node[lane])].component;
    store_row(row, load_row(row) + force + other_force);
  }
  return work;
}

}  // namespace brio
