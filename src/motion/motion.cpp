#include "src/motion/motion.hpp"

#include <algorithm>

#include "src/base/gather.hpp"
#include "src/base/lanes.hpp"
#include "src/base/tensor.hpp"
#include "src/domains/node_ranges.hpp"

namespace brio {

namespace {

constexpr Row4 first_three{1, 1, 1, 0};

double sum3(Row4 row) { return row[0] + row[1] + row[2]; }

KineticEnergy total(std::span<const KineticEnergy> sums) {
  KineticEnergy energy;
  for (const KineticEnergy& sum : sums) {
    energy.half += sum.half;
    energy.now += sum.now;
  }
  return energy;
}

KineticEnergy accelerate_range(Nodes& nodes, double mean_step, std::size_t begin, std::size_t end) {
  Row4 half{}, now{};
  const bool keep = !nodes.velocity_before.empty();
  for (std::size_t i = begin; i < end; ++i) {
    double* row = nodes.record[i].velocity;  // x y z and the inverse mass
    const Row4 before = load_row(row);
    const Row4 after = before + load_row(nodes.force[i].component) * (before[3] * mean_step * first_three);
    store_row(row, after);
    if (keep) store_row(nodes.velocity_before[i].component, before);
    half += after * after * nodes.mass[i];
    now += before * after * nodes.mass[i];
  }
  return {0.5 * sum3(half), 0.5 * sum3(now)};
}

KineticEnergy turn_range(Nodes& nodes, double mean_step, std::size_t begin, std::size_t end) {
  Row4 half{}, now{};
  const bool keep = !nodes.angular_velocity_before.empty();
  for (std::size_t i = begin; i < end; ++i) {
    double* row = nodes.angular_velocity[i].component;
    const Row4 before = load_row(row);
    const Row4 after = before + load_row(nodes.moment[i].component) * (before[3] * mean_step * first_three);
    store_row(row, after);
    if (keep) store_row(nodes.angular_velocity_before[i].component, before);
    half += after * after * nodes.rotational_inertia[i];
    now += before * after * nodes.rotational_inertia[i];
  }
  return {0.5 * sum3(half), 0.5 * sum3(now)};
}

KineticEnergy energy_of_range(const Nodes& nodes, std::size_t begin, std::size_t end) {
  Row4 half{}, now{};
  for (std::size_t i = begin; i < end; ++i) {
    const Row4 after = load_row(nodes.record[i].velocity);
    half += after * after * nodes.mass[i];
    now += after * load_row(nodes.velocity_before[i].component) * nodes.mass[i];
  }
  if (nodes.has_rotations()) {
    for (std::size_t i = begin; i < end; ++i) {
      const Row4 after = load_row(nodes.angular_velocity[i].component);
      const Row4 before = load_row(nodes.angular_velocity_before[i].component);
      half += after * after * nodes.rotational_inertia[i];
      now += before * after * nodes.rotational_inertia[i];
    }
  }
  return {0.5 * sum3(half), 0.5 * sum3(now)};
}

}  // namespace

KineticEnergy accelerate(Nodes& nodes, double mean_step, std::vector<KineticEnergy>& sums, ThreadTeam& team) {
  sum_node_ranges(nodes, sums, team, [&](std::size_t begin, std::size_t end) {
    KineticEnergy sum = accelerate_range(nodes, mean_step, begin, end);
    if (nodes.has_rotations()) {
      const KineticEnergy turning = turn_range(nodes, mean_step, begin, end);
      sum.half += turning.half;
      sum.now += turning.now;
    }
    return sum;
  });
  return total(sums);
}

KineticEnergy kinetic_energy(const Nodes& nodes, std::vector<KineticEnergy>& sums, ThreadTeam& team) {
  sum_node_ranges(nodes, sums, team,
                  [&](std::size_t begin, std::size_t end) { return energy_of_range(nodes, begin, end); });
  return total(sums);
}

void move(Nodes& nodes, double step, ThreadTeam& team) {
  for_node_ranges(nodes, team, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      NodeRecord& record = nodes.record[i];
      store_row(record.position,
                load_row(record.position) + load_row(record.velocity) * Row4{step, step, step, 0});
      store_row(nodes.force[i].component, Row4{});
    }
    if (nodes.has_rotations())
      for (std::size_t i = begin; i < end; ++i) store_row(nodes.moment[i].component, Row4{});
  });
}

namespace {

using Eight = Lanes<double>;

double sum_of(Eight lanes) {
  double sum = 0;
  for (int lane = 0; lane < 8; ++lane) sum += lanes[lane];
  return sum;
}
Vector3d sum_of(const Vector3<Eight>& lanes) { return {sum_of(lanes.x), sum_of(lanes.y), sum_of(lanes.z)}; }

// Of rows of 4 numbers.
Vector3<Eight> in_lanes(const Row4 (&rows)[8]) {
  Row8 x, y, z, fourth;
  transpose_rows(rows, x, y, z, fourth);
  return {Eight(x), Eight(y), Eight(z)};
}

}  // namespace

Momentum momentum(const Nodes& nodes) { return momentum(nodes, 0, nodes.size()); }

Momentum momentum(const Nodes& nodes, std::size_t first, std::size_t end) {
  Vector3<Eight> linear{0.0, 0.0, 0.0}, angular{0.0, 0.0, 0.0}, spin{0.0, 0.0, 0.0};
  Eight linear_size(0.0), angular_size(0.0);
  for (std::size_t begin = first; begin < end; begin += 8) {
    Row4 position[8]{}, impulse[8]{}, turning[8]{};
    for (std::size_t k = 0; k < std::min<std::size_t>(8, end - begin); ++k) {
      const std::size_t i = begin + k;
      position[k] = load_row(nodes.record[i].position);
      impulse[k] = nodes.mass[i] * load_row(nodes.record[i].velocity);
      if (nodes.has_rotations())
        turning[k] = nodes.rotational_inertia[i] * load_row(nodes.angular_velocity[i].component);
    }
    const Vector3<Eight> x = in_lanes(position), p = in_lanes(impulse);
    linear = linear + p;
    angular = angular + cross(x, p);
    if (nodes.has_rotations()) spin = spin + in_lanes(turning);
    const Eight size = sqrt(dot(p, p));
    linear_size += size;
    angular_size += size * sqrt(dot(x, x));
  }
  return {{sum_of(linear), sum_of(angular + spin)}, sum_of(linear_size), sum_of(angular_size)};
}

}  // namespace brio
