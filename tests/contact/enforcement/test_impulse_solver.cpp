#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

#include "src/base/index.hpp"
#include "tests/contact/enforcement/row_scenes.hpp"

namespace brio {
namespace {

using namespace test;

TEST(Impulses, TwoMassesMoveOnTogether) {
  for (double ratio : {1e-9, 1e-3, 1.0, 1e3, 1e9}) {
    RowScene scene;
    scene.blocks = {moving(1, {1, 0.5, -2}), moving(ratio, {0, 0, 1})};
    scene.rows.add_row({0, 0, 1}, 0, 0);
    scene.rows.add_point(0, Side::first);
    scene.rows.add_point(1, Side::second);
    const SolveReport report = solve(scene, to_the_end());
    EXPECT_TRUE(report.converged);
    const double expected = (-2 + ratio) / (1 + ratio);
    EXPECT_NEAR(scene.blocks[0].velocity.z, expected, 1e-13 * 3);
    EXPECT_NEAR(scene.blocks[1].velocity.z, expected, 1e-13 * 3);
    EXPECT_EQ(scene.blocks[0].velocity.x, 1);
    EXPECT_NEAR(scene.rows.row[0].impulse, 3 / (1 + 1 / ratio), 1e-13 * ratio / (1 + ratio) * 3);
  }
}

TEST(Impulses, WhatPartsIsLeftAlone) {
  RowScene scene;
  scene.blocks = {moving(1, {0, 0, 1}), moving(1, {0, 0, 0.5})};
  scene.rows.add_row({0, 0, 1}, 0, 0.5);
  scene.rows.add_point(0, Side::first);
  scene.rows.add_point(1, Side::second);
  // Even where an impulse is carried over.
  scene.rows.row[0].impulse = 0.1;
  scene.rows.row[0].friction = {0.05, 0, 0};
  solve(scene, to_the_end());
  EXPECT_EQ(scene.rows.row[0].impulse, 0);
  EXPECT_EQ(norm(scene.rows.row[0].friction), 0);
  EXPECT_EQ(scene.blocks[0].velocity.z, 1);
  EXPECT_EQ(scene.blocks[1].velocity.z, 0.5);
}

TEST(Impulses, GapMayClose) {
  RowScene scene;
  scene.blocks = {moving(1, {0, 0, -3})};
  add_wall_row(scene, 0, {0, 0, 1}).target_velocity = -2;
  solve(scene, to_the_end());
  EXPECT_DOUBLE_EQ(scene.blocks[0].velocity.z, -2);
}

TEST(Impulses, WallMayMove) {
  RowScene scene;
  scene.blocks = {moving(1, {0, 0, -3})};
  add_wall_row(scene, 0, {0, 0, 1}, 10).wall_velocity = {0.2, 0.1, 0.5};
  solve(scene, to_the_end());
  EXPECT_LT(norm(scene.blocks[0].velocity - Vector3d{0.2, 0.1, 0.5}), 1e-14);
}

// Complementarity found by trying every set of rows that touch.
Eigen::VectorXd exact_impulses(const Eigen::MatrixXd& a, const Eigen::VectorXd& free) {
  const auto count = static_cast<int>(free.size());
  for (int set = 0; set < 1 << count; ++set) {
    std::vector<int> active;
    for (int i = 0; i < count; ++i)
      if (set >> i & 1) active.push_back(i);
    Eigen::VectorXd impulse = Eigen::VectorXd::Zero(count);
    if (!active.empty()) {
      const Eigen::VectorXd solved = a(active, active).ldlt().solve(-free(active));
      if (solved.minCoeff() < 0) continue;
      impulse(active) = solved;
    }
    if ((a * impulse + free).minCoeff() >= -1e-12) return impulse;
  }
  return {};
}

TEST(Impulses, AgreeWithTheExactSolutionOfTheComplementarityProblem) {
  RandomNumbers random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    RowScene scene;
    for (int b = 0; b < 6; ++b) scene.blocks.push_back(moving(random.between(0.5, 2), random.vector()));
    const int count = 4 + random.below(5);
    for (int i = 0; i < count; ++i) {
      scene.rows.add_row(random.direction(), 0, 0).target_velocity = random.number(0.1);
      int order[6] = {0, 1, 2, 3, 4, 5};
      std::shuffle(order, order + 6, random.engine());
      scene.rows.add_point(order[0], Side::first);
      const double share = random.between(0, 1);
      scene.rows.add_nodes(std::span(order + 1, 2), std::vector<double>{share, 1 - share}, Side::second);
    }
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(count, 18);
    Eigen::VectorXd free(count);
    for (int i = 0; i < count; ++i) {
      const ConstraintRow& row = scene.rows.row[index(i)];
      const RowMap map(scene.rows, row);
      free[i] = dot(row.normal, map.relative_velocity(scene.blocks)) - row.target_velocity;
      map.spread(row.normal, [&](int b, const Vector3d& v) {
        const double scale = std::sqrt(scene.blocks[index(b)].inverse_mass.xx);
        jacobian.row(i).segment<3>(3 * b) += scale * Eigen::RowVector3d(v.x, v.y, v.z);
      });
    }
    const Eigen::MatrixXd a = jacobian * jacobian.transpose();
    // Where impulses are well defined.
    if (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues()[0] < 1e-3) continue;
    const Eigen::VectorXd expected = exact_impulses(a, free);
    ASSERT_EQ(expected.size(), count);
    EXPECT_TRUE(solve(scene, to_the_end()).converged);
    for (int i = 0; i < count; ++i)
      EXPECT_NEAR(scene.rows.row[index(i)].impulse, expected[i], 1e-9 * (1 + expected.norm()));
  }
}

// In a chain that touches, velocities become the nearest that do not approach: a regression with an order,
// found exactly by pooling neighbours that violate it.
std::vector<double> pooled(const std::vector<double>& mass, const std::vector<double>& velocity) {
  std::vector<std::array<double, 3>> pools;  // mass, velocity, how many
  for (std::size_t i = 0; i < mass.size(); ++i) {
    pools.push_back({mass[i], velocity[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2][1] > pools.back()[1]) {
      const std::array<double, 3> b = pools.back();
      pools.pop_back();
      std::array<double, 3>& a = pools.back();
      a = {a[0] + b[0], (a[0] * a[1] + b[0] * b[1]) / (a[0] + b[0]), a[2] + b[2]};
    }
  }
  std::vector<double> result;
  for (const auto& [m, v, count] : pools) result.insert(result.end(), static_cast<std::size_t>(count), v);
  return result;
}

TEST(Impulses, ChainsOfTwentyMassesPool) {
  RandomNumbers random(5);
  for (int trial = 0; trial < 50; ++trial) {
    RowScene scene;
    std::vector<double> mass;
    std::vector<double> velocity;
    const Vector3d along = random.direction();
    for (int b = 0; b < 20; ++b) {
      mass.push_back(trial == 0 ? 1 : random.between(0.5, 2));
      velocity.push_back(trial == 0 ? (b == 0 ? 1 : 0) : random.number());
      scene.blocks.push_back(moving(mass.back(), velocity.back() * along));
      if (b == 0) continue;
      scene.rows.add_row(along, 0, 0);
      scene.rows.add_point(b, Side::first);
      scene.rows.add_point(b - 1, Side::second);
    }
    EXPECT_TRUE(solve(scene, to_the_end()).converged);
    const std::vector<double> expected = pooled(mass, velocity);
    for (std::size_t b = 0; b < 20; ++b)
      EXPECT_LT(norm(scene.blocks[b].velocity - expected[b] * along), 1e-11);
  }
}

TEST(Impulses, RepeatedRowsAreOne) {
  RandomNumbers random(6);
  RowScene once;
  once.blocks = {moving(1, {0.3, 0, -2}), moving(2, {0, 0.1, 0.2}), moving(3, {0, 0, 0})};
  const auto add = [](RowScene& scene) {
    scene.rows.add_row(unit({0.1, 0.2, 1}), 0, 0.3);
    scene.rows.add_point(0, Side::first);
    scene.rows.add_point(1, Side::second, 0.4);
    scene.rows.add_point(2, Side::second, 0.6);
  };
  RowScene often = once;
  add(once);
  for (int i = 0; i < 20; ++i) add(often);
  solve(once, to_the_end());
  solve(often, to_the_end());
  for (std::size_t b = 0; b < 3; ++b)
    EXPECT_LT(norm(once.blocks[b].velocity - often.blocks[b].velocity), 1e-13);
}

TEST(Impulses, LightAndHeavySidesMeet) {
  RandomNumbers random(7);
  for (double ratio = 1e-9; ratio < 2e9; ratio *= 1e3) {
    RowScene scene;
    for (int k = 0; k < 4; ++k) scene.blocks.push_back(moving(ratio, random.vector()));
    scene.blocks.push_back(moving(1, random.vector()));
    const RandomFace face(random, 0);
    scene.rows.add_row(face.foot.normal, 0, 0.4);
    scene.rows.add_point(4, Side::first);
    scene.rows.add_face(face.foot, 0.1, Side::second);
    scene.blocks[4].velocity = scene.blocks[4].velocity - 5.0 * face.foot.normal;
    const SolveReport report = solve(scene, to_the_end());
    EXPECT_TRUE(report.converged);
    EXPECT_LT(report.iterations, 2000);
    EXPECT_NEAR(dot(scene.relative_velocity(0), face.foot.normal), 0, 1e-12);
  }
}

TEST(CoulombRows, BlockOnASlopeSlidesAsCoulombSays) {
  const double slope = 0.4;
  const Vector3d normal{-std::sin(slope), 0, std::cos(slope)};
  const Vector3d down{-std::cos(slope), 0, -std::sin(slope)};
  for (double friction : {0.1, 0.3, 0.42, 0.43, 0.8}) {
    RowScene scene;
    scene.blocks = {moving(2.5, {0, 0, 0})};
    add_wall_row(scene, 0, normal, friction);
    ThreadTeam team;
    ImpulseSolver solver;
    const double dt = 1e-3;
    for (int step = 0; step < 1000; ++step) {
      scene.blocks[0].velocity.z -= 9.81 * dt;
      solver.solve(to_the_end(), scene.rows, scene.blocks, team);
    }
    const double pull = std::max(0.0, std::sin(slope) - friction * std::cos(slope));
    EXPECT_LT(norm(scene.blocks[0].velocity - 9.81 * pull * down), 1e-12);
  }
}

TEST(CoulombRows, SlidingDoesNotLift) {
  for (double friction : {0.1, 0.5, 1.0, 3.0}) {
    RowScene scene;
    scene.blocks = {moving(1, {40, 30, -1})};
    add_wall_row(scene, 0, {0, 0, 1}, friction);
    solve(scene, to_the_end());
    EXPECT_NEAR(scene.blocks[0].velocity.z, 0, 1e-14);
    EXPECT_LT(norm(scene.blocks[0].velocity - (1 - friction / 50) * Vector3d{40, 30, 0}), 1e-12);
  }
}

TEST(CoulombRows, LimitIsThatOfTheImpulse) {
  RandomNumbers random(8);
  RowScene scene;
  for (int b = 0; b < 40; ++b) scene.blocks.push_back(moving(random.between(0.5, 2), random.vector()));
  for (int i = 0; i < 60; ++i) {
    scene.rows.add_row(random.direction(), 0, 0.3);
    scene.rows.add_point(random.below(20), Side::first);
    scene.rows.add_point(20 + random.below(20), Side::second);
  }
  const double before = scene.kinetic_energy();
  EXPECT_TRUE(solve(scene, to_the_end()).converged);
  EXPECT_LT(scene.kinetic_energy(), before);
  for (std::size_t i = 0; i < scene.rows.size(); ++i) {
    const ConstraintRow& row = scene.rows.row[i];
    const Vector3d u = scene.relative_velocity(i);
    const double along = dot(row.normal, u);
    const Vector3d slip = u - along * row.normal;
    EXPECT_GE(row.impulse, 0);
    EXPECT_GT(along, -1e-11);
    EXPECT_NEAR(row.impulse * along, 0, 1e-11);
    EXPECT_LE(norm(row.friction), 0.3 * row.impulse * (1 + 1e-14));
    EXPECT_NEAR(dot(row.friction, row.normal), 0, 1e-15);
    // Sticking below the limit; at it against the slip.
    EXPECT_NEAR(dot(row.friction, slip), -0.3 * row.impulse * norm(slip), 1e-10);
  }
}

}  // namespace
}  // namespace brio
