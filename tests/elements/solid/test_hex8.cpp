#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elements/solid/hex8_kernel.hpp"
#include "materials/elastic.hpp"
#include "tests/elements/solid/hexahedra.hpp"

namespace brio {
namespace {

using test::Corners;
using test::Noise;
using test::SingleElement;
using GreenNaghdi = Hex8Kernel<ObjectiveRate::green_naghdi>;
using Jaumann = Hex8Kernel<ObjectiveRate::jaumann>;

const Elastic mild_steel{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = 0.3};

template <class Kernel>
class Hex8Rates : public ::testing::Test {};
using Rates = ::testing::Types<GreenNaghdi, Jaumann>;
TYPED_TEST_SUITE(Hex8Rates, Rates);

TYPED_TEST(Hex8Rates, LinearMotionGivesUniformStrainOnDistortedBricks) {
  Noise noise(11);
  for (int trial = 0; trial < 50; ++trial) {
    const Corners x = test::distorted(noise, 0.3);
    SingleElement<TypeParam, Elastic> element({}, mild_steel, x);
    Eigen::Matrix3d strain = noise.matrix<Eigen::Matrix3d>();
    strain = 1e-9 * (strain + strain.transpose()).eval();
    element.move_to(x + strain * x, 1e-6);
    const Eigen::Matrix3d exact =
        mild_steel.elastic().first_lame() * strain.trace() * Eigen::Matrix3d::Identity() +
        2 * mild_steel.elastic().shear() * strain;
    EXPECT_LT((element.stress() - exact).norm(), 1e-6 * exact.norm());
    EXPECT_LT(std::abs(element.hourglass_energy), 1e-12 * element.internal_energy);
  }
}

// Cauchy stress over shear modulus in simple shear gamma, hypoelastic. Jaumann: sin(gamma), 1 - cos(gamma)
// (Dienes 1979). Green-Naghdi: with beta = atan(gamma/2), Dienes 1979, eq. for the polar rate.
struct ShearCurve {
  double shear, normal;
};
ShearCurve exact_shear(ObjectiveRate rate, double gamma) {
  if (rate == ObjectiveRate::jaumann) return {std::sin(gamma), 1 - std::cos(gamma)};
  const double beta = std::atan(0.5 * gamma);
  const double s = std::sin(2 * beta), c = std::cos(2 * beta), logarithm = std::log(std::cos(beta));
  const double normal = 4 * (c * logarithm + beta * s - square(std::sin(beta)));
  return {2 * c * (2 * beta - 2 * std::tan(2 * beta) * logarithm - std::tan(beta)), normal};
}

template <class Kernel>
void expect_simple_shear(ObjectiveRate rate) {
  const Corners x = test::box(1, 1, 1);
  SingleElement<Kernel, Elastic> element({}, mild_steel, x);
  const double mu = mild_steel.elastic().shear();
  const int steps = 2000;
  double largest = 0;
  for (int step = 1; step <= steps; ++step) {
    const double gamma = 10.0 * step / steps;
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 1) = gamma;
    element.move_to(f * x, 1e-6);
    const ShearCurve exact = exact_shear(rate, gamma);
    largest = std::max({largest, std::abs(exact.shear), std::abs(exact.normal)});
    const Eigen::Matrix3d stress = element.stress() / mu;
    ASSERT_NEAR(stress(0, 1), exact.shear, 1e-4 * largest) << gamma;
    ASSERT_NEAR(stress(0, 0), exact.normal, 1e-4 * largest) << gamma;
    ASSERT_NEAR(stress(1, 1), -exact.normal, 1e-4 * largest) << gamma;
    ASSERT_NEAR(stress(2, 2), 0, 1e-9);
  }
}
TEST(Hex8, SimpleShearFollowsTheJaumannCurve) { expect_simple_shear<Jaumann>(ObjectiveRate::jaumann); }
TEST(Hex8, SimpleShearFollowsTheGreenNaghdiCurve) {
  expect_simple_shear<GreenNaghdi>(ObjectiveRate::green_naghdi);
}

TYPED_TEST(Hex8Rates, StepOfACubeIsTheExactOne) {
  for (const double nu : {0.0, 0.3, 0.4999}) {
    const Elastic law{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = nu};
    TypeParam kernel;
    kernel.linear_bulk_viscosity = 0;
    SingleElement<TypeParam, Elastic> element(kernel, law, test::box(0.1, 0.1, 0.1));
    element.update(element.position, Corners::Zero(), 0);
    const double wave_speed =
        std::sqrt((law.elastic().first_lame() + 2 * law.elastic().shear()) / law.density);
    EXPECT_NEAR(element.increment.stable_step, 0.1 / wave_speed * std::sqrt((1 - nu) / (1 + nu)),
                1e-12 * 1e-5);
  }
}

}  // namespace
}  // namespace brio
