#pragma once
/// One shell element driven by hand: the kernel on plain doubles.

#include <Eigen/Dense>
#include <array>
#include <random>
#include <vector>

#include "elements/shell/shell4_kernel.hpp"
#include "src/base/index.hpp"
#include "tests/elements/steel.hpp"

namespace brio {

using Points4 = std::array<Eigen::Vector3d, 4>;

template <class Law = Elastic>
struct SingleShell {
  Shell4Kernel shell;
  Law law;
  Shell4Kernel::Header<double, Law> header{};
  std::vector<Shell4Kernel::Point<double, Law>> points;
  NodalMass<double> mass{};
  Increment<double> increment{};
  RotatingNodalForces<double, 4> nodal{};
  Points4 position;

  SingleShell(const Shell4& element, const Law& material, const Points4& x)
      : shell{element}, law(material), points(index(shell.points())), position(x) {
    mass = shell.initialize(motion(x, {}, {}), law, header, points.data());
  }

  static Points4 none() {
    return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
            Eigen::Vector3d::Zero()};
  }

  static RotatingNodalMotion<double, 4> motion(const Points4& x, const std::array<Eigen::Vector3d, 4>& v,
                                               const std::array<Eigen::Vector3d, 4>& w) {
    RotatingNodalMotion<double, 4> m;
    for (int n = 0; n < 4; ++n)
      for (int i = 0; i < 3; ++i) {
        const auto k = index(n);
        m.position[i][n] = x[k][i] - x[0][i];
        m.velocity[i][n] = v[k][i] - v[0][i];
        m.angular_velocity[i][n] = w[k][i];
      }
    return m;
  }

  /// Internal forces at positions `x` reached with velocities `v` and `w` over `step`.
  void move(const Points4& x, const Points4& v, const Points4& w, double step) {
    position = x;
    increment = shell.force(motion(x, v, w), step, law, header, points.data(), nodal);
  }
  Eigen::Vector3d force(int n) const { return {nodal.force[0][n], nodal.force[1][n], nodal.force[2][n]}; }
  Eigen::Vector3d moment(int n) const { return {nodal.moment[0][n], nodal.moment[1][n], nodal.moment[2][n]}; }
  double plastic_strain() const {
    double most = 0;
    for (const auto& point : points) most = std::max(most, point.history.equivalent_plastic_strain);
    return most;
  }
  ElementSample sample() const {
    return shell.sample(motion(position, none(), none()), law, header, points.data());
  }
};

/// Tangent stiffness of an undeformed element: 12 translations, then 12 rotations; from forces of unit
/// velocities over a step so short that the geometry does not change.
inline Eigen::Matrix<double, 24, 24> stiffness_of(Shell4 shell, const Elastic& law, const Points4& x) {
  shell.linear_bulk_viscosity = shell.drilling_viscosity = 0;  // viscous forces do not scale with the step
  const SingleShell<> reference(shell, law, x);
  constexpr double step = 1e-30;
  Eigen::Matrix<double, 24, 24> stiffness;
  for (int column = 0; column < 24; ++column) {
    SingleShell<> element = reference;
    Points4 v = SingleShell<>::none();
    Points4 w = SingleShell<>::none();
    (column < 12 ? v : w)[index(column % 12 / 3)][column % 3] = 1;
    element.move(x, v, w, step);
    for (int n = 0; n < 4; ++n) {
      stiffness.block<3, 1>(3 * n, column) = element.force(n) / step;
      stiffness.block<3, 1>(12 + 3 * n, column) = element.moment(n) / step;
    }
  }
  return stiffness;
}

/// A quadrilateral of side about `side`: corners moved by up to `distortion` sides in the plane and `warp`
/// sides out of it, then turned at random.
inline Points4 random_quadrilateral(std::mt19937& random, double side, double aspect, double distortion,
                                    double warp) {
  std::uniform_real_distribution<double> u(-1, 1);
  Points4 x = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(side * aspect, 0, 0),
               Eigen::Vector3d(side * aspect, side, 0), Eigen::Vector3d(0, side, 0)};
  const Eigen::Quaterniond turn = Eigen::Quaterniond(u(random), u(random), u(random), u(random)).normalized();
  for (Eigen::Vector3d& p : x) {
    p += side * Eigen::Vector3d(distortion * aspect * u(random), distortion * u(random), warp * u(random));
    p = turn * p;
  }
  return x;
}

}  // namespace brio
