#include <gtest/gtest.h>

#include <cmath>

#include "tests/elements/single_shell.hpp"

#include <Eigen/Eigenvalues>

namespace brio {
namespace {

/// Highest frequency of the free element with its lumped masses, from forces of unit velocities.
double highest_frequency(const Shell4& shell, const Elastic& law, const Points4& x) {
  const SingleShell<> reference(shell, law, x);
  const Eigen::Matrix<double, 24, 24> stiffness = stiffness_of(shell, law, x);
  Eigen::Matrix<double, 24, 1> root;
  root.head<12>().setConstant(1 / std::sqrt(reference.mass.mass));
  root.tail<12>().setConstant(1 / std::sqrt(reference.mass.rotational_inertia));
  const Eigen::Matrix<double, 24, 24> scaled = root.asDiagonal() * stiffness * root.asDiagonal();
  EXPECT_LT((scaled - scaled.transpose()).norm(), 1e-9 * scaled.norm());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 24, 24>> eigen(0.5 *
                                                                           (scaled + scaled.transpose()));
  EXPECT_GT(eigen.eigenvalues()[0], -1e-9 * eigen.eigenvalues()[23]);
  return std::sqrt(eigen.eigenvalues()[23]);
}

double stable_step(const Shell4& shell, const Elastic& law, const Points4& x) {
  SingleShell<> element(shell, law, x);
  element.move(x, SingleShell<>::none(), SingleShell<>::none(), 0);
  return element.increment.stable_step;
}

TEST(Shell4Step, NeverExceedsTheElementsOwnForAnyShape) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  double least = 1;
  double sum = 0;
  const int cases = 4000;
  int valid = 0;
  int usual = 0;
  for (int k = 0; k < cases; ++k) {
    Shell4 shell;
    shell.thickness = std::pow(10.0, -3 * u(random));
    shell.warping_projection = k % 2 == 1;
    shell.linear_bulk_viscosity = 0;
    shell.hourglass_stiffness = k % 5 == 0 ? u(random) : 0.05;
    shell.thickness_points = 1 + k % 6;
    shell.quadrature = k % 4 == 0 ? ThicknessQuadrature::lobatto : ThicknessQuadrature::gauss;
    Elastic law = steel();
    law.poissons_ratio = -0.5 + 0.999 * u(random);
    const double aspect = k % 3 == 0 ? std::pow(10.0, 2 * u(random)) : 1 + u(random);
    const double distortion = 0.45 * u(random);
    const Points4 x = random_quadrilateral(random, 1, aspect, distortion, k % 4 == 2 ? 0 : 0.3 * u(random));
    const SingleShell<> element(shell, law, x);
    if (!(element.mass.mass > 0)) continue;
    ++valid;
    const double ratio = stable_step(shell, law, x) * highest_frequency(shell, law, x) / 2;
    ASSERT_LE(ratio, 1 + 1e-9) << "case " << k << " thickness " << shell.thickness << " aspect " << aspect
                               << " distortion " << distortion;
    least = std::min(least, ratio);
    if (shell.hourglass_stiffness == 0.05) {
      sum += ratio;
      ++usual;
    }
  }
  EXPECT_GT(valid, cases * 9 / 10);
  EXPECT_GT(sum / usual, 0.95);
  EXPECT_GT(least, 0.6);
}

TEST(Shell4Step, IsTheElementsOwnForARectangle) {
  for (double aspect : {1.0, 3.0, 100.0})
    for (double thickness : {0.001, 0.1, 1.0}) {
      Shell4 shell;
      shell.thickness = thickness;
      shell.linear_bulk_viscosity = 0;
      const Points4 x = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(aspect, 0, 0),
                         Eigen::Vector3d(aspect, 1, 0), Eigen::Vector3d(0, 1, 0)};
      const double ratio = stable_step(shell, steel(), x) * highest_frequency(shell, steel(), x) / 2;
      EXPECT_LE(ratio, 1 + 1e-9);
      EXPECT_GT(ratio, 0.98) << aspect << " " << thickness;
    }
}

}  // namespace
}  // namespace brio
