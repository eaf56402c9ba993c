#pragma once
/// One beam element driven by hand: the kernel on plain doubles.

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "elements/beam/beam2_kernel.hpp"
#include "src/base/index.hpp"
#include "tests/elements/steel.hpp"

namespace brio {

using Pair = std::array<Eigen::Vector3d, 2>;

/// Without viscosity.
inline Beam2 beam_of(const BeamSection& section, const Eigen::Vector3d& orientation) {
  Beam2 beam;
  beam.section = section;
  beam.orientation = {orientation[0], orientation[1], orientation[2]};
  beam.linear_bulk_viscosity = 0;
  return beam.prepared();
}

template <class Law = Elastic>
struct SingleBeam {
  Beam2Kernel beam;
  Law law;
  Beam2Kernel::Header<double, Law> header{};
  std::vector<Beam2Kernel::Point<double, Law>> points;
  NodalMass<double> mass{};
  Increment<double> increment{};
  RotatingNodalForces<double, 2> nodal{};
  Pair position;

  SingleBeam(const Beam2& element, const Law& material, const Pair& x)
      : beam{element}, law(material), points(index(beam.points())), position(x) {
    mass = beam.initialize(motion({none(), none()}), law, header, points.data());
  }

  static Eigen::Vector3d none() { return Eigen::Vector3d::Zero(); }

  RotatingNodalMotion<double, 2> motion(const Pair& w) const {
    RotatingNodalMotion<double, 2> m;
    for (int n = 0; n < 2; ++n)
      for (int i = 0; i < 3; ++i) {
        const auto k = index(n);
        m.position[i][n] = position[k][i] - position[0][i];
        m.velocity[i][n] = 0;  // positions and turns say it all
        m.angular_velocity[i][n] = w[k][i];
      }
    return m;
  }

  /// Nodes to positions `x`, turned further by `turn`; one step of length `step`.
  void move(const Pair& x, const Pair& turn, double step = 1) {
    position = x;
    increment = beam.force(motion({turn[0] / step, turn[1] / step}), step, law, header, points.data(), nodal);
  }
  Eigen::Vector3d force(int n) const { return {nodal.force[0][n], nodal.force[1][n], nodal.force[2][n]}; }
  Eigen::Vector3d moment(int n) const { return {nodal.moment[0][n], nodal.moment[1][n], nodal.moment[2][n]}; }
  /// Forces of both nodes, then moments.
  Eigen::Matrix<double, 12, 1> all() const {
    Eigen::Matrix<double, 12, 1> f;
    f << force(0), force(1), moment(0), moment(1);
    return f;
  }
  double plastic_strain() const {
    double most = 0;
    for (const auto& point : points) most = std::max(most, point.history.equivalent_plastic_strain);
    return most;
  }
  ElementSample sample() const { return beam.sample(motion({none(), none()}), law, header, points.data()); }
};

/// Tangent stiffness about the present state: 6 translations, then 6 rotations, by central differences.
template <class Law>
Eigen::Matrix<double, 12, 12> stiffness_of(const SingleBeam<Law>& state, double small) {
  Eigen::Matrix<double, 12, 12> stiffness;
  for (int column = 0; column < 12; ++column) {
    Eigen::Matrix<double, 12, 1> difference = Eigen::Matrix<double, 12, 1>::Zero();
    for (const double sign : {1.0, -1.0}) {
      SingleBeam<Law> element = state;
      Pair x = state.position;
      Pair turn = {SingleBeam<Law>::none(), SingleBeam<Law>::none()};
      (column < 6 ? x : turn)[index(column % 6 / 3)][column % 3] += sign * small;
      element.move(x, turn);
      difference += sign * element.all();
    }
    stiffness.col(column) = difference / (2 * small);
  }
  return stiffness;
}

}  // namespace brio
