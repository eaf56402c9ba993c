// What neighbours that lie in a sheet or a thread tell of the motion around a particle.

#include <gtest/gtest.h>

#include <cmath>

#include "elements/particle/particle_support.hpp"

namespace brio {
namespace {

const Tensor<double> some_gradient{{{3, -2, 1}, {0.5, 4, -1}, {2, -3, -2}}};
const Tensor<double> spin{{{0, -2, 1}, {2, 0, -3}, {-1, 3, 0}}};

/// Turned by 0.7 about an axis that is none of the coordinates'.
Tensor<double> turn() {
  const double c = std::cos(0.7), s = std::sin(0.7), x = 2 / 3.0, y = -1 / 3.0, z = 2 / 3.0, d = 1 - c;
  return {{{c + x * x * d, x * y * d - z * s, x * z * d + y * s},
           {y * x * d + z * s, c + y * y * d, y * z * d - x * s},
           {z * x * d - y * s, z * y * d + x * s, c + z * z * d}}};
}

SymmetricTensor<double> symmetric(const Tensor<double>& a) {
  return {a.m[0][0], a.m[1][1], a.m[2][2], a.m[0][1], a.m[1][2], a.m[0][2]};
}
SymmetricTensor<double> moments(double a, double b, double c) {
  const Tensor<double> q = turn();
  return symmetric(q * full(SymmetricTensor<double>{a, b, c, 0, 0, 0}) * transposed(q));
}
SymmetricTensor<double> rate_of_strain(const Tensor<double>& l) { return symmetric_part(l); }
/// The sum of s v x^T of a linear field.
Tensor<double> sum_of(const Tensor<double>& gradient, const SymmetricTensor<double>& m) {
  return gradient * full(m);
}
void expect_near(const Tensor<double>& a, const Tensor<double>& b, double tolerance) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(a.m[i][j], b.m[i][j], tolerance) << i << j;
}

TEST(ParticleSupport, NeighboursAroundOrInACornerTellAll) {
  for (const SymmetricTensor<double>& m : {moments(5, 5, 5), moments(1.4, 0.25, 0.25), moments(3, 2, 0.11)}) {
    const ParticleSupport support(m, 5);
    expect_near(support.velocity_gradient(sum_of(some_gradient, m)), some_gradient, 1e-13);
    expect_near(full(support.share()), identity<double>(), 1e-15);
  }
}

TEST(ParticleSupport, ASheetStrainsInItsPlaneAndTurnsWithIt) {
  const SymmetricTensor<double> m = moments(2, 1, 0);
  const ParticleSupport support(m, 1);
  const Tensor<double> q = turn();
  const Tensor<double> found = transposed(q) * support.velocity_gradient(sum_of(some_gradient, m)) * q;
  const SymmetricTensor<double> in_plane = rate_of_strain(transposed(q) * some_gradient * q);
  const SymmetricTensor<double> strain = rate_of_strain(found);
  EXPECT_NEAR(strain.xx, in_plane.xx, 1e-13);
  EXPECT_NEAR(strain.xy, in_plane.xy, 1e-13);
  for (double across : {strain.zz, strain.yz, strain.xz}) EXPECT_NEAR(across, 0, 1e-13);
  // Its normal is turned by the two directions in its plane.
  expect_near(support.velocity_gradient(sum_of(spin, m)), spin, 1e-12);
}

TEST(ParticleSupport, AThreadStrainsAlongItselfAndALoneParticleNotAtAll) {
  const Tensor<double> q = turn();
  const SymmetricTensor<double> m = moments(2, 0, 0);
  const SymmetricTensor<double> strain =
      rate_of_strain(transposed(q) * ParticleSupport(m, 1).velocity_gradient(sum_of(some_gradient, m)) * q);
  EXPECT_NEAR(strain.xx, rate_of_strain(transposed(q) * some_gradient * q).xx, 1e-13);
  for (double other : {strain.yy, strain.zz, strain.xy, strain.yz, strain.xz}) EXPECT_NEAR(other, 0, 1e-13);
  const SymmetricTensor<double> none = isotropic(0.0);
  expect_near(ParticleSupport(none, 1).velocity_gradient(sum_of(some_gradient, none)), {}, 0);
  EXPECT_EQ(ParticleSupport(none, 1).stiffness(), 0);
}

TEST(ParticleSupport, FadesWithoutAJumpAndTheStiffnessHasABound) {
  double last = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double poorest = i * 1e-5;
    const ParticleSupport support(moments(1, 1, poorest), 1);
    const double share = support.share().zz + support.share().xx + support.share().yy;
    EXPECT_LE(std::abs(share - last), i == 0 ? 3 : 1.001e-5 / least_support);
    EXPECT_LE(support.stiffness(), 2 + 1.0001 / least_support);
    last = share;
  }
  EXPECT_NEAR(last, 3, 1e-12);
}

// Stress S P S K against pair vectors: symmetric, so that pair forces have no moment; and the power of the
// strain.
TEST(ParticleSupport, ForcesAreTheTransposeOfTheStrainAndHaveNoMoment) {
  const SymmetricTensor<double> stress{2, -1, 3, 0.5, -0.7, 1.1};
  for (double poorest : {0.3, 0.02, 0.013, 1e-4, 0.0}) {
    const SymmetricTensor<double> m = moments(1, 0.4, poorest);
    const ParticleSupport support(m, 1);
    const Tensor<double> force = full(support.share()) * full(stress) * full(support.inverse());
    const Tensor<double> moment = full(m) * transposed(force);
    expect_near(moment, transposed(moment), 1e-13);
    double power = 0;
    const Tensor<double> sum = sum_of(some_gradient, m);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) power += force.m[i][j] * sum.m[i][j];
    EXPECT_NEAR(power, contract(stress, rate_of_strain(support.velocity_gradient(sum))), 1e-12);
  }
}

}  // namespace
}  // namespace brio
