#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "src/base/index.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/contact/enforcement/row_scenes.hpp"

namespace brio {
namespace {

using namespace test;

/// Bodies of every kind that meet: node on solid face across a gap, node on shell, rigid body on solid face,
/// edges, walls; with momenta known.
class MixedScene : public RowScene {
 public:
  explicit MixedScene(unsigned seed, double friction = 0.4, int copies = 1) : random_(seed) {
    for (int i = 0; i < copies; ++i) {
      add_node_on_face(friction, false);
      add_node_on_face(friction, true);
      add_body_on_face(friction);
      add_edges(friction);
    }
  }

  Vector3d angular_momentum() const {
    Vector3d sum{0, 0, 0};
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (turns_[b]) {
        sum = sum + inertia_[b] * blocks[b].velocity;
      } else {
        sum = sum + cross(position_[b], (1 / blocks[b].inverse_mass.xx) * blocks[b].velocity);
      }
    }
    return sum;
  }
  Vector3d linear_momentum() const {
    Vector3d sum{0, 0, 0};
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (!turns_[b]) sum = sum + (1 / blocks[b].inverse_mass.xx) * blocks[b].velocity;
    return sum;
  }
  double size_of_motion() const {
    double sum = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      sum += (turns_[b] ? 1 : norm(position_[b])) * norm(blocks[b].velocity) / blocks[b].inverse_mass.xx;
    return sum;
  }

 private:
  int add_block(const Vector3d& position, double mass, const Vector3d& velocity, bool turns = false) {
    blocks.push_back(moving(mass, velocity));
    position_.push_back(position);
    turns_.push_back(turns);
    inertia_.push_back(isotropic(mass));
    return static_cast<int>(blocks.size()) - 1;
  }
  RandomFace add_face(bool shell) {
    RandomFace face(random_, static_cast<int>(blocks.size()));
    for (const Vector3d& x : face.corner) add_block(x, random_.between(0.5, 2), random_.vector());
    if (shell)
      for (int k = 0; k < 4; ++k)
        face.foot.rotation[k] = add_block({0, 0, 0}, random_.between(0.05, 0.2), random_.vector(), true);
    return face;
  }
  void add_node_on_face(double friction, bool shell) {
    const RandomFace face = add_face(shell);
    const Vector3d normal = shell ? face.foot.normal : random_.direction();
    const Vector3d node = face.point + 0.15 * normal;
    const int block = add_block(node, random_.between(0.5, 2), random_.vector() - 4.0 * normal);
    rows.add_row(normal, 0, friction);
    rows.add_point(block, Side::first);
    rows.add_face(face.foot, 0.15, Side::second);
  }
  void add_body_on_face(double friction) {
    const RandomFace face = add_face(false);
    const Vector3d normal = face.foot.normal;
    const Vector3d point = face.point + 0.1 * normal;
    const Vector3d centre = point + normal + random_.vector(0.5);
    const int body = add_block(centre, 5, -4.0 * normal);
    const int turn = add_block({0, 0, 0}, 1, random_.vector(), true);
    // Inertia a, b, c about turned axes.
    const Vector3d axis = random_.direction();
    SymmetricTensor<double> inertia = isotropic(2.0);
    const double stretch = 0.7;
    inertia = inertia + stretch * SymmetricTensor<double>{axis.x * axis.x, axis.y * axis.y, axis.z * axis.z,
                                                          axis.x * axis.y, axis.y * axis.z, axis.x * axis.z};
    inertia_[index(turn)] = inertia;
    // Sherman and Morrison: the inverse of 2 + stretch axis axis.
    blocks[index(turn)].inverse_mass =
        isotropic(0.5) - (0.25 * stretch / (1 + 0.5 * stretch)) *
                             SymmetricTensor<double>{axis.x * axis.x, axis.y * axis.y, axis.z * axis.z,
                                                     axis.x * axis.y, axis.y * axis.z, axis.x * axis.z};
    rows.add_row(normal, 0, friction);
    rows.add_rigid_body(body, turn, point - centre, Side::first);
    rows.add_face(face.foot, 0.1, Side::second);
  }
  // Edges that touch: points of both coincide.
  void add_edges(double friction) {
    const Vector3d point = random_.vector(3);
    const Vector3d normal = random_.direction();
    rows.add_row(normal, 0, friction);
    for (Side side : {Side::first, Side::second}) {
      const double share = random_.between(0.1, 0.9);
      const Vector3d along = random_.direction();
      const Vector3d speed = (side == Side::first ? -2.0 : 2.0) * normal;
      const int a = add_block(point - share * along, 1, speed + random_.vector());
      const int b = add_block(point + (1 - share) * along, 2, speed + random_.vector());
      rows.add_point(a, side, 1 - share);
      rows.add_point(b, side, share);
    }
  }

  RandomNumbers random_;
  std::vector<Vector3d> position_;
  std::vector<char> turns_;
  std::vector<SymmetricTensor<double>> inertia_;
};

TEST(SolverInvariants, MomentaAreKeptWithFrictionAcrossGapsAndThickness) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    MixedScene scene(seed, 0.4, 3);
    const Vector3d linear = scene.linear_momentum();
    const Vector3d angular = scene.angular_momentum();
    const double size = scene.size_of_motion();
    solve(scene, {.max_iterations = 3 + static_cast<int>(seed), .tolerance = 1e-12});
    double sliding = 0;
    for (const ConstraintRow& row : scene.rows.row) sliding += norm(row.friction);
    EXPECT_GT(sliding, 0.1);
    EXPECT_LT(norm(scene.linear_momentum() - linear), 1e-14 * size);
    EXPECT_LT(norm(scene.angular_momentum() - angular), 1e-14 * size);
  }
}

/// Many nodes in many rows.
RowScene tangle(unsigned seed, int nodes, int count, double friction) {
  RandomNumbers random(seed);
  RowScene scene;
  for (int b = 0; b < nodes; ++b) scene.blocks.push_back(moving(random.between(0.5, 2), random.vector()));
  for (int i = 0; i < count; ++i) {
    scene.rows.add_row(random.direction(), 0, i % 3 == 0 ? 0 : friction).target_velocity = random.number(0.1);
    const int first = random.below(nodes);
    scene.rows.add_point(first, Side::first);
    if (i % 4 == 0) {
      scene.rows.add_turning_point((first + 5) % nodes, (first + 11) % nodes, 0.1, Side::second);
    } else {
      RandomFace face(random, 0);
      for (int k = 0; k < 4; ++k) face.foot.block[k] = (first + 1 + k) % nodes;
      scene.rows.add_face(face.foot, i % 2 == 0 ? 0.1 : 0, Side::second);
    }
  }
  return scene;
}

void expect_same_bits(const RowScene& a, const RowScene& b) {
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    EXPECT_EQ(a.blocks[i].velocity.x, b.blocks[i].velocity.x);
    EXPECT_EQ(a.blocks[i].velocity.y, b.blocks[i].velocity.y);
    EXPECT_EQ(a.blocks[i].velocity.z, b.blocks[i].velocity.z);
  }
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    EXPECT_EQ(a.rows.row[i].impulse, b.rows.row[i].impulse);
    EXPECT_EQ(norm(a.rows.row[i].friction - b.rows.row[i].friction), 0);
  }
}

TEST(SolverInvariants, ThreadsDoNotChangeBits) {
  RowScene one = tangle(1, 3000, 5000, 0.3);
  RowScene two = one;
  RowScene three = one;
  const SolveOptions options{40, 0};
  solve(one, options, 1);
  solve(two, options, 2);
  solve(three, options, 3);
  expect_same_bits(one, two);
  expect_same_bits(one, three);
}

TEST(SolverInvariants, OrderOfRowsDoesNotMatter) {
  RowScene scene = tangle(2, 300, 400, 0.3);
  RowScene shuffled = scene;
  RandomNumbers random(3);
  std::shuffle(shuffled.rows.row.begin(), shuffled.rows.row.end(), random.engine());
  solve(scene, {60, 0});
  solve(shuffled, {60, 0});
  for (std::size_t b = 0; b < scene.blocks.size(); ++b)
    EXPECT_LT(norm(scene.blocks[b].velocity - shuffled.blocks[b].velocity), 1e-13);
}

Vector3d mirrored(const Vector3d& a) { return {-a.x, a.y, a.z}; }

// Both halves of a symmetric scene that touch each other at the mirror.
TEST(SolverInvariants, MirrorSymmetryIsKept) {
  RandomNumbers random(4);
  RowScene scene;
  const int half = 100;
  for (int side = 0; side < 2; ++side)
    for (int b = 0; b < half; ++b)
      scene.blocks.push_back(side == 0 ? moving(random.between(0.5, 2), random.vector() + Vector3d{1, 0, 0})
                                       : VelocityBlock{mirrored(scene.blocks[index(b)].velocity),
                                                       scene.blocks[index(b)].inverse_mass});
  for (int i = 0; i < 150; ++i) {
    const Vector3d normal = random.direction();
    const int a = random.below(half);
    const int b = (a + 1 + random.below(half - 1)) % half;
    for (int side = 0; side < 2; ++side) {
      scene.rows.add_row(side == 0 ? normal : mirrored(normal), 0, 0.3);
      scene.rows.add_point(side * half + a, Side::first);
      scene.rows.add_point(side * half + b, Side::second);
    }
  }
  for (int b = 0; b < 20; ++b) {
    scene.rows.add_row({-1, 0, 0}, 0, 0.3);
    scene.rows.add_point(b, Side::first);
    scene.rows.add_point(half + b, Side::second);
  }
  solve(scene, {50, 0});
  for (std::size_t b = 0; b < half; ++b)
    EXPECT_LT(norm(scene.blocks[b].velocity - mirrored(scene.blocks[half + b].velocity)), 1e-14);
}

// Whatever the impulses from before, however few the iterations, and with blocks that are driven.
TEST(SolverInvariants, UnfinishedImpulsesDoNoWorkBeyondWhatIsAskedFor) {
  int scaled = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    RowScene scene = tangle(seed, 40, 80, seed % 2 == 0 ? 0 : 0.3);
    RandomNumbers random(seed);
    for (VelocityBlock& block : scene.blocks)
      if (random.below(8) == 0) block.inverse_mass = isotropic(0.0);
    for (ConstraintRow& row : scene.rows.row) row.impulse = random.between(0, 5);
    solve(scene, {.max_iterations = 1 + static_cast<int>(seed % 20), .tolerance = 1e-12});
    double work = 0, size = 0;
    for (std::size_t i = 0; i < scene.rows.size(); ++i) {
      const ConstraintRow& row = scene.rows.row[i];
      const Vector3d u = scene.relative_velocity(i);
      const double of_row = row.impulse * (dot(row.normal, u) - row.target_velocity) + dot(row.friction, u);
      work += of_row;
      size += std::abs(of_row);
      EXPECT_GE(row.impulse, 0);
      EXPECT_LE(norm(row.friction), row.friction_coefficient * row.impulse * (1 + 1e-12));
    }
    EXPECT_LE(work, 1e-13 * size) << seed;
    scaled += std::abs(work) <= 1e-13 * size;
  }
  EXPECT_GT(scaled, 100) << "the impulses would often have done work";
}

TEST(SolverInvariants, PrescribedComponentsStay) {
  RowScene scene = tangle(5, 300, 500, 0.3);
  RandomNumbers random(6);
  std::vector<Vector3d> before;
  for (VelocityBlock& block : scene.blocks) {
    const int mask = random.below(8);
    if (mask & 1) block.inverse_mass.xx = 0;
    if (mask & 2) block.inverse_mass.yy = 0;
    if (mask & 4) block.inverse_mass.zz = 0;
    before.push_back(block.velocity);
  }
  // One row between fixed blocks: its impulse must not grow.
  scene.blocks[0].inverse_mass = scene.blocks[1].inverse_mass = isotropic(0.0);
  scene.rows.add_row(unit(scene.blocks[1].velocity - scene.blocks[0].velocity), 0, 0.3).impulse = 1;
  scene.rows.add_point(0, Side::first);
  scene.rows.add_point(1, Side::second);
  solve(scene, {200, 1e-6});
  EXPECT_EQ(scene.rows.row.back().impulse, 0);
  EXPECT_EQ(norm(scene.rows.row.back().friction), 0);
  for (std::size_t b = 0; b < scene.blocks.size(); ++b) {
    const SymmetricTensor<double>& free = scene.blocks[b].inverse_mass;
    EXPECT_TRUE(free.xx != 0 || scene.blocks[b].velocity.x == before[b].x);
    EXPECT_TRUE(free.yy != 0 || scene.blocks[b].velocity.y == before[b].y);
    EXPECT_TRUE(free.zz != 0 || scene.blocks[b].velocity.z == before[b].z);
  }
}

/// Masses on top of each other on a floor, with the impulses that gravity asks for in a step.
RowScene resting_stack(int count, double pull, double friction) {
  RowScene scene;
  for (int b = 0; b < count; ++b) {
    scene.blocks.push_back(moving(1 + 0.1 * b, {0, 0, -pull}));
    scene.rows.add_row({0, 0, 1}, 0, friction);
    scene.rows.add_point(b, Side::first);
    if (b > 0) scene.rows.add_point(b - 1, Side::second);
  }
  double above = 0;
  for (int b = count; b-- > 0;) scene.rows.row[index(b)].impulse = above += pull * (1 + 0.1 * b);
  return scene;
}

TEST(SolverInvariants, RestCostsOneCheck) {
  RowScene scene = resting_stack(10, 0.01, 0.3);
  const SolveReport report = solve(scene, {100, 1e-6});
  EXPECT_EQ(report.iterations, 1);
  EXPECT_TRUE(report.converged);
  for (const VelocityBlock& block : scene.blocks) EXPECT_LT(norm(block.velocity), 1e-15);
}

/// Scenes side by side.
RowScene together(const std::vector<RowScene>& scenes) {
  RowScene all;
  for (const RowScene& scene : scenes) {
    const auto first = static_cast<int>(all.blocks.size());
    all.blocks.insert(all.blocks.end(), scene.blocks.begin(), scene.blocks.end());
    ConstraintRows shifted = scene.rows;
    for (TranslationEntry& entry : shifted.translation) entry.block += first;
    for (RotationEntry& entry : shifted.rotation) entry.block += first;
    for (MatrixEntry& entry : shifted.matrix) entry.block += first;
    all.rows.append(shifted);
  }
  return all;
}

TEST(SolverInvariants, AnIslandDoesNotSeeOthers) {
  std::vector<RowScene> scenes;
  for (unsigned seed = 0; seed < 60; ++seed)
    scenes.push_back(seed % 3 == 0 ? resting_stack(3 + static_cast<int>(seed), 0.01, 0.3)
                                   : tangle(seed, 20 + static_cast<int>(seed), 60, seed % 2 == 0 ? 0 : 0.3));
  // One that the whole team works on.
  scenes.push_back(tangle(100, 3000, 5000, 0.3));
  RowScene all = together(scenes);
  const SolveOptions options{60, 1e-6};
  solve(all, options, 3);
  std::size_t first = 0;
  for (RowScene& alone : scenes) {
    solve(alone, options);
    for (std::size_t b = 0; b < alone.blocks.size(); ++b)
      EXPECT_EQ(norm(all.blocks[first + b].velocity - alone.blocks[b].velocity), 0);
    first += alone.blocks.size();
  }
}

TEST(SolverInvariants, RestCostsOneCheckBesideAnImpact) {
  RowScene impact = tangle(3, 100, 150, 0.3);
  RowScene all = together({resting_stack(10, 0.01, 0.3), impact, resting_stack(20, 0.01, 0)});
  const SolveReport report = solve(all, {100, 1e-6});
  const SolveReport alone = solve(impact, {100, 1e-6});
  EXPECT_EQ(report.islands, 3);
  EXPECT_GT(report.iterations, 10);
  EXPECT_EQ(report.iterations, alone.iterations);
  EXPECT_EQ(report.row_iterations, 30 + alone.row_iterations);
}

// A heavy block that many light ones hit beside a tangle that is slow to converge.
TEST(SolverInvariants, RowsThatStillChangeAreSolvedAlone) {
  RowScene slow = tangle(3, 100, 150, 0.3);
  RowScene scene = slow;
  const auto heavy = static_cast<int>(scene.blocks.size());
  scene.blocks.push_back(moving(1e5, {0, 0, 0}));
  scene.rows.add_row({0, 0, 1}, 0, 0);
  scene.rows.add_point(heavy, Side::first);
  scene.rows.add_point(0, Side::second);
  RandomNumbers random(7);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d normal = random.direction();
    const auto light = static_cast<int>(scene.blocks.size());
    scene.blocks.push_back(moving(1, -1 * normal + random.vector(0.3)));
    scene.rows.add_row(normal, 0, 0.3);
    scene.rows.add_point(light, Side::first);
    scene.rows.add_point(heavy, Side::second);
  }
  RowScene exact = scene;
  EXPECT_TRUE(solve(exact, to_the_end()).converged);
  const double tolerance = 1e-6;
  const SolveReport alone = solve(slow, {10000, tolerance});
  const SolveReport report = solve(scene, {10000, tolerance});
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.islands, 1);
  const double whole = static_cast<double>(scene.rows.size()) * alone.iterations;
  EXPECT_LT(static_cast<double>(report.row_iterations), 0.5 * whole);
  // Over all rows, not over those that were iterated last.
  for (std::size_t i = 0; i < scene.rows.size(); ++i) {
    const ConstraintRow& row = scene.rows.row[i];
    const double velocity = dot(row.normal, scene.relative_velocity(i)) - row.target_velocity;
    EXPECT_GT(velocity, -30 * tolerance * report.largest_velocity);
    if (row.impulse > 0) {
      EXPECT_LT(velocity, 30 * tolerance * report.largest_velocity);
    }
  }
  for (std::size_t b = 0; b < scene.blocks.size(); ++b)
    EXPECT_LT(norm(scene.blocks[b].velocity - exact.blocks[b].velocity), 1e-3 * report.largest_velocity);
}

// A fixed floor joins no islands.
TEST(SolverInvariants, WhatIsHeldDoesNotJoinIslands) {
  RowScene scene;
  scene.blocks.push_back({{0, 0, 0}, isotropic(0.0)});
  for (int b = 1; b <= 5; ++b) {
    scene.blocks.push_back(moving(1, {0, 0, -0.1 * b}));
    scene.rows.add_row({0, 0, 1}, 0, 0.3);
    scene.rows.add_point(b, Side::first);
    scene.rows.add_point(0, Side::second);
  }
  EXPECT_EQ(solve(scene, to_the_end()).islands, 5);
  for (const VelocityBlock& block : scene.blocks) EXPECT_EQ(norm(block.velocity), 0);
}

// Impulses lag behind disturbances when iterations are few: the energy that is left is no more than with the
// impulses at the start.
TEST(SolverInvariants, UnconvergedIterationsOnlyTakeEnergyFromRest) {
  RandomNumbers random(9);
  for (int trial = 0; trial < 300; ++trial) {
    RowScene scene = resting_stack(10, 1, trial % 2 == 0 ? 0 : 0.3);
    for (VelocityBlock& block : scene.blocks) block.velocity = block.velocity + random.vector(0.02);
    double last = 1e300;
    for (int iterations = 0; iterations <= 5; ++iterations) {
      RowScene run = scene;
      solve(run, {iterations, 0});
      EXPECT_LT(run.kinetic_energy(), last);
      if (iterations == 0) last = run.kinetic_energy() * (1 + 1e-14);
    }
  }
}

// Rows that are found later join, from the impulses so far, with the free velocities of the first solve.
TEST(SolverInvariants, RowsMayBeAdded) {
  const RowScene all = tangle(7, 100, 120, 0.3);
  RowScene later = all;
  later.rows.row.resize(80);
  ThreadTeam team;
  ImpulseSolver solver;
  solver.solve(to_the_end(1e-13), later.rows, later.blocks, team);
  later.rows.row.insert(later.rows.row.end(), all.rows.row.begin() + 80, all.rows.row.end());
  solver.solve_further(to_the_end(1e-13), later.rows, later.blocks, team);
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const ConstraintRow& row = later.rows.row[i];
    const double along = dot(row.normal, later.relative_velocity(i));
    EXPECT_GT(along - row.target_velocity, -1e-9);
    EXPECT_NEAR(row.impulse * (along - row.target_velocity), 0, 1e-9);
  }
  // The velocities are the free ones and what the impulses do, no more.
  std::vector<Vector3d> given(all.blocks.size(), Vector3d{0, 0, 0});
  for (const ConstraintRow& row : later.rows.row)
    RowMap(later.rows, row).spread(impulse_of(row), [&](int b, const Vector3d& impulse) {
      given[index(b)] = given[index(b)] + impulse;
    });
  for (std::size_t b = 0; b < all.blocks.size(); ++b)
    EXPECT_LT(norm(later.blocks[b].velocity - all.blocks[b].velocity - all.blocks[b].inverse_mass * given[b]),
              1e-13);
}

TEST(SolverInvariants, NothingIsAllocatedASecondTime) {
  const RowScene scene = tangle(8, 2000, 3000, 0.3);
  RowScene run = scene;
  ThreadTeam team;
  ImpulseSolver solver;
  solver.solve({5, 0}, run.rows, run.blocks, team);
  run.rows.clear();
  run.rows.row = scene.rows.row;
  run.rows.translation = scene.rows.translation;
  run.rows.rotation = scene.rows.rotation;
  const AllocationCount allocations;
  solver.solve({5, 0}, run.rows, run.blocks, team);
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace brio
