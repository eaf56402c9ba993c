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

/// At what distance two particles repel each other with the tension that they have along their pair: the
/// fourth power of the ratio of kernels (Gray, Monaghan & Swift 2001).
Number repulsion_share(Number kernel_ratio) { return square(square(kernel_ratio)); }

using PairVector = Vector3<Number>;

double sum_of(Number a) { return sum(a, width); }
Row4 sum_of(const PairVector& a) { return Row4{sum_of(a.x), sum_of(a.y), sum_of(a.z), 0}; }
double largest(Number a) {
  double most = a[0];
  for (int lane = 1; lane < width; ++lane) most = std::max(most, a[lane]);
  return most;
}

/// Eight of a particle's neighbours; behind the last one the particle itself, which `is_pair` leaves out.
struct NeighbourPack {
  int index[width];
  int count;
  LaneMask<double> is_pair;

  NeighbourPack(const ParticleCloud& cloud, std::size_t i, int begin) {
    count = std::min(width, cloud.count[i] - begin);
    const int* list = cloud.neighbour.data() + cloud.first[i] + begin;
    for (int lane = 0; lane < width; ++lane) index[lane] = lane < count ? list[lane] : static_cast<int>(i);
    is_pair = Number(wide_of<double>(0., 1., 2., 3., 4., 5., 6., 7.)) < Number(count);
  }
  Number gather(const double* value) const {
    Number result;
    for (int lane = 0; lane < width; ++lane) result.set(lane, value[index[lane]]);
    return result;
  }
  // No further than `count`: behind it are another particle's, of another thread.
  void store_weights(Number s, ParticleCloud& cloud, std::size_t i, int begin) const {
    std::memcpy(cloud.weight.data() + cloud.first[i] + begin, &s.v, bytes());
  }
  Number weights(const ParticleCloud& cloud, std::size_t i, int begin) const {
    Number s(0.0);
    std::memcpy(&s.v, cloud.weight.data() + cloud.first[i] + begin, bytes());
    return s;
  }
  std::size_t bytes() const { return static_cast<std::size_t>(count) * sizeof(double); }
  /// Rows of a record a particle.
  template <class Record>
  PairVector gather(const double* first_row, const Record*) const {
    const WideVector<double> rows = gather_rows<double>(first_row, sizeof(Record) / sizeof(double), index);
    return {Number(rows.x[0]), Number(rows.y[0]), Number(rows.z[0])};
  }
};

/// Pair vectors and relative velocities.
struct PairMotion {
  PairVector x, v;

  PairMotion(const NodeRecord* record, std::size_t i, const NeighbourPack& pack) {
    const double* x0 = record[i].position;
    const double* v0 = record[i].velocity;
    x = pack.gather(record->position, record) - PairVector{x0[0], x0[1], x0[2]};
    v = pack.gather(record->velocity, record) - PairVector{v0[0], v0[1], v0[2]};
  }
};

/// Sums of s v x^T and s x x^T, still by lanes.
struct MomentSums {
  Number velocity[3][3], moments[6];

  MomentSums() {
    for (auto& row : velocity)
      for (Number& entry : row) entry = Number(0.0);
    for (Number& entry : moments) entry = Number(0.0);
  }
  void add(Number s, const PairVector& x, const PairVector& v) {
    const Number sx[3] = {s * x.x, s * x.y, s * x.z};
    for (int c = 0; c < 3; ++c) {
      velocity[0][c] += sx[c] * v.x;
      velocity[1][c] += sx[c] * v.y;
      velocity[2][c] += sx[c] * v.z;
    }
    moments[0] += sx[0] * x.x, moments[1] += sx[1] * x.y, moments[2] += sx[2] * x.z;
    moments[3] += sx[0] * x.y, moments[4] += sx[1] * x.z, moments[5] += sx[0] * x.z;
  }
  Tensor<double> velocity_sum() const {
    Tensor<double> result;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) result.m[r][c] = sum_of(velocity[r][c]);
    return result;
  }
  SymmetricTensor<double> moment_sum() const {
    return {sum_of(moments[0]), sum_of(moments[1]), sum_of(moments[2]),
            sum_of(moments[3]), sum_of(moments[4]), sum_of(moments[5])};
  }
};

struct OwnSums {
  Tensor<double> velocity, middle_velocity;  ///< sum of s v x^T
  double velocity_squared;
  SymmetricTensor<double> moments, middle_moments;
  double weight, largest_weight;
};

/// Weighs the pairs of a particle anew and sums over them, where they stand and where they stood in the
/// middle of the step.
OwnSums weigh(ParticleCloud& cloud, const Nodes& nodes, std::size_t i, double step) {
  MomentSums now, middle;
  Number velocity_squared(0.0), weight(0.0), largest_weight(0.0);
  const NodeRecord* record = nodes.record.data() + cloud.first_node;
  const Number own_length(cloud.smoothing_length[i]), own_volume(cloud.volume[i]), none(0.0);
  for (int begin = 0; begin < cloud.count[i]; begin += width) {
    const NeighbourPack pack(cloud, i, begin);
    const PairMotion pair(record, i, pack);
    const Number inverse_length = 2.0 / (own_length + pack.gather(cloud.smoothing_length.data()));
    const Number volumes = where(pack.is_pair, own_volume * pack.gather(cloud.volume.data()), none);
    const PairVector x_middle = pair.x - Number(0.5 * step) * pair.v;
    middle.add(volumes * kernel_weight(dot(x_middle, x_middle), inverse_length), x_middle, pair.v);
    const Number s = volumes * kernel_weight(dot(pair.x, pair.x), inverse_length);
    pack.store_weights(s, cloud, i, begin);
    now.add(s, pair.x, pair.v);
    velocity_squared += s * dot(pair.v, pair.v);
    weight += s;
    largest_weight = max(largest_weight, s);
  }
  return {now.velocity_sum(),  middle.velocity_sum(), sum_of(velocity_squared), now.moment_sum(),
          middle.moment_sum(), sum_of(weight),        largest(largest_weight)};
}

bool are_close(const ParticleCloud& cloud, const Nodes& nodes, std::size_t i, std::size_t j) {
  const NodeRecord* record = nodes.record.data() + cloud.first_node;
  const Row4 x = load_row(record[j].position) - load_row(record[i].position);
  const double reach = cloud.smoothing_length[i] + cloud.smoothing_length[j] + cloud.skin;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < reach * reach;
}

template <std::size_t lanes>
void store_lane(const Tensor<double>& a, std::size_t lane, double (&row)[3][3][lanes]) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) row[r][c][lane] = a.m[r][c];
}
template <std::size_t lanes>
void store_lane(const SymmetricTensor<double>& a, std::size_t lane, double (&row)[6][lanes]) {
  const double entry[6] = {a.xx, a.yy, a.zz, a.xy, a.yz, a.xz};
  for (int c = 0; c < 6; ++c) row[c][lane] = entry[c];
}

/// Columns of A or of residual gradients, of a particle and its neighbours together.
struct SummedColumns {
  PairVector column[3];

  SummedColumns(const ParticleForce* force, std::size_t i, const NeighbourPack& pack) {
    for (int c = 0; c < 3; ++c) {
      const double* own = force[i].column[c];
      const PairVector other = pack.gather(force->column[c], force);
      column[c] = {own[0] + other.x, own[1] + other.y, own[2] + other.z};
    }
  }
  PairVector operator*(const PairVector& x) const {
    const auto [a, b, c] = column;
    return {a.x * x.x + b.x * x.y + c.x * x.z, a.y * x.x + b.y * x.y + c.y * x.z,
            a.z * x.x + b.z * x.y + c.z * x.z};
  }
};

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
  cloud.weight = AlignedBuffer<double>(cloud.neighbour.size());
  for (std::size_t i = 0; i < n; ++i) {
    const OwnSums sums = weigh(cloud, nodes, i, 0);
    cloud.largest_gradient_size =
        std::max(cloud.largest_gradient_size,
                 sums.largest_weight * ParticleSupport(sums.moments, cloud.volume[i]).stiffness());
  }
}

void set_neighbours(ParticleCloud& cloud, std::span<const int> first, std::span<const int> candidate,
                    const Nodes& nodes) {
  cloud.pair = {};  // the initial ones are no longer needed
  std::size_t total = 0;
  const auto for_each_pair = [&](std::size_t i, const auto& take) {
    for (int k = first[i]; k < first[i + 1]; ++k) {
      const auto j = index(candidate[index(k)]);
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
    cloud.weight = AlignedBuffer<double>(room);
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::size_t next = cloud.first[i];
    for_each_pair(i, [&](int j) { cloud.neighbour[next++] = j; });
    cloud.count[i] = static_cast<int>(next - cloud.first[i]);
    if (cloud.is_cut(i)) continue;
    const double* x = nodes.record[index(cloud.first_node) + i].position;
    cloud.searched_at[i] = {{x[0], x[1], x[2], cloud.smoothing_length[i]}};
  }
}

void sum_over_neighbours_now(ParticleCloud& cloud, const Nodes& nodes, const int* node, int count,
                             double step, NeighbourSums& sums) {
  for (int lane = 0; lane < count; ++lane) {
    const auto i = index(node[lane] - cloud.first_node);
    const auto at = index(lane);
    const OwnSums own = weigh(cloud, nodes, i, step);
    const ParticleSupport now(own.moments, cloud.volume[i]), middle(own.middle_moments, cloud.volume[i]);
    const SymmetricTensor<double> unbounded = inverse_moments(own.moments);
    cloud.correction[i] = now.inverse();
    store_lane(full(now.raised(own.moments)), at, sums.position);
    store_lane(own.velocity, at, sums.velocity);
    store_lane(middle.velocity_gradient(own.middle_velocity), at, sums.middle_gradient);
    store_lane(own.velocity * full(unbounded), at, sums.residual_gradient);
    store_lane(now.inverse(), at, sums.correction);
    store_lane(now.share(), at, sums.share);
    sums.position_by_velocity[at] = trace(own.velocity);
    sums.velocity_squared[at] = own.velocity_squared;
    sums.volume[at] = cloud.volume[i];
    sums.spacing[at] = cloud.spacing[i];
    sums.hourglass_weight[at] =
        trace(unbounded) > 0
            ? 3 / std::max(trace(own.moments), own.weight * cloud.spacing[i] * cloud.spacing[i])
            : 0;
    sums.weight[at] = own.weight;
    sums.frequency_squared[at] =
        cloud.frequency_squared * (own.largest_weight * now.stiffness() / cloud.largest_gradient_size);
  }
  repeat_last_lane(sums, count);
}

double add_pair_forces_now(ParticleCloud& cloud, Nodes& nodes, const int* node, int count, double repulsion,
                           double step) {
  double work = 0;
  const NodeRecord* record = nodes.record.data() + cloud.first_node;
  const double inverse_shape_at_start = 1 / kernel_shape(1 / cloud.smoothing);
  for (int lane = 0; lane < count; ++lane) {
    const auto i = index(node[lane] - cloud.first_node);
    const Number own_length(cloud.smoothing_length[i]), none(0.0), one(1.0);
    const double own_viscosity = cloud.residual[i].column[0][3];
    PairVector stress{none, none, none}, other{none, none, none};
    for (int begin = 0; begin < cloud.count[i]; begin += width) {
      const NeighbourPack pack(cloud, i, begin);
      const Number s = pack.weights(cloud, i, begin);
      const PairMotion pair(record, i, pack);
      const PairVector stress_force = s * (SummedColumns(cloud.force.data(), i, pack) * pair.x);
      Number viscosity(own_viscosity);
      for (int k = 0; k < width; ++k)
        viscosity.set(k, own_viscosity + cloud.residual[index(pack.index[k])].column[0][3]);
      // Tension along the pair, growing until the two are as close as they stood at the start. Not further:
      // it is the force of no energy, and where it grew to half of the tension, sheets of particles shook
      // themselves apart.
      const Number squared = dot(pair.x, pair.x);
      const LaneMask<double> is_apart = squared > none;
      const Number tension = where(is_apart, dot(stress_force, pair.x) / where(is_apart, squared, one), none);
      const Number length = 0.5 * (own_length + pack.gather(cloud.smoothing_length.data()));
      const Number share = repulsion_share(inverse_shape_at_start * kernel_shape(sqrt(squared) / length));
      const Number push = repulsion * min(share, one) * max(tension, 0.0);
      const PairVector residual_force =
          s * (viscosity * pair.v - SummedColumns(cloud.residual.data(), i, pack) * pair.x) - push * pair.x;
      stress = stress + stress_force;
      other = other + residual_force;
    }
    const Row4 force = sum_of(stress), other_force = sum_of(other);
    NodeVector& last = cloud.pair_force[i];
    const Row4 mean = 0.5 * (load_row(last.component) + other_force);
    const double* v = record[i].velocity;
    work += step * (mean[0] * v[0] + mean[1] * v[1] + mean[2] * v[2]);
    store_row(last.component, other_force);
    double* row = nodes.force[index(node[lane])].component;
    store_row(row, load_row(row) + force + other_force);
  }
  return work;
}

}  // namespace brio
