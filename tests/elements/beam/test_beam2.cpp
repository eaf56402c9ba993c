#include <gtest/gtest.h>

#include <random>

#include "src/base/index.hpp"
#include "tests/elements/beam/single_beam.hpp"

namespace brio {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

class Random {
 public:
  double number(double size = 1) { return size * uniform_(engine_); }
  Eigen::Vector3d vector(double size = 1) { return {number(size), number(size), number(size)}; }
  Quaterniond turn() { return Quaterniond(number(), number(), number(), number()).normalized(); }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

Quaterniond turn_by(const Eigen::Vector3d& v) {
  return Quaterniond(Eigen::AngleAxisd(v.norm(), v.normalized()));
}

/// Stiffness of a straight Timoshenko beam along x, as textbooks give it (Przemieniecki 1968, eq. 5.116).
Matrix12 timoshenko(const FibreSection& s, double length, double modulus, double shear) {
  Matrix12 k = Matrix12::Zero();
  // Place of translation and rotation i of node n.
  const auto u = [](int n, int i) { return 3 * n + i; };
  const auto r = [](int n, int i) { return 6 + 3 * n + i; };
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      const double sign = a == b ? 1 : -1;
      k(u(a, 0), u(b, 0)) = sign * modulus * s.area / length;
      k(r(a, 0), r(b, 0)) = sign * shear * s.torsion_constant / length;
      for (int plane = 0; plane < 2; ++plane) {  // 0: deflection along y, turning about z
        const int d = plane == 0 ? 1 : 2;
        const int t = plane == 0 ? 2 : 1;
        const double moment = plane == 0 ? s.second_moment_z : s.second_moment_y;
        const double factor = plane == 0 ? s.shear_factor_y : s.shear_factor_z;
        const double phi = 12 * modulus * moment / (factor * shear * s.area * length * length);
        const double c = modulus * moment / (length * length * length * (1 + phi));
        const double hand = plane == 0 ? 1 : -1;
        k(u(a, d), u(b, d)) = sign * 12 * c;
        k(r(a, t), r(b, t)) = (a == b ? 4 + phi : 2 - phi) * length * length * c;
        k(u(a, d), r(b, t)) = (a == 0 ? 1 : -1) * hand * 6 * length * c;
        k(r(b, t), u(a, d)) = k(u(a, d), r(b, t));
      }
    }
  return k;
}

std::vector<BeamSection> sections() {
  return {CircleSection{.radius = 0.1}, TubeSection{.outer_radius = 0.1, .inner_radius = 0.09},
          RectangleSection{.width = 0.1, .height = 0.3},
          ISection{.width = 0.1, .height = 0.2, .web_thickness = 0.01, .flange_thickness = 0.02}};
}

TEST(Beam2, HasTimoshenkosStiffnessForAnyLengthAndDirection) {
  Random random;
  for (const BeamSection& section : sections())
    for (const double length : {0.05, 1.0, 20.0}) {
      const Quaterniond turn = random.turn();
      const Pair ends{random.vector(), Eigen::Vector3d::Zero()};
      const Pair x{ends[0], ends[0] + length * (turn * Eigen::Vector3d::UnitX())};
      const SingleBeam<> beam(beam_of(section, turn * Eigen::Vector3d::UnitZ()), steel(), x);
      const Matrix12 local = timoshenko(*beam.beam.fibres, length, 200e9, 200e9 / 2.6);
      Matrix12 rotation = Matrix12::Zero();
      for (int block = 0; block < 4; ++block) rotation.block<3, 3>(3 * block, 3 * block) = turn.matrix();
      const Matrix12 expected = rotation * local * rotation.transpose();
      const Matrix12 found = stiffness_of(beam, 1e-6 * std::min(length, 1.0));
      // Each of the four blocks by itself: they have different units.
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          const Matrix12 difference = found - expected;
          EXPECT_LT((difference.block<6, 6>(6 * i, 6 * j).norm()),
                    1e-8 * (expected.block<6, 6>(6 * i, 6 * j).norm()))
              << length << " " << i << j;
        }
    }
}

/// A beam whose nodes were moved and turned far.
SingleBeam<> strained_beam(Random& random, double size) {
  SingleBeam<> beam(beam_of(RectangleSection{.width = 0.2, .height = 0.3}, {0, 0.2, 1}), steel(),
                    {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(2, 2.1, 3.2)});
  const Pair start = beam.position;
  const Pair turn{random.vector(size), random.vector(size)};
  const Eigen::Vector3d shift = random.vector(size * 0.5);
  for (int k = 1; k <= 10; ++k)
    beam.move({start[0], start[1] + 0.1 * k * shift}, {0.1 * turn[0], 0.1 * turn[1]});
  return beam;
}

TEST(Beam2, ForcesOfAnyStateHaveNeitherResultantNorMoment) {
  Random random;
  for (int k = 0; k < 100; ++k) {
    const SingleBeam<> beam = strained_beam(random, 0.8);
    ASSERT_GT(beam.increment.stable_step, 0);
    const double size = beam.force(0).norm() + beam.moment(0).norm() + beam.moment(1).norm();
    EXPECT_LT((beam.force(0) + beam.force(1)).norm(), 1e-13 * size);
    EXPECT_LT(
        (beam.moment(0) + beam.moment(1) + (beam.position[1] - beam.position[0]).cross(beam.force(1))).norm(),
        1e-13 * size);
  }
}

TEST(Beam2, ForcesAreTheGradientOfTheStrainEnergyAtLargeStrain) {
  Random random;
  for (int k = 0; k < 20; ++k) {
    const SingleBeam<> beam = strained_beam(random, 0.8);
    constexpr double small = 1e-6;
    const Eigen::Matrix<double, 12, 1> force = beam.all();
    for (int c = 0; c < 12; ++c) {
      double difference = 0;
      for (const double sign : {1.0, -1.0}) {
        SingleBeam<> moved = beam;
        Pair x = beam.position;
        Pair turn{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
        (c < 6 ? x : turn)[index(c % 6 / 3)][c % 3] += sign * small;
        moved.move(x, turn);
        difference += sign * moved.header.internal_energy;
      }
      EXPECT_NEAR(difference / (2 * small), force[c], 1e-7 * force.norm()) << c;
    }
  }
}

TEST(Beam2, WorkAlongAnyPathIsTheStrainEnergyAndComesBack) {
  Random random;
  SingleBeam<> beam = strained_beam(random, 0.7);
  const double energy = beam.header.internal_energy;
  const Pair x = beam.position;
  EXPECT_GT(energy, 0);
  const Pair turn{random.vector(0.3), random.vector(0.3)};
  beam.move({x[0] + random.vector(0.1), x[1]}, turn);
  EXPECT_GT(std::abs(beam.header.internal_energy - energy), 1e-3 * energy);
  beam.move(x, {-turn[0], -turn[1]});
  EXPECT_NEAR(beam.header.internal_energy, energy, 1e-12 * energy);
}

TEST(Beam2, RigidRotationOfAStrainedBeamTurnsItsForcesAndNothingElse) {
  Random random;
  for (int k = 0; k < 20; ++k) {
    SingleBeam<> beam = strained_beam(random, 0.8);
    const Pair start = beam.position;
    const Eigen::Matrix<double, 12, 1> force = beam.all();
    const double energy = beam.header.internal_energy;
    const double step = beam.increment.stable_step;
    const Eigen::Vector3d turn = random.vector(1.5);  // up to 2.6 radians in a step
    Quaterniond total = Quaterniond::Identity();
    for (int n = 0; n < 50; ++n) {
      total = turn_by(turn) * total;
      beam.move({total * start[0], total * start[1]}, {turn, turn});
    }
    for (int block = 0; block < 4; ++block)
      EXPECT_LT((beam.all().segment<3>(3 * block) - total * force.segment<3>(3 * block)).norm(),
                1e-11 * force.norm());
    EXPECT_NEAR(beam.header.internal_energy, energy, 1e-12 * energy);
    EXPECT_NEAR(beam.increment.stable_step, step, 1e-11 * step);
  }
}

TEST(Beam2, BendingToAnyAngleNeedsTheSameMomentPerAngle) {
  // An arc of 150 degrees in one element: the moment is E I angle / L.
  const double angle = 150 * M_PI / 180;
  SingleBeam<> beam(beam_of(RectangleSection{.width = 0.1, .height = 0.2}, {0, 0, 1}), steel(),
                    {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0)});
  for (int k = 0; k < 10; ++k)
    beam.move(beam.position, {Eigen::Vector3d(0, -angle / 20, 0), Eigen::Vector3d(0, angle / 20, 0)});
  const double moment = 200e9 * 0.1 * std::pow(0.2, 3) / 12 * angle;
  EXPECT_NEAR(beam.moment(1).y() / moment, 1, 1e-12);
  EXPECT_NEAR(beam.moment(0).y() / moment, -1, 1e-12);
  EXPECT_LT(beam.force(1).norm(), 1e-9 * moment);
}

TEST(Beam2, StableStepIsThatOfItsHighestFrequency) {
  for (const BeamSection& section : sections())
    for (const double length : {0.02, 0.1, 0.5, 2.0, 50.0}) {
      const Beam2 element = beam_of(section, {0, 0, 1});
      SingleBeam<> beam(element, steel(), {Eigen::Vector3d::Zero(), Eigen::Vector3d(length, 0, 0)});
      beam.move(beam.position, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
      Matrix12 k = timoshenko(*element.fibres, length, 200e9, 200e9 / 2.6);
      Eigen::Matrix<double, 12, 1> scale;
      scale.head<6>().setConstant(1 / std::sqrt(beam.mass.mass));
      scale.tail<6>().setConstant(1 / std::sqrt(beam.mass.rotational_inertia));
      k = scale.asDiagonal() * k * scale.asDiagonal();
      const double highest = Eigen::SelfAdjointEigenSolver<Matrix12>(k).eigenvalues().maxCoeff();
      EXPECT_NEAR(beam.increment.stable_step * std::sqrt(highest) / 2, 1, 1e-12);
      // Never much below that of stretching.
      EXPECT_GT(beam.increment.stable_step, 0.5 * length / std::sqrt(200e9 / 7850));
    }
}

TEST(Beam2, StrainedAndShortenedBeamsKeepASoundStep) {
  Random random;
  for (int k = 0; k < 100; ++k) {
    SingleBeam<> beam = strained_beam(random, 0.3);
    Matrix12 stiffness = stiffness_of(beam, 1e-6);
    stiffness = (0.5 * (stiffness + stiffness.transpose())).eval();
    Eigen::Matrix<double, 12, 1> scale;
    scale.head<6>().setConstant(1 / std::sqrt(beam.mass.mass));
    scale.tail<6>().setConstant(1 / std::sqrt(beam.mass.rotational_inertia));
    stiffness = scale.asDiagonal() * stiffness * scale.asDiagonal();
    const double highest = Eigen::SelfAdjointEigenSolver<Matrix12>(stiffness).eigenvalues().maxCoeff();
    const double ratio = beam.increment.stable_step * std::sqrt(highest) / 2;
    // Strains of some tenths: within the share of the step that is not used by default.
    EXPECT_LT(ratio, 1 / 0.9);
    EXPECT_GT(ratio, 0.7);
  }
}

TEST(Beam2, MassAndInertiaAreThoseOfARod) {
  const SingleBeam<> beam(beam_of(CircleSection{.radius = 0.1}, {0, 0, 1}), steel(),
                          {Eigen::Vector3d::Zero(), Eigen::Vector3d(2, 0, 0)});
  EXPECT_NEAR(2 * beam.mass.mass, 7850 * M_PI * 0.01 * 2, 1e-9);
  EXPECT_NEAR(2 * beam.mass.rotational_inertia, 7850 * M_PI * 1e-4 / 2 * 2, 1e-12);
}

TEST(Beam2, WhatFoldsOntoItselfOrHasNoLengthIsBroken) {
  SingleBeam<> beam(beam_of(CircleSection{.radius = 0.1}, {0, 0, 1}), steel(),
                    {Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 0, 0)});
  SingleBeam<> folded = beam;
  folded.move({Eigen::Vector3d::Zero(), Eigen::Vector3d(-1, 0, 0)},
              {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  EXPECT_EQ(folded.increment.stable_step, 0);
  SingleBeam<> collapsed = beam;
  collapsed.move({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()},
                 {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  EXPECT_EQ(collapsed.increment.stable_step, 0);
  SingleBeam<> twisted = beam;
  for (int k = 0; k < 4; ++k)
    twisted.move(beam.position, {Eigen::Vector3d(-0.5, 0, 0), Eigen::Vector3d(0.5, 0, 0)});
  EXPECT_EQ(twisted.increment.stable_step, 0);
  SingleBeam<> along(beam_of(CircleSection{.radius = 0.1}, {1, 0, 0}), steel(),
                     {Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 0, 0)});
  EXPECT_EQ(along.mass.mass, 0);
}

TEST(Beam2, SampleGivesTheMeanStressOnGlobalAxes) {
  const Quaterniond turn = Random().turn();
  const Eigen::Vector3d x = turn * Eigen::Vector3d::UnitX();
  SingleBeam<> beam(beam_of(CircleSection{.radius = 0.1}, turn * Eigen::Vector3d::UnitZ()), steel(),
                    {Eigen::Vector3d::Zero(), x});
  beam.move({Eigen::Vector3d::Zero(), 1.001 * x}, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  const ElementSample sample = beam.sample();
  const double stress = 200e9 * std::log(1.001);
  EXPECT_NEAR(sample.stress.xx, stress * x[0] * x[0], 1e-12 * stress);
  EXPECT_NEAR(sample.stress.yz, stress * x[1] * x[2], 1e-12 * stress);
  EXPECT_EQ(sample.radius, 0.1);
  EXPECT_NEAR(sample.internal_energy, 0.5 * stress * std::log(1.001) * M_PI * 0.01, 1e-12 * stress);
}

}  // namespace
}  // namespace brio
