#include <gtest/gtest.h>

#include "contact/enforcement/impulse_work.hpp"
#include "src/base/index.hpp"
#include "tests/contact/enforcement/row_scenes.hpp"

namespace brio {
namespace {

using namespace test;

class Rows : public testing::Test {
 protected:
  RandomNumbers random{11};
  ConstraintRows rows;

  const ConstraintRow& last() const { return rows.row.back(); }
  void new_row(const Vector3d& normal) { rows.add_row(normal, 0, 0.3); }

  /// Sum of the impulses on blocks and of their moments about the origin, for an impulse on the first side.
  struct Total {
    Vector3d impulse{0, 0, 0};
    Vector3d moment{0, 0, 0};
  };
  Total spread(const Vector3d& impulse, const std::vector<Vector3d>& position, int first_rotation) const {
    Total total;
    RowMap(rows, last()).spread(impulse, [&](int block, const Vector3d& given) {
      if (block >= first_rotation) {
        total.moment = total.moment + given;
        return;
      }
      total.impulse = total.impulse + given;
      total.moment = total.moment + cross(position[index(block)], given);
    });
    return total;
  }
};

TEST_F(Rows, FrameIsOrthonormal) {
  for (int i = 0; i < 1000; ++i) {
    new_row(random.direction());
    const Vector3d frame[3] = {last().normal, last().tangent[0], last().tangent[1]};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) EXPECT_NEAR(dot(frame[a], frame[b]), a == b ? 1 : 0, 1e-15);
  }
}

TEST_F(Rows, SpreadIsTheTransposeOfVelocity) {
  for (int i = 0; i < 1000; ++i) {
    rows.clear();
    new_row(random.direction());
    RandomFace face(random, 0);
    rows.add_face(face.foot, 0.3, Side::second);
    rows.add_turning_point(4, 6, 0.2, Side::first, 0.4);
    rows.add_rigid_body(5, 7, random.vector(), Side::first);
    std::vector<VelocityBlock> blocks;
    for (int b = 0; b < 8; ++b) blocks.push_back(moving(1, random.vector()));
    const Vector3d impulse = random.vector();
    double power = 0;
    RowMap(rows, last()).spread(impulse, [&](int block, const Vector3d& given) {
      power += dot(given, blocks[index(block)].velocity);
    });
    EXPECT_NEAR(power, dot(impulse, RowMap(rows, last()).relative_velocity(blocks)), 1e-13);
  }
}

// The impulses on the corners have the moment of the impulse at the point that stands off.
TEST_F(Rows, SolidFaceTakesTheMomentOfAPointThatStandsOff) {
  for (int i = 0; i < 2000; ++i) {
    rows.clear();
    const RandomFace face(random, 0, i % 3 == 0 ? 3 : 4);
    // Along the face's normal, against it, and any direction as at an edge.
    const Vector3d normal = i % 4 == 0   ? face.foot.normal
                            : i % 4 == 1 ? -1.0 * face.foot.normal
                                         : random.direction();
    const double height = i % 5 == 0 ? 0 : random.number(0.5);
    new_row(normal);
    rows.add_face(face.foot, height, Side::first);
    EXPECT_EQ(last().matrix.size() > 0, i % 4 > 1 && height != 0);
    const Vector3d impulse = random.vector();
    const Total total = spread(impulse, face.corner, 100);
    const Vector3d point = face.point + height * normal;
    EXPECT_LT(norm(total.impulse - impulse), 1e-14);
    EXPECT_LT(norm(total.moment - cross(point, impulse)), 3e-14);
  }
}

TEST_F(Rows, SolidFaceMovesAsABodyInRigidMotion) {
  for (int i = 0; i < 1000; ++i) {
    rows.clear();
    const RandomFace face(random, 0);
    const Vector3d normal = i % 2 == 0 ? face.foot.normal : random.direction();
    new_row(normal);
    rows.add_face(face.foot, 0.4, Side::first);
    const Vector3d spin = random.vector();
    const Vector3d v =
        RowMap(rows, last()).velocity([&](int b) { return cross(spin, face.corner[index(b)]); });
    EXPECT_LT(norm(v - cross(spin, face.point + 0.4 * normal)), 2e-14);
  }
}

TEST_F(Rows, ShellsAndRigidBodiesTakeTheMoment) {
  for (int i = 0; i < 1000; ++i) {
    rows.clear();
    RandomFace face(random, 0);
    for (int k = 0; k < 4; ++k) face.foot.rotation[k] = 5 + k;
    new_row(random.direction());
    const double height = random.number(0.5);
    rows.add_face(face.foot, height, Side::second);
    const Vector3d point = face.point + height * last().normal;
    const Vector3d centre = random.vector(3);
    rows.add_rigid_body(4, 9, point - centre, Side::first);
    std::vector<Vector3d> position = face.corner;
    position.push_back(centre);
    const Total total = spread(random.vector(), position, 5);
    EXPECT_LT(norm(total.impulse), 1e-14);
    EXPECT_LT(norm(total.moment), 3e-14);
  }
}

TEST_F(Rows, ABlockIsNamedOnce) {
  const Vector3d normal = random.direction();
  std::vector<VelocityBlock> blocks{moving(1, random.vector()), moving(1, random.vector()),
                                    moving(1, random.vector()), moving(1, random.vector())};
  new_row(normal);
  rows.add_point(0, Side::first);
  rows.add_point(1, Side::second, 0.25);
  const int tied[3] = {0, 1, 2};
  const double weight[3] = {0.5, 0.25, 0.25};
  rows.add_nodes(tied, weight, Side::second);
  rows.add_rotation(3, {1, 2, 3});
  rows.add_rotation(3, {1, 0, 0});
  EXPECT_EQ(last().translation.size(), 3U);
  EXPECT_EQ(last().rotation.size(), 1U);
  const Vector3d v = RowMap(rows, last()).velocity([&](int b) { return blocks[index(b)].velocity; });
  const Vector3d expected = 0.5 * blocks[0].velocity - 0.5 * blocks[1].velocity - 0.25 * blocks[2].velocity +
                            cross(blocks[3].velocity, Vector3d{2, 2, 3});
  EXPECT_LT(norm(v - expected), 1e-15);
  // A matrix swallows the translation of its block, whatever comes first.
  const Tensor<double> matrix{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  rows.add_matrix(1, matrix);
  rows.add_point(1, Side::first, 0.125);
  EXPECT_EQ(last().translation.size(), 2U);
  EXPECT_EQ(last().matrix.size(), 1U);
  const Vector3d w = RowMap(rows, last()).velocity([&](int b) { return blocks[index(b)].velocity; });
  EXPECT_LT(norm(w - (expected + matrix * blocks[1].velocity + 0.125 * blocks[1].velocity)), 1e-14);
}

TEST_F(Rows, PiecesJoinInTheirOrder) {
  std::vector<ConstraintRows> pieces(3);
  ConstraintRows all;
  for (ConstraintRows& piece : pieces) {
    for (int i = 0; i < 5; ++i) {
      piece.add_row(random.direction(), random.number(), 0.1);
      piece.add_face(RandomFace(random, i).foot, i % 2 == 0 ? 0.1 : 0, Side::first);
      piece.add_turning_point(10 + i, 20 + i, 0.1, Side::second);
    }
    all.append(piece);
  }
  ASSERT_EQ(all.size(), 15U);
  const auto velocity_of = [](int b) { return Vector3d{1.0 + b, 2.0 * b, 3.0 - b}; };
  for (std::size_t i = 0; i < 15; ++i) {
    const Vector3d expected = RowMap(pieces[i / 5], pieces[i / 5].row[i % 5]).velocity(velocity_of);
    EXPECT_EQ(norm(RowMap(all, all.row[i]).velocity(velocity_of) - expected), 0);
    EXPECT_EQ(all.row[i].gap, pieces[i / 5].row[i % 5].gap);
  }
}

// What motion gains is the work of rows and of supports together; walls' reactions are what blocks lack.
TEST_F(Rows, EnergyAndMomentumBalance) {
  RowScene scene;
  scene.blocks = {moving(2, {0.3, 0.1, -1}), moving(0.5, {0, 0.4, 1}), moving(1, {0, 0, 0})};
  scene.blocks[1].inverse_mass.xx = 0;
  scene.blocks[1].velocity.x = 0.7;
  const std::vector<Vector3d> before{scene.blocks[0].velocity, scene.blocks[1].velocity, {0.1, 0, 0}};
  const std::vector<BlockPlace> places{{.position = {1, 2, 3}}, {.position = {-1, 0, 1}}, {.turns = true}};
  scene.rows.add_row({0, 0, 1}, 0, 0.4);
  scene.rows.add_point(0, Side::first);
  scene.rows.add_point(1, Side::second);
  scene.rows.add_rotation(2, {0.1, 0.2, 0.3});
  ConstraintRow& wall = add_wall_row(scene, 0, unit({0.2, 0, 1}), 0.2);
  wall.wall = 0;
  wall.wall_velocity = {0, 0, 0.2};
  wall.point = {1, 2, 3};
  scene.blocks[2].velocity = {0.1, 0, 0};
  solve(scene, to_the_end());
  ImpulseOnWall reaction[1];
  std::vector<RowWork> parts;
  ThreadTeam team;
  const RowWork work = account_work(scene.rows, before, scene.blocks, places, reaction, parts, team);
  const auto change = [&](std::size_t b, double mass) {
    return 0.5 * mass * (dot(scene.blocks[b].velocity, scene.blocks[b].velocity) - dot(before[b], before[b]));
  };
  const double gained = change(0, 2) + change(1, 0.5) + change(2, 1);
  const double done = 0.5 * (work.normal_before + work.normal_after + work.friction_before +
                             work.friction_after + work.support_before + work.support_after) +
                      work.walls;
  EXPECT_GT(std::abs(work.support_before), 1e-3);
  EXPECT_NEAR(gained, done, 1e-14);
  EXPECT_EQ(scene.blocks[1].velocity.x, 0.7);
  // All momentum that the blocks gained came from walls and supports.
  const Vector3d momentum =
      2.0 * (scene.blocks[0].velocity - before[0]) + 0.5 * (scene.blocks[1].velocity - before[1]);
  EXPECT_LT(norm(momentum - (work.support_impulse - reaction[0].impulse)), 1e-14);
  EXPECT_LT(norm(reaction[0].moment - cross(Vector3d{1, 2, 3}, reaction[0].impulse)), 1e-14);
  EXPECT_NEAR(work.walls, -0.2 * reaction[0].impulse.z, 1e-15);
  EXPECT_LT(work.normal_before + work.normal_after, 0);
  EXPECT_LT(norm(work.support_moment - cross(Vector3d{-1, 0, 1}, work.support_impulse)), 1e-14);
}

}  // namespace
}  // namespace brio
