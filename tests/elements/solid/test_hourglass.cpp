// What the hourglass control of the one-point brick resists, and how much of it flow leaves.

#include <gtest/gtest.h>

#include <cmath>

#include "elements/solid/hex8_full_kernel.hpp"
#include "elements/solid/hex8_kernel.hpp"
#include "materials/elastic.hpp"
#include "materials/elastic_plastic.hpp"
#include "src/base/index.hpp"
#include "tests/elements/solid/hexahedra.hpp"

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
  const double s = hourglass_stiffness(0.05, ElasticModuli<double>{1.5, 1.0}, b.volume, 0.0).bending;
  return s * (axis == 2 ? g.zz : g.xx);
}

TEST(Hourglass, BendingOfAFlatBrickIsResistedOverItsLengthNotItsThickness) {
  // Volume over the square of the edge along the displacement.
  EXPECT_NEAR(stiffness_along(1, 0.1, 0) / stiffness_along(1, 1, 0), 0.1, 1e-12);
  EXPECT_NEAR(stiffness_along(1, 0.1, 2) / stiffness_along(1, 1, 2), 10, 1e-11);
  EXPECT_NEAR(stiffness_along(2, 2, 0) / stiffness_along(1, 1, 0), 2, 1e-12);
}

const ElasticPlastic metal{
    .density = 1, .youngs_modulus = 260, .poissons_ratio = 0.3, .yield_stress = 1, .hardening_modulus = 30};

TEST(Hourglass, FlowLeavesTheStressAtYieldOfTheElasticTrial) {
  const double shear = 100;
  ElasticPlastic::History<double> history{};
  SymmetricTensor<double> stress{};
  const SymmetricTensor<double> small{0, 0, 0, 1e-4, 0, 0};
  const auto share_of = [&](const SymmetricTensor<double>& strain) {
    const SymmetricTensor<double> before = stress;
    const double plastic_strain = history.equivalent_plastic_strain;
    metal.update(strain, stress, history);
    return return_ratio(before, stress, strain, shear, history.equivalent_plastic_strain > plastic_strain);
  };
  EXPECT_EQ(share_of(small), 1);
  for (int i = 0; i < 200; ++i) share_of(small);
  const double before = stress.xy;
  const double share = share_of(small);
  EXPECT_NEAR(share, stress.xy / (before + 2 * shear * 1e-4), 1e-12);
  EXPECT_EQ(share_of(-1.0 * small), 1);  // unloading
}

using Brick = test::SingleElement<Hex8Kernel<ObjectiveRate::green_naghdi>, ElasticPlastic>;

// A cube bent in the hourglass mode xi zeta along x; the curvature grows by the step.
test::Corners bending(double amount) {
  test::Corners u = test::Corners::Zero();
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3d& sign = test::corner_sign[index(n)];
    u(0, n) = amount * sign.x() * sign.z();
  }
  return u;
}

// Warping u_k = a_k x_l x_m strains no fibre: full integration of its shears is exact. One warping that comes
// alone, as in a checkerboard of bricks, is stiff; the twist of a flat brick, in which they cancel, is not.
TEST(Hourglass, WarpingInAnyCombinationIsResistedAsIfFullyIntegrated) {
  const Elastic law{.density = 1, .youngs_modulus = 260, .poissons_ratio = 0.3};
  Hex8Kernel<ObjectiveRate::green_naghdi> one_point;
  Hex8FullKernel<ObjectiveRate::green_naghdi> full;
  one_point.hourglass_stiffness = 1.0 / 9;
  one_point.linear_bulk_viscosity = one_point.quadratic_bulk_viscosity = 0;
  full.linear_bulk_viscosity = full.quadratic_bulk_viscosity = 0;
  test::Noise noise(7);
  const Eigen::Vector3d lone = Eigen::Vector3d::UnitZ(), twist(1, 1, -1);
  for (const Eigen::Vector3d& edges : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(2, 3, 0.1)}) {
    const test::Corners x = test::box(edges.x(), edges.y(), edges.z());
    for (const Eigen::Vector3d& a : {lone, twist, noise.matrix<Eigen::Vector3d>()}) {
      test::Corners u;
      for (int n = 0; n < 8; ++n)
        for (int k = 0; k < 3; ++k) u(k, n) = 1e-8 * a[k] * x((k + 1) % 3, n) * x((k + 2) % 3, n);
      test::SingleElement<Hex8Kernel<ObjectiveRate::green_naghdi>, Elastic> brick(one_point, law, x);
      test::SingleElement<Hex8FullKernel<ObjectiveRate::green_naghdi>, Elastic> reference(full, law, x);
      brick.move_to(x + u, 1);
      reference.move_to(x + u, 1);
      const Eigen::Vector3d l2 = edges.cwiseProduct(edges);
      const double exact = 1e-16 * 100 * edges.prod() / 12 *
                           (l2.x() * std::pow(a.y() + a.z(), 2) + l2.y() * std::pow(a.x() + a.z(), 2) +
                            l2.z() * std::pow(a.x() + a.y(), 2));
      EXPECT_NEAR(brick.force.cwiseProduct(u).sum(), exact, 1e-5 * exact);
      EXPECT_LE((brick.force - reference.force).norm(), 2e-5 * reference.force.norm());
    }
  }
}

// The nodal forces of a section that yields all over: s V / (8 L).
TEST(Hourglass, BendingForcesEndAtThoseOfASectionThatYieldsAllOver) {
  ElasticPlastic ideal = metal;
  ideal.hardening_modulus = 0;
  ideal.yield_stress = 0.01;  // small strains
  const test::Corners x = test::box(1, 1, 1);
  Brick brick({}, ideal, x);
  double largest = 0, work = 0;
  for (int step = 1; step <= 200; ++step) {
    brick.move_to(x + bending(1e-6 * step), 1e-3);
    largest = std::max(largest, brick.force.row(0).cwiseAbs().maxCoeff());
    work = brick.internal_energy + brick.hourglass_energy;
  }
  EXPECT_NEAR(largest, 0.01 / 8, 1e-3 * 0.01 / 8);
  // Energy balance: work of the forces, of which little is stored.
  EXPECT_LT(brick.hourglass_energy, 0.2 * work);
  EXPECT_GT(brick.internal_energy, 0);
  EXPECT_NEAR(brick.internal_energy, brick.header.internal_energy, 1e-14);
}

TEST(Hourglass, ForcesFadeInABrickThatFlowsWithoutBending) {
  const test::Corners x = test::box(1, 1, 1);
  Brick brick({}, metal, x);
  brick.move_to(x + bending(1e-3), 1e-3);
  const double stored = brick.hourglass_energy;
  ASSERT_GT(stored, 0);
  const Eigen::DiagonalMatrix<double, 3> stretch(1.0005, 0.99975, 0.99975);
  for (int step = 0; step < 200; ++step) brick.move_to(stretch * brick.position, 1e-3);
  EXPECT_GT(brick.point[0].history.equivalent_plastic_strain, 0.05);
  EXPECT_LT(stored_energy(brick.header.hourglass), 1e-6 * stored);
  EXPECT_NEAR(stored_energy(brick.header.hourglass), brick.hourglass_energy, 1e-12);
}

// Force of the bending that is laid upon a brick in one step while it is stretched.
double bending_force(double coefficient, double stretching) {
  Hex8Kernel<ObjectiveRate::green_naghdi> kernel;
  kernel.hourglass_stiffness = coefficient;
  const test::Corners x = test::box(1, 1, 1);
  Brick brick(kernel, metal, x);
  const Eigen::DiagonalMatrix<double, 3> stretch(1 + stretching, 1 - 0.5 * stretching, 1 - 0.5 * stretching);
  for (int step = 0; step < 100; ++step) brick.move_to(stretch * brick.position, 1e-3);
  brick.move_to(stretch * brick.position + bending(1e-9), 1e-3);
  const HourglassState<double>& state = brick.header.hourglass;
  return state.scale.stiffness * state.strain.entry[1][0];
}

TEST(Hourglass, ForcesOfABrickThatFlowsGrowWithACoefficientOfAHundredthAtMost) {
  const double elastic = bending_force(0.01, 1e-6), flowing = bending_force(0.01, 5e-4);
  ASSERT_NE(flowing, 0);
  EXPECT_NEAR(bending_force(0.05, 1e-6), 5 * elastic, 1e-9 * std::abs(elastic));
  EXPECT_NEAR(bending_force(0.05, 5e-4), flowing, 1e-9 * std::abs(flowing));
  EXPECT_NEAR(bending_force(0.15, 5e-4), flowing, 1e-9 * std::abs(flowing));
  EXPECT_NEAR(bending_force(0.005, 5e-4), 0.5 * flowing, 1e-9 * std::abs(flowing));
}

// While a brick flows it is bent and bent back: what it gives back is never more than what it had taken up,
// wherever the way turns.
TEST(Hourglass, GivesBackNoMoreThanItTookUpInABrickThatFlows) {
  const auto stretched = [](double strain) {
    return Eigen::DiagonalMatrix<double, 3>(1 + strain, 1 - 0.5 * strain, 1 - 0.5 * strain);
  };
  for (const double flow_from : {0.0, 0.1, 0.125, 0.2, 0.375}) {
    Brick straight({}, metal, test::box(1, 1, 1)), bent({}, metal, test::box(1, 1, 1));
    for (int step = 0; step < 200; ++step)
      for (Brick* brick : {&straight, &bent}) brick->move_to(stretched(2e-5) * brick->position, 1e-3);
    ASSERT_GT(bent.point[0].history.equivalent_plastic_strain, 0);
    double least = 0, most = 0;
    for (int step = 0; step < 400; ++step) {
      const double phase = (step + 0.5) / 400;
      const double change = 1e-6 * std::cos(4 * M_PI * phase);
      for (Brick* brick : {&straight, &bent}) {
        test::Corners x = brick->position;
        if (phase >= flow_from) x = stretched(1e-8) * x;
        if (brick == &bent) x += bending(change);
        brick->move_to(x, 1e-3);
      }
      const double more = bent.internal_energy + bent.hourglass_energy - straight.internal_energy;
      least = std::min(least, more);
      most = std::max(most, more);
      EXPECT_NEAR(stored_energy(bent.header.hourglass), bent.hourglass_energy, 1e-15);
    }
    // Stiffness changes with the shape of the brick, a little.
    EXPECT_GE(least, -1e-3 * most) << flow_from;
  }
}

}  // namespace
}  // namespace brio
