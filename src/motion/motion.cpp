#include "src/motion/motion.hpp"

#include "src/base/gather.hpp"

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
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const NodeRecord& record = nodes.record[i];
    const Vector x{record.position[0], record.position[1], record.position[2]};
    const double m = nodes.mass[i];
    const Vector p{m * record.velocity[0], m * record.velocity[1], m * record.velocity[2]};
    sum.total.add(x, p);
    const double size = std::sqrt(dot(p, p));
    sum.linear_size += size;
    sum.angular_size += size * std::sqrt(dot(x, x));
    if (nodes.has_rotations())
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum.total.angular[axis] += nodes.rotational_inertia[i] * nodes.angular_velocity[i].component[axis];
  }
  return sum;
}

}  // namespace brio
