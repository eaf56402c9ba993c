#pragma once
/// Bricks for the tests: shapes, shape functions, and a single element driven through a prescribed motion.

#include <Eigen/Dense>
#include <array>
#include <random>

#include "elements/base/motion.hpp"
#include "src/base/index.hpp"

namespace brio::test {

using Corners = Eigen::Matrix<double, 3, 8>;

/// Corner signs in VTK's order.
inline const std::array<Eigen::Vector3d, 8> corner_sign = {Eigen::Vector3d{-1, -1, -1},
                                                           {1, -1, -1},
                                                           {1, 1, -1},
                                                           {-1, 1, -1},
                                                           {-1, -1, 1},
                                                           {1, -1, 1},
                                                           {1, 1, 1},
                                                           {-1, 1, 1}};

inline Corners box(double a, double b, double c) {
  Corners x;
  for (int n = 0; n < 8; ++n) x.col(n) = 0.5 * corner_sign[index(n)].cwiseProduct(Eigen::Vector3d(a, b, c));
  return x;
}

inline Eigen::Matrix<double, 8, 3> shape_derivatives(const Eigen::Vector3d& xi) {
  Eigen::Matrix<double, 8, 3> d;
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3d& s = corner_sign[index(n)];
    const Eigen::Vector3d f = Eigen::Vector3d::Ones() + s.cwiseProduct(xi);
    d.row(n) = Eigen::RowVector3d(s.x() * f.y() * f.z(), s.y() * f.x() * f.z(), s.z() * f.x() * f.y()) / 8;
  }
  return d;
}

/// Uniform numbers in [-1, 1], the same in every run.
class Noise {
 public:
  explicit Noise(unsigned seed) : generator_(seed) {}
  double operator()() { return uniform_(generator_); }
  double between(double a, double b) { return a + (b - a) * 0.5 * (1 + (*this)()); }
  template <class Matrix>
  Matrix matrix() {
    return Matrix::NullaryExpr([this] { return (*this)(); });
  }
  Eigen::Matrix3d rotation() {
    const Eigen::Vector4d q = matrix<Eigen::Vector4d>();
    return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix();
  }

 private:
  std::mt19937 generator_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

/// A box of random sides with corners moved by up to `amount` of half a side each, sheared and turned.
inline Corners distorted(Noise& noise, double amount) {
  Corners x = box(noise.between(0.5, 2), noise.between(0.5, 2), noise.between(0.5, 2));
  for (int n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i) x(i, n) *= 1 + amount * noise();
  return noise.rotation() * x;
}

template <class T = double>
NodalMotion<T, 8> motion_of(const Corners& x, const Corners& v) {
  NodalMotion<T, 8> motion;
  for (int i = 0; i < 3; ++i)
    for (int n = 0; n < 8; ++n) {
      motion.position[i][n] = T(x(i, n) - x(i, 0));
      motion.velocity[i][n] = T(v(i, n) - v(i, 0));
    }
  return motion;
}

inline Corners forces_of(const NodalForces<double, 8>& forces) {
  Corners f;
  for (int i = 0; i < 3; ++i)
    for (int n = 0; n < 8; ++n) f(i, n) = forces.force[i][n];
  return f;
}

inline Eigen::Matrix3d matrix_of(const SymmetricTensor<double>& s) {
  Eigen::Matrix3d m;
  m << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  return m;
}
inline SymmetricTensor<double> tensor_of(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)};
}

/// One element with plain doubles, moved from configuration to configuration.
template <class Kernel, class Law>
struct SingleElement {
  Kernel kernel;
  Law law;
  typename Kernel::template Header<double, Law> header{};
  typename Kernel::template Point<double, Law> point[Kernel::points()]{};
  Corners position;
  Corners force = Corners::Zero();
  Increment<double> increment{};
  double nodal_mass = 0;
  double internal_energy = 0, hourglass_energy = 0, viscous_energy = 0;

  SingleElement(const Kernel& kernel_, const Law& law_, const Corners& x)
      : kernel(kernel_), law(law_), position(x) {
    nodal_mass = kernel.initialize(motion_of(x, Corners::Zero()), law, header, point).mass;
  }
  /// One call as the sweep makes it: x at the end of the step, v over it.
  void update(const Corners& x, const Corners& v, double step) {
    NodalForces<double, 8> forces;
    increment = kernel.force(motion_of(x, v), step, law, header, point, forces);
    position = x;
    force = forces_of(forces);
    internal_energy += increment.internal_energy;
    hourglass_energy += increment.hourglass_energy;
    viscous_energy += increment.viscous_energy;
  }
  void move_to(const Corners& x, double step) { update(x, Corners((x - position) / step), step); }
  Eigen::Matrix3d stress() const {
    return matrix_of(kernel.sample(motion_of(position, Corners::Zero()), law, header, point).stress);
  }
};

}  // namespace brio::test
