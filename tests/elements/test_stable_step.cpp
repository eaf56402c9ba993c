#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elements/hex8_kernel.hpp"
#include "materials/elastic.hpp"
#include "tests/elements/hexahedra.hpp"

namespace brio {
namespace {

using testing::Corners;
using testing::Noise;
using testing::SingleElement;
using Kernel = Hex8Kernel<ObjectiveRate::green_naghdi>;
using Stiffness = Eigen::Matrix<double, 24, 24>;

Kernel undamped(double hourglass_stiffness) {
  Kernel kernel;
  kernel.hourglass_stiffness = hourglass_stiffness;
  kernel.linear_bulk_viscosity = 0;
  kernel.quadratic_bulk_viscosity = 0;
  return kernel;
}

/// Forces of small displacements, one degree of freedom after the other.
Stiffness assembled_stiffness(const Kernel& kernel, const Elastic& law, const Corners& x) {
  const double h = 1e-7 * std::cbrt((x.rowwise().maxCoeff() - x.rowwise().minCoeff()).prod());
  Stiffness k;
  for (int dof = 0; dof < 24; ++dof) {
    SingleElement<Kernel, Elastic> element(kernel, law, x);
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

struct Ratio {
  double least = 1e300, sum = 0;
  int count = 0;
};
/// Critical over estimated step; never below one if the estimate is safe.
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
  for (const Eigen::Vector3d& corner : testing::corner_sign)
    if ((x * testing::shape_derivatives(corner)).determinant() <= 0) return false;
  return true;
}

TEST(StableStep, BoundsTheAssembledFrequenciesOfDistortedBricks) {
  Noise noise(21);
  for (const double nu : {-0.5, 0.0, 0.3, 0.45, 0.4999})
    for (const double hourglass : {0.0, 0.05, 0.15}) {
      const Elastic law{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = nu};
      Ratio ratio;
      for (int trial = 0; trial < 150; ++trial) {
        Corners x = testing::distorted(noise, 0.9 * (trial % 10) / 9);
        if (!has_positive_corners(x)) continue;
        add_ratio(ratio, undamped(hourglass), law, x);
      }
      EXPECT_GE(ratio.least, 1 - 1e-6) << "nu " << nu << " hourglass " << hourglass;
      EXPECT_LT(ratio.sum / ratio.count, 1.2) << "nu " << nu << " hourglass " << hourglass;
    }
}

TEST(StableStep, BoundsNeedlesAndPancakes) {
  Noise noise(22);
  for (const double nu : {0.0, 0.3, 0.4999})
    for (const double aspect : {10.0, 1000.0})
      for (const bool is_needle : {true, false}) {
        const Elastic law{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = nu};
        Ratio ratio;
        for (int trial = 0; trial < 50; ++trial) {
          Corners x = is_needle ? testing::box(1 / aspect, 1 / aspect, 1) : testing::box(1, 1, 1 / aspect);
          x += (0.02 * (trial % 10) / aspect) * noise.matrix<Corners>();
          x = noise.rotation() * x;
          add_ratio(ratio, undamped(0.05), law, x);
        }
        EXPECT_GE(ratio.least, 1 - 1e-5) << "nu " << nu << " aspect " << aspect;
        EXPECT_LT(ratio.sum / ratio.count, 1.15) << "nu " << nu << " aspect " << aspect;
      }
}

}  // namespace
}  // namespace brio
