#include "src/motion/loads.hpp"

#include "src/base/index.hpp"

namespace brio {

namespace {

void forces_of(const GravityLoad& load, double time, const Nodes& nodes, std::vector<NodeForce>& applied) {
  const double factor = load.factor(time);
  applied.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    applied[i].node = static_cast<int>(i);
    for (std::size_t axis = 0; axis < 3; ++axis)
      applied[i].force[axis] = nodes.mass[i] * factor * load.acceleration[axis];
  }
}

void forces_of(const NodalLoad& load, double time, const Nodes&, std::vector<NodeForce>& applied) {
  const double factor = load.factor(time);
  applied.resize(load.nodes.size());
  for (std::size_t i = 0; i < load.nodes.size(); ++i) {
    applied[i].node = load.nodes[i];
    const Vector3d& force = load.own_force.empty() ? load.force : load.own_force[i];
    for (std::size_t axis = 0; axis < 3; ++axis) applied[i].force[axis] = factor * force[axis];
  }
}

// Consistent forces of a uniform pressure on a bilinear side: integral of N_k (x_xi cross x_eta). With the
// parallelogram part n0 and the linear variation of the normal along both edges it is exact for warped sides.
void forces_of(const PressureLoad& load, double time, const Nodes& nodes, std::vector<NodeForce>& applied) {
  const bool varies = load.pressure.varies_in_space;
  double pressure = varies ? 0 : load.pressure(time);
  applied.resize(4 * load.sides.size());
  constexpr std::array<std::array<double, 2>, 4> corner{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t s = 0; s < load.sides.size(); ++s) {
    Vector3d along_xi{}, along_eta{}, twist{}, centre{};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3d x = position(nodes, load.sides[s][k]);
      for (std::size_t i = 0; i < 3; ++i) {
        along_xi[i] += 0.25 * corner[k][0] * x[i];
        along_eta[i] += 0.25 * corner[k][1] * x[i];
        twist[i] += 0.25 * corner[k][0] * corner[k][1] * x[i];
        centre[i] += 0.25 * x[i];
      }
    }
    if (varies) pressure = load.pressure.at(centre, time);
    const Vector3d normal = cross(along_xi, along_eta);
    const Vector3d with_xi = cross(along_xi, twist);    // coefficient of xi in the area vector
    const Vector3d with_eta = cross(twist, along_eta);  // coefficient of eta
    for (std::size_t k = 0; k < 4; ++k) {
      NodeForce& entry = applied[4 * s + k];
      entry.node = load.sides[s][k];
      for (std::size_t i = 0; i < 3; ++i)
        entry.force[i] =
            -pressure * (normal[i] + (corner[k][0] * with_xi[i] + corner[k][1] * with_eta[i]) / 3);
    }
  }
}

}  // namespace

void apply(ActiveLoad& load, double time, Nodes& nodes) {
  std::visit([&](const auto& kind) { forces_of(kind, time, nodes, load.applied); }, load.load);
  AlignedBuffer<NodeVector>& sum = load.is_moment() ? nodes.moment : nodes.force;
  for (const NodeForce& entry : load.applied)
    for (std::size_t i = 0; i < 3; ++i) sum[index(entry.node)].component[i] += entry.force[i];
}

double power(const ActiveLoad& load, const Nodes& nodes) {
  double sum = 0;
  const bool is_moment = load.is_moment();
  for (const NodeForce& entry : load.applied) {
    const auto node = index(entry.node);
    const double* v = is_moment ? nodes.angular_velocity[node].component : nodes.record[node].velocity;
    sum += entry.force[0] * v[0] + entry.force[1] * v[1] + entry.force[2] * v[2];
  }
  return sum;
}

Impulse resultant(const ActiveLoad& load, const Nodes& nodes) {
  Impulse sum;
  const bool is_moment = load.is_moment();
  for (const NodeForce& entry : load.applied) {
    if (is_moment)
      sum.angular += entry.force;
    else
      sum.add(position(nodes, entry.node), entry.force);
  }
  return sum;
}

}  // namespace brio
