#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elements/solid/hex8_full_kernel.hpp"
#include "elements/solid/hex8_kernel.hpp"
#include "materials/elastic.hpp"
#include "tests/elements/solid/hexahedra.hpp"

namespace brio {
namespace {

using test::Corners;
using test::Noise;
using test::SingleElement;
using OnePoint = Hex8Kernel<ObjectiveRate::green_naghdi>;
using Full = Hex8FullKernel<ObjectiveRate::green_naghdi>;
using Stiffness = Eigen::Matrix<double, 24, 24>;

OnePoint one_point(double hourglass_stiffness) {
  OnePoint kernel;
  kernel.hourglass_stiffness = hourglass_stiffness;
  kernel.linear_bulk_viscosity = 0;
  return kernel;
}
Full full() {
  Full kernel;
  kernel.linear_bulk_viscosity = 0;
  return kernel;
}

/// Forces of small displacements, one degree of freedom after the other.
template <class Kernel>
Stiffness assembled_stiffness(const Kernel& kernel, const Elastic& law, const Corners& x) {
  const double h = 1e-7 * std::cbrt((x.rowwise().maxCoeff() - x.rowwise().minCoeff()).prod());
  Kernel without_viscosity = kernel;
  without_viscosity.quadratic_bulk_viscosity = 0;
  Stiffness k;
  for (int dof = 0; dof < 24; ++dof) {
    SingleElement<Kernel, Elastic> element(without_viscosity, law, x);
    Corners moved = x;
    moved(dof % 3, dof / 3) += h;
    element.move_to(moved, 1.0);
    k.col(dof) = Eigen::Map<const Eigen::Matrix<double, 24, 1>>(element.force.data()) / h;
  }
  return 0.5 * (k + k.transpose());
}

double critical_step(const Stiffness& k, double nodal_mass) {
  const double largest =
      Eigen::SelfAdjointEigenSolver<Stiffness>(k, Eigen::EigenvaluesOnly).eigenvalues()(23);
  return 2 / std::sqrt(largest / nodal_mass);
}

/// Critical over estimated step: never below one if the estimate is safe.
struct Ratio {
  double least = 1e300, sum = 0;
  int count = 0;
  double mean() const { return sum / count; }
};
template <class Kernel>
void add_ratio(Ratio& ratio, const Kernel& kernel, const Elastic& law, const Corners& x) {
  SingleElement<Kernel, Elastic> element(kernel, law, x);
  element.update(x, Corners::Zero(), 0);
  const double critical = critical_step(assembled_stiffness(kernel, law, x), element.nodal_mass);
  const double value = critical / element.increment.stable_step;
  ratio.least = std::min(ratio.least, value);
  ratio.sum += value;
  ++ratio.count;
}

bool has_positive_corners(const Corners& x) {
  for (const Eigen::Vector3d& corner : test::corner_sign)
    if ((x * test::shape_derivatives(corner)).determinant() <= 0) return false;
  return true;
}

template <class Kernel>
Ratio ratio_of_distorted_bricks(const Kernel& kernel, double nu, unsigned seed) {
  const Elastic law{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = nu};
  Noise noise(seed);
  Ratio ratio;
  for (int trial = 0; trial < 150; ++trial) {
    const Corners x = test::distorted(noise, 0.9 * (trial % 10) / 9);
    if (has_positive_corners(x)) add_ratio(ratio, kernel, law, x);
  }
  return ratio;
}

/// Boxes of one long or one short side, nearly regular.
template <class Kernel>
Ratio ratio_of_slender_bricks(const Kernel& kernel, double nu, const Eigen::Vector3d& sides) {
  const Elastic law{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = nu};
  Noise noise(22);
  Ratio ratio;
  for (int trial = 0; trial < 50; ++trial) {
    Corners x = test::box(sides.x(), sides.y(), sides.z());
    x += (0.02 * (trial % 10) * sides.minCoeff()) * noise.matrix<Corners>();
    x = noise.rotation() * x;
    add_ratio(ratio, kernel, law, x);
  }
  return ratio;
}

TEST(StableStep, BoundsDistortedBricksOfOnePoint) {
  for (const double nu : {-0.5, 0.0, 0.3, 0.45, 0.4999})
    for (const double hourglass : {0.0, 0.05, 0.15}) {
      const Ratio ratio = ratio_of_distorted_bricks(one_point(hourglass), nu, 21);
      EXPECT_GE(ratio.least, 1 - 1e-6) << "nu " << nu << " hourglass " << hourglass;
      EXPECT_LT(ratio.mean(), 1.2) << "nu " << nu << " hourglass " << hourglass;
    }
}

TEST(StableStep, BoundsDistortedBricksOfEightPoints) {
  for (const double nu : {-0.5, 0.0, 0.3, 0.45, 0.4999}) {
    const Ratio ratio = ratio_of_distorted_bricks(full(), nu, 23);
    EXPECT_GE(ratio.least, 1 - 1e-6) << "nu " << nu;
    EXPECT_LT(ratio.mean(), 1.2) << "nu " << nu;
  }
}

TEST(StableStep, BoundsNeedlesAndPancakes) {
  for (const double nu : {0.0, 0.3, 0.4999})
    for (const double aspect : {10.0, 1000.0})
      for (const Eigen::Vector3d& sides :
           {Eigen::Vector3d(1 / aspect, 1 / aspect, 1), Eigen::Vector3d(1, 1, 1 / aspect)})
        for (const Ratio& ratio : {ratio_of_slender_bricks(one_point(0.05), nu, sides),
                                   ratio_of_slender_bricks(full(), nu, sides)}) {
          EXPECT_GE(ratio.least, 1 - 1e-5) << "nu " << nu << " aspect " << aspect;
          EXPECT_LT(ratio.mean(), 1.15) << "nu " << nu << " aspect " << aspect;
        }
}

constexpr double blown_up = 1e6;
/// Growth of a small random motion of one free brick in an actual run, which stops where it has blown up.
double growth(const OnePoint& kernel, const Corners& x, double step, int steps) {
  const Elastic law{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = 0.3};
  Noise noise(24);
  SingleElement<OnePoint, Elastic> element(kernel, law, x);
  Corners position = x;
  Corners velocity = 1e-6 * noise.matrix<Corners>();
  const double start = velocity.norm();
  for (int i = 0; i < steps && velocity.norm() < blown_up * start; ++i) {
    position += step * velocity;
    element.update(position, velocity, step);
    velocity -= step / element.nodal_mass * element.force;
  }
  return velocity.norm() / start;
}

TEST(StableStep, FreeBricksRunAtTheirBoundAndBlowUpAboveTheCriticalStep) {
  const Elastic law{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = 0.3};
  for (const Eigen::Vector3d& sides : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(2, 1, 1),
                                       Eigen::Vector3d(8, 1, 1), Eigen::Vector3d(0.01, 0.01, 1)}) {
    const Corners x = test::box(sides.x(), sides.y(), sides.z());
    OnePoint kernel = one_point(0.05);
    const double critical = critical_step(assembled_stiffness(kernel, law, x),
                                          SingleElement<OnePoint, Elastic>(kernel, law, x).nodal_mass);
    for (const double viscosity : {0.0, 0.06, 0.5}) {
      kernel.linear_bulk_viscosity = viscosity;
      SingleElement<OnePoint, Elastic> element(kernel, law, x);
      element.update(x, Corners::Zero(), 0);
      EXPECT_LT(growth(kernel, x, 0.9999 * element.increment.stable_step, 3000), 100) << sides.transpose();
    }
    kernel.linear_bulk_viscosity = 0;
    EXPECT_GE(growth(kernel, x, 1.01 * critical, 3000), blown_up) << sides.transpose();
  }
}

TEST(StableStep, ViscousHourglassControlKeepsTheBoundSafe) {
  OnePoint kernel = one_point(0.05);
  kernel.hourglass_viscosity = 0.3;
  const Elastic law{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = 0.3};
  Noise noise(25);
  for (int trial = 0; trial < 20; ++trial) {
    const Corners x = test::distorted(noise, 0.4);
    SingleElement<OnePoint, Elastic> element(kernel, law, x);
    element.update(x, Corners::Zero(), 0);
    EXPECT_LT(growth(kernel, x, element.increment.stable_step, 1000), 10);
  }
}

}  // namespace
}  // namespace brio
