#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "tests/elements/shell/single_shell.hpp"

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
    shell.linear_bulk_viscosity = shell.drilling_viscosity = 0;
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

/// Forces of unit velocities, of what damps.
Eigen::Matrix<double, 24, 24> viscosity_of(const Shell4& shell, const Elastic& law, const Points4& x) {
  const SingleShell<> reference(shell, law, x);
  Eigen::Matrix<double, 24, 24> viscosity;
  for (int column = 0; column < 24; ++column) {
    SingleShell<> element = reference;
    Points4 v = SingleShell<>::none(), w = SingleShell<>::none();
    constexpr double small = 1e-9;  // below what yields
    (column < 12 ? v : w)[index(column % 12 / 3)][column % 3] = small;
    element.move(x, v, w, 1e-30);
    for (int n = 0; n < 4; ++n) {
      viscosity.block<3, 1>(3 * n, column) = element.force(n) / small;
      viscosity.block<3, 1>(12 + 3 * n, column) = element.moment(n) / small;
    }
  }
  return viscosity;
}

// Central differences with damping a half step late stand while K h^2 / 4 + C h / 2 is below M.
TEST(Shell4Step, HoldsWithAnyDampingOfDrilling) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  double least_of_defaults = 1;
  for (int k = 0; k < 2000; ++k) {
    Shell4 shell;
    shell.thickness = std::pow(10.0, -3 * u(random));
    shell.linear_bulk_viscosity = k % 3 == 0 ? 0 : 0.06;
    const bool is_default = k % 2 == 0;
    if (!is_default) {
      shell.drilling_stiffness = k % 4 == 1 ? std::pow(10.0, -4 * u(random)) : 1.0;
      shell.drilling_viscosity = u(random);
    }
    const double aspect = k % 5 == 0 ? std::pow(10.0, 2 * u(random)) : 1 + u(random);
    const Points4 x = random_quadrilateral(random, 1, aspect, 0.3 * u(random), 0);
    const SingleShell<> element(shell, steel(), x);
    if (!(element.mass.mass > 0)) continue;
    const double step = stable_step(shell, steel(), x);
    ASSERT_GT(step, 0);
    Eigen::Matrix<double, 24, 1> root;
    root.head<12>().setConstant(1 / std::sqrt(element.mass.mass));
    root.tail<12>().setConstant(1 / std::sqrt(element.mass.rotational_inertia));
    const Eigen::Matrix<double, 24, 24> both =
        0.25 * step * step * stiffness_of(shell, steel(), x) + 0.5 * step * viscosity_of(shell, steel(), x);
    const Eigen::Matrix<double, 24, 24> scaled = root.asDiagonal() * both * root.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 24, 24>> eigen(
        0.5 * (scaled + scaled.transpose()), Eigen::EigenvaluesOnly);
    ASSERT_LE(eigen.eigenvalues()[23], 1 + 1e-6)
        << k << " " << shell.thickness << " " << shell.drilling_stiffness << " " << shell.drilling_viscosity;
    if (is_default) least_of_defaults = std::min(least_of_defaults, eigen.eigenvalues()[23]);
  }
  EXPECT_GT(least_of_defaults, 0.5);
}

TEST(Shell4Step, IsTheElementsOwnForARectangle) {
  for (double aspect : {1.0, 3.0, 100.0})
    for (double thickness : {0.001, 0.1, 1.0}) {
      Shell4 shell;
      shell.thickness = thickness;
      shell.linear_bulk_viscosity = shell.drilling_viscosity = 0;
      const Points4 x = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(aspect, 0, 0),
                         Eigen::Vector3d(aspect, 1, 0), Eigen::Vector3d(0, 1, 0)};
      const double ratio = stable_step(shell, steel(), x) * highest_frequency(shell, steel(), x) / 2;
      EXPECT_LE(ratio, 1 + 1e-9);
      // In long ones as thick as their short side, twist adds to a mode that it does not meet.
      EXPECT_GT(ratio, thickness < 1 ? 0.98 : 0.84) << aspect << " " << thickness;
    }
}

}  // namespace
}  // namespace brio
