// Members of an impact zone move on as one rigid body and keep linear and angular momentum against supports.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "contact/impact_zone.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {

class Zone : public testing::TestWithParam<int> {
 protected:
  Vector3d any() { return {value_(random_), value_(random_), value_(random_)}; }

  void fill(int nodes, int bodies) {
    for (int k = 0; k < nodes + bodies; ++k) {
      ZoneMember one{.mass = 1 + value_(random_) / 2, .position = any(), .velocity = any()};
      if (k >= nodes) {
        one.inertia = diagonal(Vector3d{2, 3, 4});
        one.angular_velocity = any();
      }
      members_.push_back(one);
    }
  }
  void prescribe(std::size_t member, int component) { members_[member].prescribed.set(component); }

  static Vector3d velocity_after(const ZoneMember& one) {
    Vector3d velocity = one.velocity + one.impulse / one.mass;
    for (int axis = 0; axis < 3; ++axis)
      if (one.prescribed[index(axis)]) velocity[axis] = one.velocity[axis];
    return velocity;
  }
  double kinetic_energy(bool after) const {
    double energy = 0;
    for (const ZoneMember& one : members_) {
      const Vector3d velocity = after ? velocity_after(one) : one.velocity;
      energy += one.mass * squared_norm(velocity) / 2;
      if (one.inertia == Tensor<double>{}) continue;
      const Vector3d turning =
          one.angular_velocity + (after ? inverse(one.inertia) * one.moment : Vector3d{});
      energy += dot(turning, one.inertia * turning) / 2;
    }
    return energy;
  }

  void expect_no_sums() const {
    Vector3d linear{}, angular = Vector3d{};
    for (const ZoneMember& one : members_) {
      linear += one.impulse;
      angular += cross(one.position, one.impulse) + one.moment;
    }
    EXPECT_LT(norm(linear), 1e-12);
    EXPECT_LT(norm(angular), 1e-12);
  }
  // In a rigid motion no two points approach each other.
  void expect_rigid() const {
    for (const ZoneMember& a : members_)
      for (const ZoneMember& b : members_)
        EXPECT_NEAR(dot(a.position - b.position, velocity_after(a) - velocity_after(b)), 0, 1e-11);
  }

  std::vector<ZoneMember> members_;

 private:
  std::mt19937 random_{static_cast<unsigned>(GetParam())};
  std::uniform_real_distribution<double> value_{-1, 1};
};

TEST_P(Zone, KeepsMomentumAndLosesEnergyWhereItIsFree) {
  fill(2 + GetParam(), GetParam() % 3);
  find_zone_impulses(members_);
  expect_no_sums();
  expect_rigid();
  EXPECT_LE(kinetic_energy(true), kinetic_energy(false));
}

TEST_P(Zone, TurnsAboutWhatIsHeldOfIt) {
  fill(5, GetParam() % 2);
  for (int axis = 0; axis < 3; ++axis) prescribe(0, axis);
  prescribe(1, GetParam() % 3);
  members_[0].velocity = members_[1].velocity = Vector3d{};
  find_zone_impulses(members_);
  expect_no_sums();
  expect_rigid();
  EXPECT_LE(kinetic_energy(true), kinetic_energy(false));
  EXPECT_GT(norm(velocity_after(members_[2])), 1e-3);
}

TEST_P(Zone, FollowsWhatDrivesIt) {
  fill(4, 1);
  for (int component = 0; component < 6; ++component) prescribe(4, component);
  find_zone_impulses(members_);
  expect_no_sums();
  const ZoneMember& leader = members_[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d arm = members_[i].position - leader.position;
    const Vector3d wanted = leader.velocity + cross(leader.angular_velocity, arm);
    EXPECT_LT(norm(velocity_after(members_[i]) - wanted), 1e-10);
  }
}

// The whole zone slides on, as nothing holds it along the other axes.
TEST_P(Zone, ThatLiesOnSupportsSlidesOnThem) {
  fill(6, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    members_[i].velocity[2] = 0;
    prescribe(i, 2);
  }
  Vector3d before{}, after = Vector3d{};
  for (const ZoneMember& one : members_) before += one.mass * one.velocity;
  find_zone_impulses(members_);
  expect_no_sums();
  expect_rigid();
  for (const ZoneMember& one : members_) after += one.mass * velocity_after(one);
  EXPECT_NEAR(after[0], before[0], 1e-12);
  EXPECT_NEAR(after[1], before[1], 1e-12);
}

// The same zone seen along other axes, in which its members are held.
TEST_P(Zone, HeldAlongAxesOfItsOwnIsTurned) {
  fill(5, GetParam() % 2);
  for (int axis = 0; axis < 3; ++axis) prescribe(0, axis);
  prescribe(1, GetParam() % 3);
  if (GetParam() % 2 == 1)
    prescribe(5, 3 + GetParam() % 3);
  else
    prescribe(2, (GetParam() + 1) % 3);
  const Tensor<double> turn = test::rotation_about(0.7, Vector3d{1, -2, 3});
  std::vector<ZoneMember> turned = members_;
  for (ZoneMember& one : turned) {
    one.axes = turn;
    for (Vector3d* vector : {&one.position, &one.velocity, &one.angular_velocity}) *vector = turn * *vector;
    one.inertia = turn * one.inertia * transposed(turn);
  }
  find_zone_impulses(members_);
  find_zone_impulses(turned);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    EXPECT_LT(norm(turn * members_[i].impulse - turned[i].impulse), 1e-11);
    EXPECT_LT(norm(turn * members_[i].moment - turned[i].moment), 1e-11);
  }
}

// Supports that tear it apart: what they are given is in the sums all the same.
TEST_P(Zone, KeepsMomentumWhereSupportsContradict) {
  fill(5, 1);
  for (std::size_t i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) prescribe(i, axis);
  find_zone_impulses(members_);
  expect_no_sums();
}

// What the walls give is what the zone gains, and no point passes them; those that it does not reach do
// nothing.
TEST_P(Zone, StopsAtWalls) {
  fill(6, GetParam() % 2);
  std::vector<ZoneWall> walls;
  for (const ZoneMember& one : members_) {
    walls.push_back({.point = one.position, .normal = {0, 0, 1}, .least_velocity = 0.3});
    walls.push_back({.point = one.position, .normal = {0, 0.6, -0.8}, .least_velocity = -100});
  }
  find_zone_impulses(members_, walls);
  expect_rigid();
  Vector3d linear{}, angular{}, given{}, turning{};
  int pushing = 0;
  for (const ZoneMember& one : members_) {
    EXPECT_GT(velocity_after(one)[2], 0.3 - 1e-10);
    linear += one.impulse;
    angular += cross(one.position, one.impulse) + one.moment;
  }
  for (const ZoneWall& wall : walls) {
    if (wall.least_velocity < 0) {
      EXPECT_FALSE(wall.pushes);
    }
    pushing += wall.pushes ? 1 : 0;
    given += wall.impulse * wall.normal;
    turning += cross(wall.point, wall.impulse * wall.normal);
  }
  EXPECT_GT(pushing, 0);
  EXPECT_GT(given[2], 0);
  EXPECT_LT(norm(linear - given), 1e-11);
  EXPECT_LT(norm(angular - turning), 1e-11);
}

// The diagonals of two cells are driven through each other along z and slide freely.
TEST(ImpactZone, AccountsForWhatSupportsTake) {
  ThreadTeam team(1);
  test::SpringModel model;
  model.stiffness = 0;
  model.damping = 0;
  const std::array<Vector3d, 9> place{Vector3d{0, 0, -2}, {1, 0, 0}, {0.5, -0.5, 1.5},
                                      {0, 1, 0},          {1, 1, 0}, {0.2, 0.2, 0.5},
                                      {0, 2, 0},          {1, 2, 0}, {-0.5, 0.5, 1.5}};
  model.add_sheet({2, 2}, {2, 2}, 0.01, 1,
                  [&](const Vector3d& x) { return place[index(std::lround(x[0]) + 3 * std::lround(x[1]))]; });
  model.start({});
  for (const int held : {0, 2, 4, 5, 6, 7, 8}) model.hold(held, held + 1, 4);
  model.set_velocity(5, {0.02, 0.01, -1});
  model.set_velocity(6, {-0.02, 0.01, 0});
  const double dt = 0.01;
  const ContactStep& step = model.scene.step;
  for (int i = 0; i < 60 && model.scene.zones == 0; ++i) {
    const Vector3d linear = model.momentum(), angular = model.angular_momentum();
    const double energy = model.kinetic_energy();
    model.accelerate(dt);
    resolve(model.scene, model.nodes, dt, team);
    EXPECT_LT(norm(model.momentum() - linear - step.support_impulse), 1e-13);
    EXPECT_LT(norm(model.angular_momentum() - angular - step.support_moment), 1e-13);
    const double of_supports = 0.5 * (step.support_work_before + step.support_work_after);
    EXPECT_NEAR(model.kinetic_energy() - energy, step.normal_work() + step.friction_work() + of_supports,
                1e-13);
    model.move(dt);
  }
  EXPECT_GT(model.scene.zones, 0U);
  EXPECT_GT(norm(step.support_impulse) + norm(step.support_moment), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Zone, testing::Range(0, 12));

}  // namespace
}  // namespace brio
