#include <gtest/gtest.h>

#include "elements/hex8_full_kernel.hpp"
#include "materials/elastic.hpp"
#include "tests/elements/hexahedra.hpp"

namespace brio {
namespace {

using test::Corners;
using test::Noise;
using Kernel = Hex8FullKernel<ObjectiveRate::green_naghdi>;
using FullElement = test::SingleElement<Kernel, Elastic>;
using Stiffness = Eigen::Matrix<double, 24, 24>;

Stiffness stiffness_over_shear(double nu, const Corners& x) {
  const Elastic law{.density = 1, .youngs_modulus = 2 * (1 + nu), .poissons_ratio = nu};
  const double h = 1e-7;
  Stiffness k;
  for (int dof = 0; dof < 24; ++dof) {
    FullElement element({}, law, x);
    element.kernel.linear_bulk_viscosity = element.kernel.quadratic_bulk_viscosity = 0;
    Corners moved = x;
    moved(dof % 3, dof / 3) += h;
    element.move_to(moved, 1);
    k.col(dof) = Eigen::Map<const Eigen::Matrix<double, 24, 1>>(element.force.data()) / h;
  }
  return 0.5 * (k + k.transpose());
}

TEST(Hex8Full, ResistsEveryMotionButRigidOnes) {
  Noise noise(41);
  for (int trial = 0; trial < 10; ++trial) {
    const Corners x = test::distorted(noise, 0.3);
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Stiffness>(stiffness_over_shear(0.3, x)).eigenvalues();
    EXPECT_LT(std::abs(eigenvalues(5)), 1e-5);
    EXPECT_GT(eigenvalues(6), 1e-2);
  }
}

TEST(Hex8Full, OnlyTheChangeOfVolumeStiffensWhenNearlyIncompressible) {
  Noise noise(42);
  const Corners x = test::distorted(noise, 0.3);
  const Eigen::VectorXd soft =
      Eigen::SelfAdjointEigenSolver<Stiffness>(stiffness_over_shear(0.3, x)).eigenvalues();
  const Eigen::VectorXd hard =
      Eigen::SelfAdjointEigenSolver<Stiffness>(stiffness_over_shear(0.4999, x)).eigenvalues();
  // One stiff mode, the uniform change of volume; the next stays of the size of shear.
  EXPECT_GT(hard(23), 500 * soft(23));
  EXPECT_LT(hard(22), 1.1 * soft(23));
}

TEST(Hex8Full, BendingOfACubeIsThatOfTheExactIntegral) {
  // u_x = xi eta: deviatoric part of the strain eta/(h/2) in xx and half of xi/(h/2) in xy, by B-bar without
  // volume change.
  const double h = 2;
  const Stiffness k = stiffness_over_shear(0.25, test::box(h, h, h));
  Corners mode = Corners::Zero();
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3d& s = test::corner_sign[static_cast<std::size_t>(n)];
    mode(0, n) = s.x() * s.y();
  }
  const Eigen::Map<const Eigen::Matrix<double, 24, 1>> u(mode.data());
  // 2 mu int (dev eps : dev eps) = 2 (2/3 + 1/2) int eta^2 dV with unit shear modulus
  EXPECT_NEAR(u.dot(k * u), 2 * (2.0 / 3 + 0.5) * 8.0 / 3, 1e-5);
}

}  // namespace
}  // namespace brio
