#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "elements/solid/hex8_full_kernel.hpp"
#include "materials/elastic.hpp"
#include "src/base/index.hpp"
#include "tests/core/floating_point_traps.hpp"
#include "tests/elements/solid/hexahedra.hpp"

namespace brio {
namespace {

using test::Corners;
using test::Noise;
using FullKernel = Hex8FullKernel<ObjectiveRate::green_naghdi>;
using FullElement = test::SingleElement<FullKernel, Elastic>;
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
    const Eigen::Vector3d& s = test::corner_sign[index(n)];
    mode(0, n) = s.x() * s.y();
  }
  const Eigen::Map<const Eigen::Matrix<double, 24, 1>> u(mode.data());
  // 2 mu int (dev eps : dev eps) = 2 (2/3 + 1/2) int eta^2 dV with unit shear modulus
  EXPECT_NEAR(u.dot(k * u), 2 * (2.0 / 3 + 0.5) * 8.0 / 3, 1e-5);
}

// A point with next to no volume left strains by more than can be followed in a step. The other points and
// the volume of the brick do not show it; followed on, its state would end as no number.
TEST(Hex8Full, ABrickOfWhichAPointCannotBeFollowedCountsAsInverted) {
  const Elastic law{.density = 1, .youngs_modulus = 2.6, .poissons_ratio = 0.3};
  Noise noise(43);
  Corners crushed = test::box(1, 1, 1);
  crushed.col(6) *= -0.07;
  const auto crush = [&] {
    FullElement element({}, law, test::box(1, 1, 1));
    constexpr int steps = 50;
    for (int step = 1; step <= steps; ++step)
      element.move_to(test::box(1, 1, 1) + step / double{steps} * (crushed - test::box(1, 1, 1)), 1);
    return element;
  };
  const test::FloatingPointTraps traps;
  FullElement element = crush();
  int followed = 0, inverted = 0;
  for (int step = 0; step < 3000; ++step) {
    const Corners x = crushed + 0.003 * noise.matrix<Corners>();
    element.move_to(x, 1);
    ASSERT_TRUE(std::isfinite(element.increment.internal_energy)) << step;
    if (element.increment.stable_step > 0) {
      ++followed;
      ASSERT_TRUE(element.force.allFinite()) << step;
      continue;
    }
    ++inverted;
    element = crush();
  }
  std::printf("%d steps followed, %d not\n", followed, inverted);
  EXPECT_GT(followed, 100);
  EXPECT_GT(inverted, 100);
}

}  // namespace
}  // namespace brio
