#include <gtest/gtest.h>

#include <random>

#include "contact/ties/tie.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {

class Tied : public testing::Test {
 protected:
  double number(double size = 1) { return size * std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vector3d vector(double size = 1) { return {number(size), number(size), number(size)}; }
  FaceVertices quad() {
    const Vector3d o = vector(3);
    const Vector3d a = Vector3d{1, 0, 0} + vector(0.2);
    const Vector3d b = Vector3d{0, 1, 0} + vector(0.2);
    return {o, o + a, o + a + b + vector(0.1), o + b};
  }
  FaceVertices triangle() {
    const Vector3d o = vector(3);
    const Vector3d c = o + Vector3d{0, 1, 0} + vector(0.2);
    return {o, o + Vector3d{1, 0, 0} + vector(0.2), c, c};
  }
  FaceVertices face(int i) { return i % 4 == 0 ? triangle() : quad(); }
  // A node above an inner point of a face.
  Vector3d node_over(const FaceVertices& face, double gap) {
    Tie tie;
    const double u = 0.1 + 0.3 * (1 + number());
    const double v = 0.1 + 0.3 * (1 + number());
    if (is_triangle(face)) {
      tie.weight = {1 - 0.5 * u - 0.5 * v, 0.5 * u, 0.5 * v, 0};
      tie.along = {-1, 1, 0, 0};
      tie.across = {-1, 0, 1, 0};
    } else {
      tie.weight = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
      tie.along = {v - 1, 1 - v, v, -v};
      tie.across = {u - 1, -u, u, 1 - u};
    }
    tie.gap = gap;
    return tied_position(tie, face);
  }

  std::mt19937 random_{7};
};

TEST_F(Tied, NodeIsHeldWhereItIs) {
  for (int i = 0; i < 2000; ++i) {
    const FaceVertices face = this->face(i);
    const double gap = i % 3 == 0 ? 0 : number(0.3);
    const Vector3d node = node_over(face, gap);
    const auto tie = project(node, face);
    ASSERT_TRUE(tie.has_value());
    EXPECT_LT(norm(tied_position(*tie, face) - node), 1e-12);
    EXPECT_NEAR(tie->gap, gap, 1e-12);
    double sum = 0;
    for (double weight : tie->weight) sum += weight;
    EXPECT_NEAR(sum, 1, 1e-14);
  }
}

TEST_F(Tied, NodeBeyondTheEdgesIsNotHeld) {
  for (int i = 0; i < 200; ++i) {
    const FaceVertices face = this->face(i);
    EXPECT_FALSE(project(face[0] + 1.2 * (face[1] - face[0]), face).has_value());
    EXPECT_FALSE(project(face[0] - 0.2 * (face[2] - face[0]), face).has_value());
    EXPECT_TRUE(project(face[0] + 0.5 * (face[1] - face[0]), face).has_value());
  }
}

TEST_F(Tied, ForcesHaveTheMomentOfTheForce) {
  for (int i = 0; i < 1000; ++i) {
    const FaceVertices face = this->face(i);
    const Vector3d node = node_over(face, number(0.5));
    const auto tie = project(node, face);
    ASSERT_TRUE(tie.has_value());
    const Vector3d force = vector(10);
    Vector3d sum{}, moment = Vector3d{};
    const auto share = spread(*tie, face, force);
    for (std::size_t k = 0; k < 4; ++k) {
      sum += share[k];
      moment += cross(face[k], share[k]);
    }
    EXPECT_LT(norm(sum - force), 1e-13 * 10);
    EXPECT_LT(norm(moment - cross(node, force)), 1e-11);
  }
}

TEST_F(Tied, ForcesHaveThePowerOfTheForce) {
  for (int i = 0; i < 1000; ++i) {
    const FaceVertices face = this->face(i);
    const auto tie = project(node_over(face, number(0.5)), face);
    ASSERT_TRUE(tie.has_value());
    FaceVertices velocity, before = face, after = face;
    constexpr double h = 1e-5;
    for (std::size_t k = 0; k < 4; ++k) {
      velocity[k] = k == 3 && is_triangle(face) ? velocity[2] : vector();
      before[k] -= h * velocity[k];
      after[k] += h * velocity[k];
    }
    const Vector3d force = vector(10);
    const auto share = spread(*tie, face, force);
    double power = 0;
    Vector3d rate = tie->gap * normal_rate(*tie, face, velocity);
    for (std::size_t k = 0; k < 4; ++k) {
      power += dot(share[k], velocity[k]);
      rate += tie->weight[k] * velocity[k];
    }
    EXPECT_NEAR(power, dot(force, rate), 1e-12 * 100);
    EXPECT_NEAR(power, dot(force, tied_position(*tie, after) - tied_position(*tie, before)) / (2 * h), 1e-6);
  }
}

TEST_F(Tied, NoCornerMovesTheNodeFurtherThanItsShare) {
  for (int i = 0; i < 1000; ++i) {
    const FaceVertices face = this->face(i);
    const auto tie = project(node_over(face, number(0.5)), face);
    ASSERT_TRUE(tie.has_value());
    const auto share = largest_share(*tie, face);
    for (std::size_t k = 0; k < 4; ++k) {
      if (k >= 2 && is_triangle(face)) continue;
      const Vector3d direction = normalized(vector());
      FaceVertices moved = face;
      moved[k] += 1e-6 * direction;
      EXPECT_LT(norm(tied_position(*tie, moved) - tied_position(*tie, face)), 1e-6 * (share[k] + 1e-4));
    }
  }
}

TEST_F(Tied, TurnIsARotation) {
  for (int i = 0; i < 1000; ++i) {
    const Vector3d rotation = vector(i % 2 == 0 ? 3 : 1e-9);
    const Vector3d arm = vector();
    const Tensor<double> exact =
        norm(rotation) > 1e-6 ? test::rotation_about(norm(rotation), rotation) : identity<double>();
    EXPECT_LT(norm(turned_by(rotation, arm) - exact * arm), norm(rotation) > 1e-6 ? 1e-14 : 1e-8);
    EXPECT_NEAR(norm(turned_by(rotation, arm)), norm(arm), 1e-15 * 10);
  }
}

}  // namespace
}  // namespace brio
