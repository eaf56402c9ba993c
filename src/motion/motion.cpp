#include "src/motion/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/base/gather.hpp"

namespace brio {

namespace {

constexpr Row4 first_three{1, 1, 1, 0};

// Of the first three.
Row4 cross(Row4 a, Row4 b) {
  const auto next = [](Row4 row) { return __builtin_shufflevector(row, row, 1, 2, 0, 3); };
  const auto last = [](Row4 row) { return __builtin_shufflevector(row, row, 2, 0, 1, 3); };
  return next(a) * last(b) - last(a) * next(b);
}

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

KineticEnergy accelerate(Nodes& nodes, double mean_step, std::span<KineticEnergy> sums, ThreadTeam& team) {
  team.for_ranges(nodes.size(), nodes_per_range, [&](std::size_t begin, std::size_t end) {
    KineticEnergy& sum = sums[begin / nodes_per_range];
    sum = accelerate_range(nodes, mean_step, begin, end);
    if (nodes.has_rotations()) {
      const KineticEnergy turning = turn_range(nodes, mean_step, begin, end);
      sum.half += turning.half;
      sum.now += turning.now;
    }
  });
  return total(sums);
}

KineticEnergy kinetic_energy(const Nodes& nodes, std::span<KineticEnergy> sums, ThreadTeam& team) {
  team.for_ranges(nodes.size(), nodes_per_range, [&](std::size_t begin, std::size_t end) {
    sums[begin / nodes_per_range] = energy_of_range(nodes, begin, end);
  });
  return total(sums);
}

void move(Nodes& nodes, double step, ThreadTeam& team) {
  team.for_ranges(nodes.size(), nodes_per_range, [&](std::size_t begin, std::size_t end) {
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

Momentum momentum(const Nodes& nodes) {
  Momentum sum;
  Row4 linear{}, angular{};
  constexpr std::size_t most = 256;  // nodes at a time: roots are taken in lanes
  std::array<double, most> linear_size, angular_size;
  for (std::size_t begin = 0; begin < nodes.size(); begin += most) {
    const std::size_t count = std::min(most, nodes.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + k;
      const Row4 x = load_row(nodes.record[i].position),
                 p = nodes.mass[i] * load_row(nodes.record[i].velocity);
      linear += p;
      angular += cross(x, p);
      linear_size[k] = sum3(p * p);
      angular_size[k] = linear_size[k] * sum3(x * x);
    }
    for (std::size_t k = 0; k < count; ++k) {
      linear_size[k] = std::sqrt(linear_size[k]);
      angular_size[k] = std::sqrt(angular_size[k]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      sum.linear_size += linear_size[k];
      sum.angular_size += angular_size[k];
    }
  }
  if (nodes.has_rotations())
    for (std::size_t i = 0; i < nodes.size(); ++i)
      angular += nodes.rotational_inertia[i] * load_row(nodes.angular_velocity[i].component);
  sum.total = {{linear[0], linear[1], linear[2]}, {angular[0], angular[1], angular[2]}};
  return sum;
}

}  // namespace brio
