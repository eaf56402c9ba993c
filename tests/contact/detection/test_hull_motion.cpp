/// Motion of a node against the hull of a face, judged by exact arithmetic on each of its triangles: no false
/// negatives, no late times, false positives only within the touch tolerance.

#include "contact/detection/hull_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/detection/closest_on_hull.hpp"
#include "tests/contact/adversarial_edges.hpp"
#include "tests/contact/detection/exact_distance.hpp"
#include "tests/contact/exact_geometry.hpp"
#include "tests/contact/exact_judge.hpp"

namespace brio {
namespace {

using Eigen::Vector3d;

constexpr std::size_t triangles[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};

MovingFace triangle_of(const MovingFace& face, std::size_t which) {
  MovingFace triangle;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t vertex = triangles[which][std::min<std::size_t>(k, 2)];
    triangle.start[k] = face.start[vertex];
    triangle.displacement[k] = face.displacement[vertex];
  }
  return triangle;
}

struct Count {
  int touching = 0, inside = 0, apart = 0;
};

void judge(const Query& query, Count& count) {
  const auto& [node, face] = query;
  const auto contact = hull_motion(node, face);
  if (exact::is_inside_hull(node.start, face.start)) {
    ++count.inside;
    if (exact::is_inside_hull(node.start, face.start, 128 * unit_roundoff)) {
      ASSERT_TRUE(contact && contact->time == 0);
    }
    return;
  }
  std::optional<exact::Number> first;
  for (std::size_t which = 0; which < 4; ++which)
    if (const auto time = exact::first_contact(node, triangle_of(face, which))) exact::offer(first, *time);
  if (first) {
    ASSERT_TRUE(contact.has_value());
    EXPECT_GE(exact::compare(*first, exact::dyadic(contact->time)), 0);
  }
  if (!contact) {
    ++count.apart;
    return;
  }
  ++count.touching;
  double sum = 0;
  for (double weight : contact->weights) {
    EXPECT_GE(weight, 0);
    sum += weight;
  }
  EXPECT_NEAR(sum, 1, 4 * unit_roundoff);
  // That of a triangle is seen from its first vertex: at most twice the face's.
  const double tolerance = 2 * touch_tolerance(node, face);
  EXPECT_TRUE(exact::point_within(node, face, contact->weights, contact->time, tolerance));
  const double length = contact->normal.norm();
  EXPECT_TRUE(std::abs(length - 1) < 1e-14 || (length == 0 && contact->time == 0));
}

void judge(std::uint64_t seed, int queries) {
  Random random(seed);
  Count count;
  for (int i = 0; i < queries; ++i) {
    const auto family = static_cast<Family>(i % family_count);
    judge(adversarial_query(family, random), count);
    if (testing::Test::HasFailure()) FAIL() << i << ' ' << name_of(family);
  }
  EXPECT_GT(count.touching, queries / 4);
  EXPECT_GT(count.apart, queries / 20);
  EXPECT_GT(count.inside, queries / 100);
}

TEST(HullMotion, NoContactIsMissedOrLate) { judge(91, 2800); }
TEST(HullMotionSlow, NoContactIsMissedOrLate) { judge(92, 200000); }

// A node that starts outside and ends inside has come in.
TEST(HullMotion, WhatEndsInsideHasMet) {
  Random random(93);
  int entered = 0;
  for (int i = 0; i < 20000; ++i) {
    Query query;
    for (std::size_t k = 0; k < 4; ++k) {
      query.face.start[k] = random.vector(1);
      query.face.displacement[k] = random.vector(1);
    }
    query.node = {random.vector(1), random.vector(1)};
    FaceVertices end;
    for (std::size_t k = 0; k < 4; ++k) end[k] = query.face.start[k] + query.face.displacement[k];
    if (exact::is_inside_hull(query.node.start, query.face.start)) continue;
    if (!exact::is_inside_hull(query.node.start + query.node.displacement, end, 1e-12)) continue;
    ++entered;
    ASSERT_TRUE(hull_motion(query.node, query.face).has_value()) << i;
  }
  EXPECT_GT(entered, 100);
}

// A node falls on a warped face, from either side: the normal points to where it comes from, and with a reach
// contact is earlier by the time it takes to cross it.
TEST(HullMotion, TheNormalPointsToWhereTheNodeComesFrom) {
  for (double side : {1.0, -1.0}) {
    MovingFace face;
    face.start = {Vector3d(0, 0, 0), Vector3d(1, 0, 0.1), Vector3d(1, 1, 0), Vector3d(0, 1, 0.1)};
    face.displacement.fill(Vector3d::Zero());
    const MovingNode node{Vector3d(0.5, 0.5, 0.05 + side), Vector3d(0, 0, -2 * side)};
    const auto touch = hull_motion(node, face);
    ASSERT_TRUE(touch.has_value());
    EXPECT_NEAR(touch->time, 0.475, 1e-14);  // the ridges cross over and under the middle, 0.05 from it
    EXPECT_GT(side * touch->normal.z(), 0.9);
    const auto near = hull_motion(node, face, 0.1);
    ASSERT_TRUE(near.has_value());
    EXPECT_NEAR(near->time, 0.425, 1e-3);
    EXPECT_NEAR(near->distance, 0.1, 1e-12);
    EXPECT_GT(side * near->normal.z(), 0.9);
  }
}

TEST(HullMotion, EdgesAsTheEdgeCheckHasThem) {
  Random random(94);
  int touching = 0;
  for (int i = 0; i < 18000; ++i) {
    const auto [a, b] = adversarial_edges(static_cast<EdgeFamily>(i % edge_family_count), random);
    const auto contact = edge_motion(a, b);
    const auto expected = edge_check(a, b);
    ASSERT_EQ(contact.has_value(), expected.has_value());
    if (!contact) continue;
    ++touching;
    EXPECT_EQ(contact->time, expected->time);
    EXPECT_EQ(contact->weights[1], expected->parameters[0]);
    EXPECT_EQ(contact->weights[0] + contact->weights[1], 1);
    EXPECT_EQ(contact->weights[3], expected->parameters[1]);
    EXPECT_EQ(contact->normal, expected->normal);
  }
  EXPECT_GT(touching, 1000);
}

}  // namespace
}  // namespace brio
