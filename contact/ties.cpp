#include "contact/ties.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace brio {

using Eigen::Vector3d;

namespace {

using Rows = const AlignedBuffer<NodeVector>&;

Vector3d position_of(const Nodes& nodes, int node) {
  return Vector3d(nodes.record[static_cast<std::size_t>(node)].position);
}
Vector3d velocity_of(const Nodes& nodes, int node) {
  return Vector3d(nodes.record[static_cast<std::size_t>(node)].velocity);
}
Vector3d row(Rows rows, int node) { return Vector3d(rows[static_cast<std::size_t>(node)].component); }

void add(AlignedBuffer<NodeVector>& rows, int node, const Vector3d& value) {
  double* sum = rows[static_cast<std::size_t>(node)].component;
  for (int i = 0; i < 3; ++i) sum[i] += value[i];
}

void set_components(double* row, const Vector3d& value) {
  for (int i = 0; i < 3; ++i) row[i] = value[i];
}

Vector3d mean_angular_velocity(const Tie& tie, const Nodes& nodes) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) sum += tie.weight[k] * row(nodes.angular_velocity, tie.corner[k]);
  return sum;
}

/// Shares of the mass: the weights, but for what lies beyond an edge.
std::array<double, 4> mass_share(const Tie& tie) {
  std::array<double, 4> share{};
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += share[k] = std::max(tie.weight[k], 0.0);
  for (double& one : share) one /= sum;
  return share;
}

void set_inverses(Nodes& nodes, int entry) {
  const auto node = static_cast<std::size_t>(entry);
  nodes.record[node].inverse_mass = nodes.mass[node] > 0 ? 1 / nodes.mass[node] : 0;
  if (nodes.has_rotations())
    nodes.angular_velocity[node].component[3] =
        nodes.rotational_inertia[node] > 0 ? 1 / nodes.rotational_inertia[node] : 0;
}

void move_mass(TiedNode& held, Nodes& nodes) {
  const Tie& tie = held.tie;
  const auto node = static_cast<std::size_t>(tie.node);
  const std::array<double, 4> share = mass_share(tie);
  held.mass = nodes.mass[node];
  nodes.mass[node] = 0;
  if (tie.turning) {
    held.inertia = nodes.rotational_inertia[node] + held.mass * tie.arm.squaredNorm();
    nodes.rotational_inertia[node] = 0;
  }
  set_inverses(nodes, tie.node);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto corner = static_cast<std::size_t>(tie.corner[k]);
    nodes.mass[corner] += share[k] * held.mass;
    if (tie.turning) nodes.rotational_inertia[corner] += share[k] * held.inertia;
    set_inverses(nodes, tie.corner[k]);
  }
}

// Rayleigh's quotient: the highest frequency grows at most by the largest ratio of the energy that masses
// would have where they are held to the energy that they have on the corners. Of a node that moves as
// sum A_k v_k that energy is at most (sum |A_k|) sum |A_k| v_k^2 m / 2; an arm that turns with angular
// velocities adds the product of v_k and the arm times omega_k.
double largest_energy_ratio(const Ties& ties, const Nodes& nodes, std::span<const double> own_mass) {
  std::vector<double> bound(own_mass.begin(), own_mass.end());
  std::vector<double> coupling(own_mass.size(), 0);
  for (const TiedNode& held : ties.node) {
    const Tie& tie = held.tie;
    const std::array<double, 4> share = largest_share(tie, corners_of(tie, nodes));
    double sum = 0;
    for (double one : share) sum += one;
    const double mass = bound[static_cast<std::size_t>(tie.node)];
    for (std::size_t k = 0; k < 4; ++k) {
      const auto corner = static_cast<std::size_t>(tie.corner[k]);
      bound[corner] += sum * share[k] * mass;
      coupling[corner] += share[k] * mass * tie.arm.norm();
    }
    bound[static_cast<std::size_t>(tie.node)] = 0;
  }
  double largest = 1;
  for (const TiedNode& held : ties.node)
    for (int entry : held.tie.corner) {
      const auto corner = static_cast<std::size_t>(entry);
      if (!(nodes.mass[corner] > 0)) continue;
      double ratio = bound[corner] / nodes.mass[corner];
      if (coupling[corner] > 0)
        ratio += coupling[corner] / std::sqrt(nodes.mass[corner] * nodes.rotational_inertia[corner]);
      largest = std::max(largest, ratio);
    }
  return largest;
}

Vector3d held_velocity(const Tie& tie, const Nodes& nodes, double step) {
  Vector3d velocity = Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) velocity += tie.weight[k] * velocity_of(nodes, tie.corner[k]);
  if (tie.turning) {
    const Vector3d rate = mean_angular_velocity(tie, nodes);
    if (!tie.has_arm()) return velocity;
    if (step == 0) return velocity + rate.cross(tie.arm);
    return velocity + (turned_by(step * rate, tie.arm) - tie.arm) / step;
  }
  if (tie.gap == 0 || step == 0) return velocity;
  const FaceVertices now = corners_of(tie, nodes);
  FaceVertices then = now;
  for (std::size_t k = 0; k < 4; ++k) then[k] += step * velocity_of(nodes, tie.corner[k]);
  return velocity + tie.gap / step * (normal_at(tie, then) - normal_at(tie, now));
}

}  // namespace

FaceVertices corners_of(const Tie& tie, const Nodes& nodes) {
  return {position_of(nodes, tie.corner[0]), position_of(nodes, tie.corner[1]),
          position_of(nodes, tie.corner[2]), position_of(nodes, tie.corner[3])};
}

void number(Ties& ties, std::size_t node_count) {
  ties.of_node.assign(node_count, -1);
  for (std::size_t i = 0; i < ties.node.size(); ++i)
    ties.of_node[static_cast<std::size_t>(ties.node[i].tie.node)] = static_cast<int>(i);
}

void condense(Ties& ties, Nodes& nodes) {
  const std::vector<double> own_mass(nodes.mass.begin(), nodes.mass.end());
  place(ties, nodes, 0);
  ties.moved_mass.assign(nodes.size(), 0);
  for (TiedNode& held : ties.node) {
    move_mass(held, nodes);
    ties.moved_mass[static_cast<std::size_t>(held.tie.node)] = held.mass;
  }
  // Weights that sum to one but for rounding take nothing from the step.
  constexpr double rounding = 1e-9;
  const double ratio = largest_energy_ratio(ties, nodes, own_mass);
  ties.step_share = ratio > 1 + rounding ? 1 / std::sqrt(ratio) : 1;
}

void gather_forces(const Ties& ties, Nodes& nodes) {
  for (const TiedNode& held : ties.node) {
    const Tie& tie = held.tie;
    const Vector3d force = row(nodes.force, tie.node);
    if (tie.gap != 0) {
      const std::array<Vector3d, 4> share = spread(tie, corners_of(tie, nodes), force);
      for (std::size_t k = 0; k < 4; ++k) add(nodes.force, tie.corner[k], share[k]);
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k) add(nodes.force, tie.corner[k], tie.weight[k] * force);
    if (!tie.turning) continue;
    const Vector3d moment = row(nodes.moment, tie.node) + tie.arm.cross(force);
    for (std::size_t k = 0; k < 4; ++k) add(nodes.moment, tie.corner[k], tie.weight[k] * moment);
  }
}

void carry_velocities(const Ties& ties, Nodes& nodes, double step) {
  for (std::size_t i = ties.node.size(); i-- > 0;) {
    const Tie& tie = ties.node[i].tie;
    const auto node = static_cast<std::size_t>(tie.node);
    set_components(nodes.record[node].velocity, held_velocity(tie, nodes, step));
    if (tie.turning)
      set_components(nodes.angular_velocity[node].component, mean_angular_velocity(tie, nodes));
  }
}

void place(Ties& ties, Nodes& nodes, double step) {
  for (std::size_t i = ties.node.size(); i-- > 0;) {
    Tie& tie = ties.node[i].tie;
    if (tie.has_arm() && step > 0) tie.arm = turned_by(step * mean_angular_velocity(tie, nodes), tie.arm);
    set_components(nodes.record[static_cast<std::size_t>(tie.node)].position,
                   held_position(tie, corners_of(tie, nodes)));
  }
}

}  // namespace brio
