// Laws that every solid element and both objective rates obey.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elements/solid/hex8_full_kernel.hpp"
#include "elements/solid/hex8_kernel.hpp"
#include "materials/elastic.hpp"
#include "materials/elastic_plastic.hpp"
#include "materials/neo_hookean.hpp"
#include "src/base/index.hpp"
#include "tests/elements/solid/hexahedra.hpp"

namespace brio {
namespace {

using test::Corners;
using test::Noise;
using test::SingleElement;

const Elastic elastic_steel{.density = 7800, .youngs_modulus = 2e11, .poissons_ratio = 0.3};
const ElasticPlastic plastic_steel{.density = 7800,
                                   .youngs_modulus = 2e11,
                                   .poissons_ratio = 0.3,
                                   .yield_stress = 1e9,
                                   .hardening_modulus = 2e10,
                                   .hardening_mix = 0.5};

template <class Kernel>
class Solids : public ::testing::Test {};
using Kernels =
    ::testing::Types<Hex8Kernel<ObjectiveRate::green_naghdi>, Hex8Kernel<ObjectiveRate::jaumann>,
                     Hex8FullKernel<ObjectiveRate::green_naghdi>, Hex8FullKernel<ObjectiveRate::jaumann>>;
TYPED_TEST_SUITE(Solids, Kernels);

/// 2x2x2 bricks filling a cube, with the inner node and the nodes of faces moved.
struct PatchMesh {
  Eigen::Matrix<double, 3, 27> node;
  std::array<std::array<int, 8>, 8> brick;

  explicit PatchMesh(Noise& noise) {
    const auto id = [](int i, int j, int k) { return (k * 3 + j) * 3 + i; };
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          node.col(id(i, j, k)) = Eigen::Vector3d(i, j, k) + 0.25 * noise.matrix<Eigen::Vector3d>();
    for (int e = 0; e < 8; ++e) {
      const int i = e & 1, j = e >> 1 & 1, k = e >> 2;
      brick[index(e)] = {id(i, j, k),     id(i + 1, j, k),     id(i + 1, j + 1, k),     id(i, j + 1, k),
                         id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)};
    }
  }
  Corners corners(const Eigen::Matrix<double, 3, 27>& field, std::size_t e) const {
    Corners x;
    for (int n = 0; n < 8; ++n) x.col(n) = field.col(brick[e][index(n)]);
    return x;
  }
};

TYPED_TEST(Solids, PatchOfDistortedBricksCarriesAUniformStress) {
  Noise noise(51);
  for (int trial = 0; trial < 10; ++trial) {
    const PatchMesh mesh(noise);
    Eigen::Matrix3d strain = noise.matrix<Eigen::Matrix3d>();
    strain = 1e-3 * (strain + strain.transpose()).eval();
    const Eigen::Matrix<double, 3, 27> moved = mesh.node + strain * mesh.node;
    Eigen::Matrix3d first_stress = Eigen::Matrix3d::Zero();
    for (std::size_t e = 0; e < 8; ++e) {
      SingleElement<TypeParam, Elastic> element({}, elastic_steel, mesh.corners(mesh.node, e));
      element.move_to(mesh.corners(moved, e), 1e-3);
      if (e == 0) first_stress = element.stress();
      EXPECT_LT((element.stress() - first_stress).norm(), 1e-12 * first_stress.norm());
      EXPECT_LT(element.hourglass_energy, 1e-20 * element.internal_energy);
    }
  }
}

TYPED_TEST(Solids, UniformStressIsInEquilibriumInsideAPatch) {
  Noise noise(52);
  TypeParam kernel;
  kernel.linear_bulk_viscosity = kernel.quadratic_bulk_viscosity = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const PatchMesh mesh(noise);
    const Eigen::Matrix3d gradient = 0.02 * noise.matrix<Eigen::Matrix3d>();
    const Eigen::Matrix<double, 3, 27> moved = mesh.node + gradient * mesh.node;
    Eigen::Vector3d inner_force = Eigen::Vector3d::Zero();
    double size = 0;
    for (std::size_t e = 0; e < 8; ++e) {
      SingleElement<TypeParam, Elastic> element(kernel, elastic_steel, mesh.corners(mesh.node, e));
      element.move_to(mesh.corners(moved, e), 1e-3);
      for (int n = 0; n < 8; ++n)
        if (mesh.brick[e][index(n)] == 13) inner_force += element.force.col(n);
      size += element.force.norm();
    }
    EXPECT_LT(inner_force.norm(), 1e-13 * size);
  }
}

/// A violent motion of a distorted brick with every kind of force in play.
template <class Kernel, class Law>
SingleElement<Kernel, Law> after_a_few_steps(const Law& law, unsigned seed, const Eigen::Matrix3d& turn,
                                             const Eigen::Vector3d& shift = Eigen::Vector3d::Zero(),
                                             double length = 1, double time = 1) {
  Noise noise(seed);
  const auto placed = [&](const Corners& x) {
    return Corners((turn * (length * x)).colwise() + length * shift);
  };
  Corners x = test::distorted(noise, 0.3);
  SingleElement<Kernel, Law> element({}, law, placed(x));
  for (int step = 0; step < 5; ++step) {
    const Corners v = 200 * noise.matrix<Corners>();
    x += 1e-4 * v;
    element.update(placed(x), turn * (length / time * v), 1e-4 * time);
  }
  return element;
}

TYPED_TEST(Solids, ForcesHaveNeitherResultantNorMoment) {
  for (unsigned seed = 60; seed < 80; ++seed) {
    const auto element = after_a_few_steps<TypeParam>(plastic_steel, seed, Eigen::Matrix3d::Identity());
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (int n = 0; n < 8; ++n)
      moment += Eigen::Vector3d(element.position.col(n)).cross(Eigen::Vector3d(element.force.col(n)));
    EXPECT_LT(element.force.rowwise().sum().norm(), 1e-13 * element.force.norm());
    EXPECT_LT(moment.norm(), 1e-12 * element.force.norm() * element.position.norm());
  }
}

TYPED_TEST(Solids, ForcesTurnWithTheObserver) {
  Noise noise(53);
  for (unsigned seed = 60; seed < 70; ++seed) {
    const Eigen::Matrix3d turn = noise.rotation();
    const auto still = after_a_few_steps<TypeParam>(plastic_steel, seed, Eigen::Matrix3d::Identity());
    const auto turned = after_a_few_steps<TypeParam>(plastic_steel, seed, turn);
    EXPECT_LT((turned.force - turn * still.force).norm(), 1e-11 * still.force.norm());
    EXPECT_NEAR(turned.internal_energy, still.internal_energy, 1e-11 * std::abs(still.internal_energy));
    EXPECT_NEAR(turned.increment.stable_step, still.increment.stable_step,
                1e-12 * still.increment.stable_step);
  }
}

TYPED_TEST(Solids, NothingIsLostAMillionSizesAway) {
  const Eigen::Vector3d far(1e6, -3e6, 2e6);
  const auto near = after_a_few_steps<TypeParam>(plastic_steel, 61, Eigen::Matrix3d::Identity());
  const auto away = after_a_few_steps<TypeParam>(plastic_steel, 61, Eigen::Matrix3d::Identity(), far);
  // Positions there are rounded to 5e-10 sizes; strains are of size 0.02.
  EXPECT_LT((away.force - near.force).norm(), 1e-6 * near.force.norm());
  EXPECT_NEAR(away.internal_energy, near.internal_energy, 1e-6 * near.internal_energy);
}

TYPED_TEST(Solids, UnitsScaledByPowersOfTwoGiveTheSameBits) {
  const double length = 0x1p-10, time = 0x1p13, mass = 0x1p20;
  ElasticPlastic scaled = plastic_steel;
  const double stress = mass / (length * time * time);
  scaled.density *= mass / (length * length * length);
  scaled.youngs_modulus *= stress;
  scaled.yield_stress *= stress;
  scaled.hardening_modulus *= stress;
  const auto one = after_a_few_steps<TypeParam>(plastic_steel, 62, Eigen::Matrix3d::Identity());
  const auto other = after_a_few_steps<TypeParam>(scaled, 62, Eigen::Matrix3d::Identity(),
                                                  Eigen::Vector3d::Zero(), length, time);
  EXPECT_EQ(Corners(other.force), Corners(one.force * (mass * length / (time * time))));
  EXPECT_EQ(other.internal_energy, one.internal_energy * (mass * length * length / (time * time)));
  EXPECT_EQ(other.increment.stable_step, one.increment.stable_step * time);
}

/// A smooth large motion in n steps: energy of the element less the work of the forces, over the largest
/// energy on the way.
template <class Kernel>
double energy_gap(const Corners& start, const Corners& amplitude, int steps) {
  SingleElement<Kernel, Elastic> element({}, elastic_steel, start);
  Corners x = start, old_force = Corners::Zero();
  double work = 0, accounted = 0, largest = 0;
  const double step = 1.0 / steps;
  for (int i = 1; i <= steps; ++i) {
    const double t = std::numbers::pi * i * step;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.7 * t, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Corners next = turn * (start + square(std::sin(t)) * amplitude);
    element.move_to(next, step);
    work += 0.5 * ((element.force + old_force).array() * (next - x).array()).sum();
    old_force = element.force;
    x = next;
    accounted = element.internal_energy + element.hourglass_energy + element.viscous_energy;
    largest = std::max(largest, accounted);
  }
  return std::abs(accounted - work) / largest;
}

TYPED_TEST(Solids, ElementEnergyIsTheWorkOfTheForcesToSecondOrder) {
  Noise noise(63);
  const Corners start = test::distorted(noise, 0.2);
  const Corners affine = 0.3 * noise.matrix<Eigen::Matrix3d>() * start;
  const double coarse = energy_gap<TypeParam>(start, affine, 50);
  const double fine = energy_gap<TypeParam>(start, affine, 200);
  EXPECT_GT(coarse, 0);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(fine, coarse / 12);
}

TYPED_TEST(Solids, ElementEnergyIsTheWorkOfTheForcesInNonuniformMotion) {
  Noise noise(63);
  const Corners start = test::distorted(noise, 0.2);
  const Corners amplitude = 0.15 * noise.matrix<Corners>();
  const double coarse = energy_gap<TypeParam>(start, amplitude, 50);
  const double fine = energy_gap<TypeParam>(start, amplitude, 200);
  // Of first order only: the mean gradient of the middle is that of the affine part of the motion. With a
  // node moving through 15 % of a side in 50 steps it is a thousandth of the energy.
  EXPECT_LT(coarse, 2e-3);
  EXPECT_LT(fine, coarse / 3);
}

TYPED_TEST(Solids, ConvergesToSecondOrderInTheStep) {
  const auto stress = [](int steps) {
    Eigen::Matrix3d gradient;
    gradient << 0.3, 0.9, -0.2, 0.1, -0.2, 0.4, -0.5, 0.3, 0.2;
    SingleElement<TypeParam, Elastic> element({}, elastic_steel, test::box(1, 1, 1));
    for (int i = 1; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const Eigen::Matrix3d f =
          Eigen::Matrix3d::Identity() + t * gradient + 0.3 * std::sin(3 * t) * gradient.transpose();
      element.move_to(f * test::box(1, 1, 1), 1.0 / steps);
    }
    return element.stress();
  };
  const Eigen::Matrix3d exact = stress(8000);
  const double coarse = (stress(100) - exact).norm(), fine = (stress(400) - exact).norm();
  EXPECT_LT(coarse, 1e-3 * exact.norm());
  EXPECT_LT(fine, coarse / 12);
}

TYPED_TEST(Solids, LanesEqualPlainNumbers) {
  using T = Lanes<double>;
  Noise noise(64);
  TypeParam kernel;
  kernel.linear_bulk_viscosity = 0.1;
  NodalMotion<T, 8> motion;
  std::array<NodalMotion<double, 8>, 8> plain;
  for (int lane = 0; lane < 8; ++lane) {
    const Corners x = test::distorted(noise, 0.3);
    plain[index(lane)] = test::motion_of(x, 300 * noise.matrix<Corners>());
    for (int i = 0; i < 3; ++i)
      for (int n = 0; n < 8; ++n) {
        motion.position[i][n].set(lane, plain[index(lane)].position[i][n]);
        motion.velocity[i][n].set(lane, plain[index(lane)].velocity[i][n]);
      }
  }
  typename TypeParam::template Header<T, ElasticPlastic> header{};
  typename TypeParam::template Point<T, ElasticPlastic> point[TypeParam::points()]{};
  kernel.initialize(motion, plastic_steel, header, point);
  NodalForces<T, 8> forces;
  const Increment<T> increment = kernel.force(motion, T(1e-4), plastic_steel, header, point, forces);
  for (int lane = 0; lane < 8; ++lane) {
    typename TypeParam::template Header<double, ElasticPlastic> one_header{};
    typename TypeParam::template Point<double, ElasticPlastic> one_point[TypeParam::points()]{};
    const auto& one = plain[index(lane)];
    kernel.initialize(one, plastic_steel, one_header, one_point);
    NodalForces<double, 8> one_forces;
    const Increment<double> expected =
        kernel.force(one, 1e-4, plastic_steel, one_header, one_point, one_forces);
    const double size = test::forces_of(one_forces).norm();
    for (int i = 0; i < 3; ++i)
      for (int n = 0; n < 8; ++n) EXPECT_NEAR(forces.force[i][n][lane], one_forces.force[i][n], 1e-12 * size);
    EXPECT_NEAR(increment.internal_energy[lane], expected.internal_energy,
                1e-12 * std::abs(expected.internal_energy));
    EXPECT_NEAR(increment.stable_step[lane], expected.stable_step, 1e-13 * expected.stable_step);
  }
}

TYPED_TEST(Solids, SinglePrecisionFollowsDoubleToItsOwnAccuracy) {
  using T = Lanes<float>;
  Noise noise(65);
  const TypeParam kernel;
  for (int trial = 0; trial < 10; ++trial) {
    Corners x = test::distorted(noise, 0.3);
    SingleElement<TypeParam, ElasticPlastic> exact(kernel, plastic_steel, x);
    typename TypeParam::template Header<T, ElasticPlastic> header{};
    typename TypeParam::template Point<T, ElasticPlastic> point[TypeParam::points()]{};
    kernel.initialize(test::motion_of<T>(x, Corners::Zero()), plastic_steel, header, point);
    NodalForces<T, 8> forces;
    for (int step = 0; step < 10; ++step) {
      const Corners v = 200 * noise.matrix<Corners>();
      x += 1e-4 * v;
      exact.update(x, v, 1e-4);
      kernel.force(test::motion_of<T>(x, v), T(1e-4), plastic_steel, header, point, forces);
    }
    Corners difference = exact.force;
    for (int i = 0; i < 3; ++i)
      for (int n = 0; n < 8; ++n) difference(i, n) -= static_cast<double>(forces.force[i][n][0]);
    EXPECT_LT(difference.norm(), 1e-4 * exact.force.norm());
  }
}

TYPED_TEST(Solids, RigidRotationKeepsTheStressOfAStretchedBrick) {
  SingleElement<TypeParam, Elastic> element({}, elastic_steel, test::box(1, 1, 1));
  const Corners x = test::box(1.1, 0.95, 1.0);
  element.move_to(x, 1e-4);
  const Eigen::Matrix3d stress = element.stress();
  const double energy = element.internal_energy;
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  const int steps_a_turn = 10, turns = 10000;
  double work = 0;
  for (int step = 1; step <= steps_a_turn * turns; ++step) {
    const double angle = 2 * std::numbers::pi * (step % steps_a_turn) / steps_a_turn;
    element.move_to(Eigen::AngleAxisd(angle, axis).toRotationMatrix() * x, 1e-4);
    work += std::abs(element.increment.internal_energy) + std::abs(element.increment.hourglass_energy) +
            std::abs(element.increment.viscous_energy);
  }
  EXPECT_LT((element.stress() - stress).norm(), 1e-9 * stress.norm());
  EXPECT_LT(work, 1e-9 * energy);
}

TYPED_TEST(Solids, RigidRotationMeetsNoViscosity) {
  SingleElement<TypeParam, Elastic> element({}, elastic_steel, test::box(1, 1, 1));
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  for (int step = 1; step <= 20; ++step) {
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.3 * step, axis).toRotationMatrix();
    element.move_to(turned * test::box(1, 1, 1), 1e-4);
    // What a rate of dilatation of 1 / step would meet is of the order of the moduli.
    EXPECT_LT(element.force.norm(), 1e-12 * elastic_steel.youngs_modulus);
  }
}

TYPED_TEST(Solids, InvertedBrickHasNoStableStep) {
  SingleElement<TypeParam, Elastic> element({}, elastic_steel, test::box(1, 1, 1));
  element.move_to(test::box(1, 1, -0.1), 1e-3);
  EXPECT_LT(element.increment.stable_step, 0);
  EXPECT_TRUE(element.force.allFinite());
}

TYPED_TEST(Solids, FirstCallNeedsNoStep) {
  Noise noise(66);
  const Corners x = test::distorted(noise, 0.3);
  SingleElement<TypeParam, Elastic> element({}, elastic_steel, x);
  element.update(x, noise.matrix<Corners>(), 0);
  EXPECT_GT(element.increment.stable_step, 0);
  EXPECT_EQ(element.internal_energy, 0);
  EXPECT_TRUE(element.force.allFinite());
}

// Uniform stretch and turn of a neo-Hookean cube against J sigma = mu (b - I) + lambda ln J I.
template <class Kernel>
void expect_neo_hookean_stress() {
  const NeoHookean rubber{.density = 1000, .youngs_modulus = 1e6, .poissons_ratio = 0.4};
  const double mu = 1e6 / 2.8, lambda = 1e6 * 0.4 / (1.4 * 0.2);
  Kernel kernel;
  SingleElement<Kernel, NeoHookean> element(kernel, rubber, test::box(1, 1, 1));
  Eigen::Matrix3d gradient;
  gradient << 0.5, 0.9, -0.2, 0.1, -0.2, 0.4, -0.5, 0.3, 0.2;
  const int steps = 4000;
  for (int i = 1; i <= steps; ++i) {
    const Eigen::Matrix3d f = Eigen::Matrix3d::Identity() + gradient * i / steps;
    element.move_to(f * test::box(1, 1, 1), 1e-3);
    if (i % 1000 != 0) continue;
    const double j = f.determinant();
    const Eigen::Matrix3d exact = (mu * (f * f.transpose() - Eigen::Matrix3d::Identity()) +
                                   lambda * std::log(j) * Eigen::Matrix3d::Identity()) /
                                  j;
    EXPECT_LT((element.stress() - exact).norm(), 1e-5 * exact.norm());
  }
}
TEST(Hex8, NeoHookeanStressFollowsFromTheStretch) {
  expect_neo_hookean_stress<Hex8Kernel<ObjectiveRate::green_naghdi>>();
}
TEST(Hex8Full, NeoHookeanStressFollowsFromTheStretch) {
  expect_neo_hookean_stress<Hex8FullKernel<ObjectiveRate::green_naghdi>>();
}

}  // namespace
}  // namespace brio
