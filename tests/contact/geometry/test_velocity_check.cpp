/// The velocity check on cases whose answer is known in closed form.

#include "contact/geometry/velocity_check.hpp"

#include <gtest/gtest.h>

namespace brio {
namespace {

const Vector3d rest{};

MovingFace still(const FaceVertices& vertices) { return {vertices, {rest, rest, rest, rest}}; }

const FaceVertices unit_face = {Vector3d{0, 0, 0}, Vector3d{1, 0, 0}, Vector3d{1, 1, 0}, Vector3d{0, 1, 0}};

TEST(VelocityCheck, AFallingNodeMeetsAFlatFaceWhenItsHeightIsUsedUp) {
  const auto contact = velocity_check({{0.25, 0.125, 0.5}, {0, 0, -2}}, still(unit_face));
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.25, 1e-14);
  EXPECT_NEAR(contact->normal.z, 1, 1e-15);
  EXPECT_EQ(contact->side, 1);
  Vector3d point = rest;
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    point += contact->weights[k] * unit_face[k];
    sum += contact->weights[k];
  }
  EXPECT_NEAR(sum, 1, 1e-15);
  EXPECT_NEAR(norm(point - Vector3d{0.25, 0.125, 0}), 0, 1e-14);
}

TEST(VelocityCheck, FromBehindTheSideIsNegative) {
  const auto contact = velocity_check({{0.25, 0.125, -0.5}, {0, 0, 2}}, still(unit_face));
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->side, -1);
}

TEST(VelocityCheck, TooShortAStepOrAnAimBesideTheFaceIsNoContact) {
  EXPECT_FALSE(velocity_check({{0.25, 0.125, 0.5}, {0, 0, -0.499}}, still(unit_face)));
  EXPECT_FALSE(velocity_check({{1.001, 0.125, 0.5}, {0, 0, -1}}, still(unit_face)));
}

TEST(VelocityCheck, WithReachContactBeginsAtThatDistance) {
  const auto contact = velocity_check({{0.25, 0.125, 0.5}, {0, 0, -2}}, still(unit_face), 0.1);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.2, 1e-14);
  EXPECT_NEAR(contact->distance, 0.1, 2e-14);
  // Beside the edge the grown face is a cylinder: at 0.06 beyond it, 0.08 above.
  const auto beside = velocity_check({{1.06, 0.5, 0.5}, {0, 0, -2}}, still(unit_face), 0.1);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(beside->time, 0.21, 1e-14);
}

TEST(VelocityCheck, ATriangleIsAQuadThatRepeatsItsThirdVertex) {
  const MovingFace triangle =
      still({Vector3d{0, 0, 0}, Vector3d{1, 0, 0}, Vector3d{0, 1, 0}, Vector3d{0, 1, 0}});
  const auto contact = velocity_check({{0.25, 0.25, 1}, {0, 0, -1}}, triangle);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->weights[0], 0.5, 1e-14);
  EXPECT_EQ(contact->weights[3], 0);
  EXPECT_FALSE(velocity_check({{0.6, 0.6, 1}, {0, 0, -2}}, triangle));
}

TEST(VelocityCheck, ARotatingFaceIsMetWhereTheChordMotionPutsIt) {
  // The far edge comes up from z = -1 to 1 while the node waits at a height of 0.25 over the middle: the
  // surface at x = 0.5 rises as -0.5 + t.
  MovingFace face = still(unit_face);
  for (const std::size_t k : {1, 2}) {
    face.start[k].z = -1;
    face.displacement[k].z = 2;
  }
  const auto contact = velocity_check({{0.5, 0.25, 0.25}, rest}, face);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.75, 1e-13);
}

TEST(VelocityCheck, ANodeSlidingInThePlaneMeetsTheEdgeWithoutASide) {
  const auto contact = velocity_check({{-0.5, 0.5, 0}, {1, 0, 0}}, still(unit_face));
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.5, 1e-13);
  EXPECT_EQ(contact->side, 0);
}

TEST(VelocityCheck, TouchingAtTheStartIsContactAtTimeZero) {
  const auto contact = velocity_check({{0.5, 0.5, 0}, {0, 0, 1}}, still(unit_face));
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->time, 0);
}

TEST(VelocityCheck, NothingMovesNothingTouches) {
  EXPECT_FALSE(velocity_check({{0.5, 0.5, 1e-12}, rest}, still(unit_face)));
}

}  // namespace
}  // namespace brio
