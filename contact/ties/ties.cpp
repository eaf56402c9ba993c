#include "contact/ties/ties.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using Rows = const AlignedBuffer<NodeVector>&;

Vector3d row(Rows rows, int node) { return vector_at(rows[index(node)].component); }

void add(AlignedBuffer<NodeVector>& rows, int node, const Vector3d& value) {
  double* sum = rows[index(node)].component;
  for (int i = 0; i < 3; ++i) sum[i] += value[i];
}

void set_components(double* row, const Vector3d& value) {
  for (int i = 0; i < 3; ++i) row[i] = value[i];
}

Vector3d mean_angular_velocity(const Tie& tie, const Nodes& nodes) {
  Vector3d sum{};
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
  const auto node = index(entry);
  nodes.record[node].inverse_mass = nodes.mass[node] > 0 ? 1 / nodes.mass[node] : 0;
  if (nodes.has_rotations())
    nodes.angular_velocity[node].component[3] =
        nodes.rotational_inertia[node] > 0 ? 1 / nodes.rotational_inertia[node] : 0;
}

void move_mass(TiedNode& tied, Nodes& nodes) {
  const Tie& tie = tied.tie;
  const auto node = index(tie.node);
  const std::array<double, 4> share = mass_share(tie);
  tied.mass = nodes.mass[node];
  nodes.mass[node] = 0;
  if (tie.turning) {
    tied.inertia = nodes.rotational_inertia[node] + tied.mass * squared_norm(tie.arm);
    nodes.rotational_inertia[node] = 0;
  }
  set_inverses(nodes, tie.node);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto corner = index(tie.corner[k]);
    nodes.mass[corner] += share[k] * tied.mass;
    if (tie.turning) nodes.rotational_inertia[corner] += share[k] * tied.inertia;
    set_inverses(nodes, tie.corner[k]);
  }
}

std::size_t place_in(std::span<const int> ascending, int node) {
  return index(std::lower_bound(ascending.begin(), ascending.end(), node) - ascending.begin());
}

// Rayleigh's quotient: the highest frequency grows at most by the largest ratio of the energy that masses
// would have where they are tied to the energy that they have on the corners. Of a node that moves as
// sum A_k v_k that energy is at most (sum |A_k|) sum |A_k| v_k^2 m / 2; an arm that turns with angular
// velocities adds the product of v_k and the arm times omega_k.
double largest_energy_ratio(Ties& ties, const Nodes& nodes) {
  ties.bound = ties.own_mass;
  ties.coupling.assign(ties.bound.size(), 0);
  const auto at = [&](int node) { return place_in(ties.concerned, node); };
  for (const TiedNode& tied : ties.node) {
    const Tie& tie = tied.tie;
    const std::array<double, 4> share = largest_share(tie, corners_of(tie, nodes));
    double sum = 0;
    for (double one : share) sum += one;
    const double mass = std::exchange(ties.bound[at(tie.node)], 0);
    for (std::size_t k = 0; k < 4; ++k) {
      ties.bound[at(tie.corner[k])] += sum * share[k] * mass;
      ties.coupling[at(tie.corner[k])] += share[k] * mass * norm(tie.arm);
    }
  }
  double largest = 1;
  for (std::size_t i = 0; i < ties.concerned.size(); ++i) {
    const auto node = index(ties.concerned[i]);
    if (!(nodes.mass[node] > 0)) continue;
    double ratio = ties.bound[i] / nodes.mass[node];
    if (ties.coupling[i] > 0)
      ratio += ties.coupling[i] / std::sqrt(nodes.mass[node] * nodes.rotational_inertia[node]);
    largest = std::max(largest, ratio);
  }
  return largest;
}

void list_concerned(Ties& ties, const Nodes& nodes) {
  ties.concerned.clear();
  for (const TiedNode& tied : ties.node) {
    ties.concerned.push_back(tied.tie.node);
    for (int corner : tied.tie.corner) ties.concerned.push_back(corner);
  }
  std::sort(ties.concerned.begin(), ties.concerned.end());
  ties.concerned.erase(std::unique(ties.concerned.begin(), ties.concerned.end()), ties.concerned.end());
  ties.own_mass.clear();
  ties.own_inertia.clear();
  for (int entry : ties.concerned) {
    const auto node = index(entry);
    ties.own_mass.push_back(nodes.mass[node]);
    ties.own_inertia.push_back(nodes.has_rotations() ? nodes.rotational_inertia[node] : 0);
  }
}

void move_masses(Ties& ties, Nodes& nodes) {
  for (TiedNode& tied : ties.node) {
    move_mass(tied, nodes);
    ties.moved_mass[index(tied.tie.node)] = tied.mass;
  }
  // Weights that sum to one but for rounding take nothing from the step.
  constexpr double rounding = 1e-9;
  const double ratio = largest_energy_ratio(ties, nodes);
  ties.step_share = ratio > 1 + rounding ? 1 / std::sqrt(ratio) : 1;
}

// Where masses are without ties.
void take_back(Ties& ties, Nodes& nodes) {
  for (const TiedNode& tied : ties.node) ties.moved_mass[index(tied.tie.node)] = 0;
  for (std::size_t i = 0; i < ties.concerned.size(); ++i) {
    const auto node = index(ties.concerned[i]);
    nodes.mass[node] = ties.own_mass[i];
    if (nodes.has_rotations()) nodes.rotational_inertia[node] = ties.own_inertia[i];
    set_inverses(nodes, ties.concerned[i]);
  }
}

NodeMotion motion_of(std::span<const int> concerned, const Nodes& nodes) {
  NodeMotion sum;
  for (int entry : concerned) {
    const auto node = index(entry);
    const Vector3d v = brio::velocity(nodes, entry);
    const Vector3d linear = nodes.mass[node] * v;
    sum.energy += 0.5 * dot(v, linear);
    sum.linear += linear;
    sum.angular += cross(position(nodes, entry), linear);
    if (!nodes.has_rotations()) continue;
    const Vector3d rate = row(nodes.angular_velocity, entry);
    const Vector3d spin = nodes.rotational_inertia[node] * rate;
    sum.energy += 0.5 * dot(rate, spin);
    sum.angular += spin;
  }
  return sum;
}

}  // namespace

FaceVertices corners_of(const Tie& tie, const Nodes& nodes) {
  return {position(nodes, tie.corner[0]), position(nodes, tie.corner[1]), position(nodes, tie.corner[2]),
          position(nodes, tie.corner[3])};
}

void number(Ties& ties, std::size_t node_count) {
  ties.of_node.assign(node_count, -1);
  for (std::size_t i = 0; i < ties.node.size(); ++i)
    ties.of_node[index(ties.node[i].tie.node)] = static_cast<int>(i);
}

void condense(Ties& ties, Nodes& nodes) {
  place(ties, nodes, 0);
  list_concerned(ties, nodes);
  ties.moved_mass.assign(nodes.size(), 0);
  move_masses(ties, nodes);
}

NodeMotion release(Ties& ties, Nodes& nodes) {
  const auto marked = [](const TiedNode& tied) { return tied.released; };
  NodeMotion lost;
  if (std::none_of(ties.node.begin(), ties.node.end(), marked)) return lost;
  const NodeMotion before = motion_of(ties.concerned, nodes);
  take_back(ties, nodes);
  for (const TiedNode& tied : ties.node)
    if (tied.released) ties.of_node[index(tied.tie.node)] = -1;
  ties.released += static_cast<std::int64_t>(std::erase_if(ties.node, marked));
  for (std::size_t i = 0; i < ties.node.size(); ++i)
    ties.of_node[index(ties.node[i].tie.node)] = static_cast<int>(i);
  // With the masses without ties still at hand for those that remain, and motion compared over all.
  for (TiedNode& tied : ties.node) move_mass(tied, nodes);
  const NodeMotion after = motion_of(ties.concerned, nodes);
  take_back(ties, nodes);
  list_concerned(ties, nodes);
  move_masses(ties, nodes);
  lost.energy = before.energy - after.energy;
  lost.linear = before.linear - after.linear;
  lost.angular = before.angular - after.angular;
  return lost;
}

Vector3d force_on_face(const TiedNode& tied, double mean_step, const Nodes& nodes) {
  const Vector3d force = row(nodes.force, tied.tie.node);
  if (!(mean_step > 0)) return force;
  return force - tied.mass / mean_step * (brio::velocity(nodes, tied.tie.node) - tied.last_velocity);
}

namespace {

// Direction in which the node comes off: away from the face. A node in the middle of a shell has none.
bool exceeds(const TiedNode& tied, const TiedParts& parts, const Vector3d& force, const Nodes& nodes) {
  const Tie& tie = tied.tie;
  const Vector3d normal = normal_at(tie, corners_of(tie, nodes));
  const double side = tie.turning ? dot(tie.arm, normal) : tie.gap;
  const double along = dot(normal, force);
  const double tension = side < 0 ? -along : side == 0 && tie.turning ? std::abs(along) : along;
  const double shear = norm(force - along * normal);
  return std::pow(std::max(tension, 0.0) / parts.normal_force, 2) + std::pow(shear / parts.shear_force, 2) >=
         1;
}

}  // namespace

std::int64_t mark_failed(Ties& ties, double step, const Nodes& nodes) {
  const double mean_step = 0.5 * (std::exchange(ties.last_step, step) + step);
  std::int64_t count = 0;
  for (TiedNode& tied : ties.node) {
    const TiedParts& parts = ties.found[index(tied.connection)];
    tied.released = parts.can_fail() && exceeds(tied, parts, force_on_face(tied, mean_step, nodes), nodes);
    if (tied.released) ++count;
    if (parts.can_fail()) tied.last_velocity = brio::velocity(nodes, tied.tie.node);
  }
  ties.failed += count;
  return count;
}

void gather_forces(const Ties& ties, Nodes& nodes) {
  for (const TiedNode& tied : ties.node) {
    const Tie& tie = tied.tie;
    const Vector3d force = row(nodes.force, tie.node);
    if (tie.gap != 0) {
      const std::array<Vector3d, 4> share = spread(tie, corners_of(tie, nodes), force);
      for (std::size_t k = 0; k < 4; ++k) add(nodes.force, tie.corner[k], share[k]);
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k) add(nodes.force, tie.corner[k], tie.weight[k] * force);
    if (!tie.turning) continue;
    const Vector3d moment = row(nodes.moment, tie.node) + cross(tie.arm, force);
    for (std::size_t k = 0; k < 4; ++k) add(nodes.moment, tie.corner[k], tie.weight[k] * moment);
  }
}

Vector3d tied_velocity(const Tie& tie, const Nodes& nodes, double step) {
  Vector3d velocity{};
  for (std::size_t k = 0; k < 4; ++k) velocity += tie.weight[k] * brio::velocity(nodes, tie.corner[k]);
  if (tie.turning) {
    const Vector3d rate = mean_angular_velocity(tie, nodes);
    if (!tie.has_arm()) return velocity;
    if (step == 0) return velocity + cross(rate, tie.arm);
    return velocity + (turned_by(step * rate, tie.arm) - tie.arm) / step;
  }
  if (tie.gap == 0) return velocity;
  const FaceVertices now = corners_of(tie, nodes);
  FaceVertices rate;
  for (std::size_t k = 0; k < 4; ++k) rate[k] = brio::velocity(nodes, tie.corner[k]);
  if (step == 0) return velocity + tie.gap * normal_rate(tie, now, rate);
  FaceVertices then = now;
  for (std::size_t k = 0; k < 4; ++k) then[k] += step * rate[k];
  return velocity + tie.gap / step * (normal_at(tie, then) - normal_at(tie, now));
}

void carry_velocities(const Ties& ties, Nodes& nodes, double step) {
  for (std::size_t i = ties.node.size(); i-- > 0;) {
    const Tie& tie = ties.node[i].tie;
    const auto node = index(tie.node);
    set_components(nodes.record[node].velocity, tied_velocity(tie, nodes, step));
    if (tie.turning)
      set_components(nodes.angular_velocity[node].component, mean_angular_velocity(tie, nodes));
  }
}

void place(Ties& ties, Nodes& nodes, double step) {
  for (std::size_t i = ties.node.size(); i-- > 0;) {
    Tie& tie = ties.node[i].tie;
    if (tie.has_arm() && step > 0) tie.arm = turned_by(step * mean_angular_velocity(tie, nodes), tie.arm);
    set_components(nodes.record[index(tie.node)].position, tied_position(tie, corners_of(tie, nodes)));
  }
}

}  // namespace brio
