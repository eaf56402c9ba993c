#include <gtest/gtest.h>

#include <cmath>

#include "elements/solid/mean_gradient.hpp"
#include "tests/elements/solid/hexahedra.hpp"

namespace brio {
namespace {

using test::Corners;

/// V B by 3x3x3 Gauss points, exact for the trilinear brick.
Corners quadrature_gradient(const Corners& x, double& volume) {
  const double p = std::sqrt(0.6);
  const double points[3] = {-p, 0, p};
  const double weights[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  Corners sum = Corners::Zero();
  volume = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        const Eigen::Matrix<double, 8, 3> d = test::shape_derivatives({points[i], points[j], points[k]});
        const Eigen::Matrix3d jacobian = x * d;
        const double dv = weights[i] * weights[j] * weights[k] * jacobian.determinant();
        volume += dv;
        sum += dv * (d * jacobian.inverse()).transpose();
      }
  return sum;
}

Corners closed_form_gradient(const Corners& x, double& volume) {
  const MeanGradient<double> b = mean_gradient(modes(test::motion_of(x, Corners::Zero()).position));
  volume = b.volume;
  Corners result;
  for (int i = 0; i < 3; ++i) {
    double s[hexahedron_modes] = {}, f[8];
    for (int m = 0; m < gradient_modes; ++m)
      s[m] = gradient_scale * (i == 0 ? b.beta[m].x : i == 1 ? b.beta[m].y : b.beta[m].z);
    corner_values(s, f);
    for (int n = 0; n < 8; ++n) result(i, n) = f[n];
  }
  return result;
}

TEST(MeanGradient, EqualsQuadratureOnDistortedBricks) {
  test::Noise noise(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Corners x = test::distorted(noise, 0.4);
    double volume, exact_volume;
    const Corners b = closed_form_gradient(x, volume);
    const Corners exact = quadrature_gradient(x, exact_volume);
    EXPECT_NEAR(volume, exact_volume, 1e-14 * std::abs(exact_volume) + 1e-14);
    EXPECT_LT((b - exact).norm(), 1e-14 * exact.norm());
  }
}

TEST(MeanGradient, IsTheDerivativeOfTheVolume) {
  test::Noise noise(2);
  const Corners x = test::distorted(noise, 0.4);
  double volume;
  const Corners b = closed_form_gradient(x, volume);
  for (int n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i) {
      // The volume is linear in each coordinate: a large difference is exact.
      Corners up = x, down = x;
      up(i, n) += 0.5;
      down(i, n) -= 0.5;
      double volume_up, volume_down;
      closed_form_gradient(up, volume_up);
      closed_form_gradient(down, volume_down);
      EXPECT_NEAR(b(i, n), volume_up - volume_down, 1e-13);
    }
}

TEST(MeanGradient, AcceptsBricksWithRepeatedNodes) {
  Corners wedge = test::box(1, 1, 1);
  wedge.col(3) = wedge.col(2);
  wedge.col(7) = wedge.col(6);
  Corners pyramid = test::box(1, 1, 1);
  for (int n = 5; n < 8; ++n) pyramid.col(n) = pyramid.col(4);
  double volume;
  closed_form_gradient(wedge, volume);
  EXPECT_NEAR(volume, 0.5, 1e-15);
  closed_form_gradient(pyramid, volume);
  EXPECT_NEAR(volume, 1.0 / 3, 1e-15);
}

TEST(MeanGradient, CornerValuesAreTheTransposeOfPatternSums) {
  test::Noise noise(3);
  for (int trial = 0; trial < 20; ++trial) {
    double f[8], s[hexahedron_modes], sums[hexahedron_modes], corners[8];
    for (double& value : f) value = noise();
    for (double& value : s) value = noise();
    pattern_sums(f, sums);
    corner_values(s, corners);
    double left = 0, right = 0;
    for (int n = 0; n < 8; ++n) left += f[n] * corners[n];
    for (int m = 0; m < hexahedron_modes; ++m) right += sums[m] * s[m];
    EXPECT_NEAR(left, right, 1e-14);
  }
}

}  // namespace
}  // namespace brio
