#pragma once
/// A line of beams, their nodes and a leapfrog: the smallest run there is.

#include "tests/elements/beam/single_beam.hpp"

#include <cmath>
#include <optional>

#include "elements/block.hpp"
#include "src/base/index.hpp"

namespace brio {

inline const Eigen::Vector3d origin = Eigen::Vector3d::Zero();

class BeamModel {
 public:
  Nodes nodes;
  Block block;
  SweepResult last;
  double work = 0;  ///< internal and viscous work so far
  double time = 0;

  /// `count` equal elements from `start` to `end`.
  BeamModel(const Eigen::Vector3d& start, const Eigen::Vector3d& end, int count, const Beam2& beam,
            const Material& material, Precision precision = Precision::double_precision)
      : nodes(index(count) + 1, true),
        load_(nodes.size(), Eigen::Matrix<double, 6, 1>::Zero()),
        given_(6 * nodes.size()) {
    std::vector<int> connectivity;
    for (int e = 0; e < count; ++e) connectivity.insert(connectivity.end(), {e, e + 1});
    block = make_block("beam", beam, material, precision, connectivity);
    for (int n = 0; n <= count; ++n) {
      const Eigen::Vector3d x = start + (end - start) * n / count;
      for (int i = 0; i < 3; ++i) nodes.record[at(n)].position[i] = x[i];
    }
    block.kernel.initialize(block, nodes);
    sweep(0);
  }

  int last_node() const { return static_cast<int>(nodes.size()) - 1; }
  Eigen::Vector3d position(int n) const { return Eigen::Vector3d(nodes.record[at(n)].position); }
  Eigen::Vector3d velocity(int n) const { return Eigen::Vector3d(nodes.record[at(n)].velocity); }
  void set_velocity(int n, const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) nodes.record[at(n)].velocity[i] = v[i];
  }
  Eigen::Vector3d angular_velocity(int n) const {
    return Eigen::Vector3d(nodes.angular_velocity[at(n)].component);
  }
  void set_angular_velocity(int n, const Eigen::Vector3d& w) {
    for (int i = 0; i < 3; ++i) nodes.angular_velocity[at(n)].component[i] = w[i];
  }
  /// Prescribes a velocity: component 0 to 2, or an angular velocity: 3 to 5.
  void drive(int n, int component, double velocity) { given_[6 * at(n) + at(component)] = velocity; }
  void fix(int n, int component) { drive(n, component, 0); }
  void clamp(int n) {
    for (int component = 0; component < 6; ++component) fix(n, component);
  }
  /// Force and moment from outside, from now on.
  void load(int n, const Eigen::Vector3d& force, const Eigen::Vector3d& moment) {
    load_[at(n)] << force, moment;
  }
  /// Of what the beams exert on a node.
  Eigen::Vector3d force(int n) const { return Eigen::Vector3d(nodes.force[at(n)].component); }
  Eigen::Vector3d moment(int n) const { return Eigen::Vector3d(nodes.moment[at(n)].component); }
  double stable_step() const { return last.stable_step; }
  ElementSample sample(int e) const { return block.kernel.sample(block, nodes, at(e), true); }

  void sweep(double step) {
    for (std::size_t n = 0; n < nodes.size(); ++n) nodes.force[n] = nodes.moment[n] = {};
    last = block.kernel.sweep(block, {0, block.pack_count, block.element_count}, nodes, step);
    work += last.internal_energy + last.viscous_energy;
  }

  /// Forces stand; one step of `step`. The first is a start from velocities at time 0.
  /// \param keep share of the velocities that is kept: below 1 to come to rest
  void advance(double step, double keep = 1) {
    const double mean = 0.5 * (previous_step_ + step);
    kinetic_energy_ = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (std::size_t i = 0; i < 3; ++i) {
        NodeRecord& record = nodes.record[n];
        double& w = nodes.angular_velocity[n].component[i];
        const auto axis = static_cast<Eigen::Index>(i);
        const double v_before = record.velocity[i];
        const double w_before = w;
        record.velocity[i] =
            keep * record.velocity[i] + mean * (nodes.force[n].component[i] + load_[n][axis]) / nodes.mass[n];
        if (nodes.rotational_inertia[n] > 0)
          w = keep * w +
              mean * (nodes.moment[n].component[i] + load_[n][axis + 3]) / nodes.rotational_inertia[n];
        if (given_[6 * n + i]) record.velocity[i] = *given_[6 * n + i];
        if (given_[6 * n + 3 + i]) w = *given_[6 * n + 3 + i];
        kinetic_energy_ += 0.5 * (nodes.mass[n] * v_before * record.velocity[i] +
                                  nodes.rotational_inertia[n] * w_before * w);
        record.position[i] += step * record.velocity[i];
      }
    previous_step_ = step;
    time += step;
    sweep(step);
  }

  /// At the time of the last forces but one, from the velocities before and after: with the work of that
  /// time it is what a leapfrog keeps exactly where forces are linear.
  double kinetic_energy() const { return kinetic_energy_; }
  Eigen::Vector3d angular_momentum() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int n = 0; n <= last_node(); ++n)
      sum += nodes.mass[at(n)] * position(n).cross(velocity(n)) +
             nodes.rotational_inertia[at(n)] * angular_velocity(n);
    return sum;
  }

 private:
  static std::size_t at(int n) { return index(n); }

  std::vector<Eigen::Matrix<double, 6, 1>> load_;
  std::vector<std::optional<double>> given_;
  double previous_step_ = 0;
  double kinetic_energy_ = 0;
};

}  // namespace brio
