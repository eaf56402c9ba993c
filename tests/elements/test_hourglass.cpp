// What the hourglass control of the one-point brick resists, and how much of it flow leaves.

#include <gtest/gtest.h>

#include "elements/hourglass.hpp"
#include "elements/solid.hpp"
#include "materials/elastic_plastic.hpp"

namespace brio {
namespace {

// Corners of a brick of edges a, a, h.
void place_brick(double a, double h, double (&x)[3][8]) {
  constexpr int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i) x[i][n] = corner[n][i] * (i == 2 ? h : a);
}

// Stiffness against a displacement along one axis, the same for every hourglass mode.
double stiffness_along(double a, double h, int axis) {
  double x[3][8];
  place_brick(a, h, x);
  const MeanGradient<double> b = mean_gradient(modes(x));
  const SymmetricTensor<double> g = gradient_product(b, gradient_scale / b.volume);
  const double s = hourglass_stiffness(0.05, ElasticModuli<double>{1.5, 1.0}, b.volume, 0.0);
  return s * (axis == 2 ? g.zz : g.xx);
}

TEST(Hourglass, BendingOfAFlatBrickIsResistedOverItsLengthNotItsThickness) {
  // Volume over the square of the edge along the displacement.
  EXPECT_NEAR(stiffness_along(1, 0.1, 0) / stiffness_along(1, 1, 0), 0.1, 1e-12);
  EXPECT_NEAR(stiffness_along(1, 0.1, 2) / stiffness_along(1, 1, 2), 10, 1e-11);
  EXPECT_NEAR(stiffness_along(2, 2, 0) / stiffness_along(1, 1, 0), 2, 1e-12);
}

TEST(Hourglass, ShareOfTheTangentIsOneInElasticStepsAndTheTangentInFlow) {
  ElasticPlastic metal;
  metal.density = 1;
  metal.youngs_modulus = 260;
  metal.poissons_ratio = 0.3;
  metal.yield_stress = 1;
  metal.hardening_modulus = 30;
  const double shear = 100;
  ElasticPlastic::History<double> history{};
  SymmetricTensor<double> stress{};
  const SymmetricTensor<double> small{0, 0, 0, 1e-4, 0, 0};
  const auto share_of = [&](const SymmetricTensor<double>& strain) {
    const SymmetricTensor<double> before = stress;
    metal.update(strain, stress, history);
    return tangent_share(stress - before, strain, shear);
  };
  EXPECT_NEAR(share_of(small), 1, 1e-12);
  for (int i = 0; i < 200; ++i) share_of(small);
  EXPECT_NEAR(share_of(small), 30 / (3 * shear + 30), 1e-9);                                 // H / (3 mu + H)
  EXPECT_NEAR(share_of(-1.0 * small), 1, 1e-12);                                             // unloading
  EXPECT_EQ(tangent_share(SymmetricTensor<double>{}, SymmetricTensor<double>{}, shear), 1);  // no strain
}

}  // namespace
}  // namespace brio
