#pragma once
/// A few shells, their nodes and a leapfrog: the smallest run there is.

#include "tests/elements/shell/shell_statics.hpp"

#include <cmath>
#include <numeric>

#include "elements/block.hpp"
#include "src/base/index.hpp"

namespace brio {

class ShellModel {
 public:
  Nodes nodes;
  Block block;
  SweepResult last;
  double work = 0;  ///< internal, hourglass and viscous work so far
  double time = 0;

  ShellModel(const ShellMesh& mesh, const Shell4& shell, const Material& material,
             Precision precision = Precision::double_precision)
      : nodes(mesh.point.size(), true), fixed_(6 * mesh.point.size(), false) {
    std::vector<int> connectivity;
    for (const auto& element : mesh.element)
      connectivity.insert(connectivity.end(), element.begin(), element.end());
    block = make_block("shell", shell, material, precision, connectivity);
    for (std::size_t n = 0; n < mesh.point.size(); ++n)
      for (int i = 0; i < 3; ++i) nodes.record[n].position[i] = mesh.point[n][i];
    block.kernel.initialize(block, nodes);
    sweep(0);
  }

  Eigen::Vector3d position(int n) const { return Eigen::Vector3d(record(n).position); }
  Eigen::Vector3d velocity(int n) const { return Eigen::Vector3d(record(n).velocity); }
  void set_velocity(int n, const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) nodes.record[at(n)].velocity[i] = v[i];
  }
  Eigen::Vector3d angular_velocity(int n) const {
    return Eigen::Vector3d(nodes.angular_velocity[at(n)].component);
  }
  void set_angular_velocity(int n, const Eigen::Vector3d& w) {
    for (int i = 0; i < 3; ++i) nodes.angular_velocity[at(n)].component[i] = w[i];
  }
  void fix(int n, int component) { fixed_[6 * at(n) + at(component)] = true; }
  Eigen::Vector3d force(int n) const { return Eigen::Vector3d(nodes.force[at(n)].component); }
  Eigen::Vector3d moment(int n) const { return Eigen::Vector3d(nodes.moment[at(n)].component); }
  double stable_step() const { return last.stable_step; }
  ElementSample sample(int e) const { return block.kernel.sample(block, nodes, at(e), true); }

  void sweep(double step) {
    for (std::size_t n = 0; n < nodes.size(); ++n) nodes.force[n] = nodes.moment[n] = {};
    last = block.kernel.sweep(block, {0, block.pack_count, block.element_count}, nodes, step);
    work += last.internal_energy + last.hourglass_energy + last.viscous_energy;
  }

  /// Forces stand; one step of `step`. The first is a start from velocities at time 0.
  void advance(double step) {
    const double mean = 0.5 * (previous_step_ + step);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (std::size_t i = 0; i < 3; ++i) {
        NodeRecord& record = nodes.record[n];
        double& w = nodes.angular_velocity[n].component[i];
        record.velocity[i] += mean * nodes.force[n].component[i] / nodes.mass[n];
        w += mean * nodes.moment[n].component[i] / nodes.rotational_inertia[n];
        if (fixed_[6 * n + i]) record.velocity[i] = 0;
        if (fixed_[6 * n + 3 + i]) w = 0;
        record.position[i] += step * record.velocity[i];
      }
    previous_step_ = step;
    time += step;
    sweep(step);
  }

  /// With the velocities of the last half step.
  double kinetic_energy() const {
    double sum = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (std::size_t i = 0; i < 3; ++i)
        sum += 0.5 * nodes.mass[n] * square(nodes.record[n].velocity[i]) +
               0.5 * nodes.rotational_inertia[n] * square(nodes.angular_velocity[n].component[i]);
    return sum;
  }

 private:
  static std::size_t at(int n) { return index(n); }
  const NodeRecord& record(int n) const { return nodes.record[at(n)]; }

  std::vector<bool> fixed_;
  double previous_step_ = 0;
};

/// A flat rectangle a x b with inner nodes moved by up to `distortion` of an element.
inline ShellMesh rectangle(double a, double b, int first, int second, double distortion = 0) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-distortion, distortion);
  return mapped_grid(first, second, [&](double s, double t) {
    const bool inside = s > 0 && s < 1 && t > 0 && t < 1;
    return Eigen::Vector3d(a * (s + (inside ? u(random) / first : 0)),
                           b * (t + (inside ? u(random) / second : 0)), 0);
  });
}

}  // namespace brio
