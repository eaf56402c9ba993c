// Largest principal values against Eigen's eigenvalues, on plain numbers and on lanes.

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "materials/principal_stress.hpp"
#include "src/base/index.hpp"
#include "tests/materials/paths.hpp"

namespace brio {
namespace {

Eigen::Matrix3d matrix_of(const SymmetricTensor<double>& a) {
  Eigen::Matrix3d m;
  m << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz;
  return m;
}

/// The value agrees with Eigen's to round-off, and the direction satisfies its equation.
void expect_largest(const SymmetricTensor<double>& a, double tolerance, double value,
                    const Eigen::Vector3d& direction) {
  const Eigen::Matrix3d m = matrix_of(a);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
  const double size = m.cwiseAbs().maxCoeff();
  EXPECT_NEAR(value, solver.eigenvalues()(2), tolerance * size) << m;
  EXPECT_NEAR(direction.norm(), 1, tolerance) << m;
  EXPECT_LE((m * direction - value * direction).norm(), tolerance * size) << m;
}

/// Tensors with given principal values in random directions, sizes over many decades.
std::vector<SymmetricTensor<double>> tensors() {
  RandomPath random(7);
  std::vector<SymmetricTensor<double>> result{
      {0, 0, 0, 0, 0, 0},  {1, 1, 1, 0, 0, 0},  {-1, -1, -1, 0, 0, 0}, {0, 0, 0, 1, 0, 0},
      {0, 0, 0, 1, 1, 1},  {0, 0, 0, -1, 1, 1}, {1, 0, 0, 0, 0, 0},    {0, 1, 0, 0, 0, 0},
      {0, 0, -1, 0, 0, 0}, {1, 1, 0, 0, 0, 0},  {2, 1, 0, 1e-9, 0, 0}, {1, 1, 1, 1e-17, 0, 0}};
  const double values[][3] = {{1, 2, 3},  {1, 1, 2},         {1, 2, 2},          {-1, -1, 2},
                              {-2, 1, 1}, {1, 1 + 1e-15, 2}, {1, 2, 2 + 1e-15},  {1, 1e-8, 1e-16},
                              {5, 5, 5},  {-3, -2, -1},      {1e-20, 1, -1e-20}, {0, 0, -1}};
  for (const auto& v : values)
    for (int turn = 0; turn < 40; ++turn) {
      const double scale = std::pow(10.0, random.uniform(-12, 12));
      result.push_back(rotated(random_rotation(random),
                               SymmetricTensor<double>{scale * v[0], scale * v[1], scale * v[2], 0, 0, 0}));
    }
  for (int k = 0; k < 2000; ++k)
    result.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                      random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  return result;
}

TEST(PrincipalStress, LargestValueAndDirectionAgreeWithEigen) {
  for (const auto& a : tensors()) {
    const PrincipalValue<double> p = largest_principal(a);
    expect_largest(a, 4e-15, p.value, {p.direction.x, p.direction.y, p.direction.z});
  }
}

template <Floating Real>
void expect_lanes(double tolerance) {
  using T = Lanes<Real>;
  const auto all_tensors = tensors();
  for (std::size_t first = 0; first + lane_count<Real> <= all_tensors.size(); first += lane_count<Real>) {
    SymmetricTensor<T> a;
    T* component[6] = {&a.xx, &a.yy, &a.zz, &a.xy, &a.yz, &a.xz};
    for (int lane = 0; lane < lane_count<Real>; ++lane) {
      const auto& one = all_tensors[first + index(lane)];
      const double entries[6] = {one.xx, one.yy, one.zz, one.xy, one.yz, one.xz};
      for (int c = 0; c < 6; ++c) component[c]->set(lane, static_cast<Real>(entries[c]));
    }
    const PrincipalValue<T> p = largest_principal(a);
    for (int lane = 0; lane < lane_count<Real>; ++lane) {
      const SymmetricTensor<double> one{a.xx[lane], a.yy[lane], a.zz[lane],
                                        a.xy[lane], a.yz[lane], a.xz[lane]};
      expect_largest(one, tolerance, p.value[lane],
                     {p.direction.x[lane], p.direction.y[lane], p.direction.z[lane]});
    }
  }
}

TEST(PrincipalStress, LanesAgreeWithEigen) {
  expect_lanes<double>(4e-15);
  expect_lanes<float>(1e-6);
}

TEST(PrincipalStress, ScalesExactlyByPowersOfTwo) {
  for (const auto& a : tensors()) {
    const PrincipalValue<double> one = largest_principal(a), large = largest_principal(0x1p60 * a);
    EXPECT_EQ(0x1p60 * one.value, large.value);
    EXPECT_EQ(one.direction.x, large.direction.x);
  }
}

TEST(PrincipalStress, StrainAlongADirectionIsThatOfTheTurnedTensor) {
  RandomPath random(8);
  for (int k = 0; k < 100; ++k) {
    const Tensor<double> r = random_rotation(random);
    const SymmetricTensor<double> a = random.next();
    EXPECT_NEAR(along(a, Vector3<double>{r(0, 0), r(0, 1), r(0, 2)}), rotated(r, a).xx, 1e-16);
  }
}

}  // namespace
}  // namespace brio
