#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "contact/global_search.hpp"
#include "contact/reach.hpp"
#include "tests/contact/allocation_count.hpp"

namespace brio {
namespace {

using Position = Vector3<double>;

/// Bodies of one quadrilateral each that fly about in a box, their nodes shaking.
struct Swarm {
  explicit Swarm(int bodies, unsigned seed) : random(seed) {
    for (int body = 0; body < bodies; ++body) {
      const Position centre{5 * unit(random), 5 * unit(random), 5 * unit(random)};
      const Position speed{0.05 * unit(random), 0.05 * unit(random), 0.05 * unit(random)};
      const int first = static_cast<int>(position.size());
      for (const Position& corner :
           {Position{0, 0, 0}, Position{1, 0, 0}, Position{1, 1, 0}, Position{0, 1, 0}}) {
        position.push_back(centre + corner);
        drift.push_back(speed);
      }
      face.push_back({first, first + 1, first + 2, first + 3});
    }
    velocity.resize(position.size());
    shake();
  }
  void shake() {
    for (std::size_t i = 0; i < position.size(); ++i)
      velocity[i] =
          frame + drift[i] + Position{0.02 * unit(random), 0.02 * unit(random), 0.02 * unit(random)};
  }
  void move() {
    for (std::size_t i = 0; i < position.size(); ++i) position[i] = position[i] + velocity[i];
  }
  Position at(std::size_t node, double part_of_step) const {
    return position[node] + part_of_step * velocity[node];
  }

  std::mt19937_64 random;
  std::uniform_real_distribution<double> unit{-1, 1};
  Position frame{0, 0, 0};
  std::vector<Position> position, velocity, drift;
  std::vector<std::array<int, 4>> face;
};

/// Whether a node is within `distance` of the box around a face, a part of the step later.
bool is_near(const Swarm& swarm, const std::array<int, 4>& face, std::size_t node, double part,
             double distance) {
  const Position point = swarm.at(node, part);
  const double x[3] = {point.x, point.y, point.z};
  double lower[3], upper[3];
  std::fill_n(lower, 3, INFINITY);
  std::fill_n(upper, 3, -INFINITY);
  for (int corner : face) {
    const Position c = swarm.at(static_cast<std::size_t>(corner), part);
    const double y[3] = {c.x, c.y, c.z};
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], y[axis]);
      upper[axis] = std::max(upper[axis], y[axis]);
    }
  }
  for (int axis = 0; axis < 3; ++axis)
    if (x[axis] < lower[axis] - distance || x[axis] > upper[axis] + distance) return false;
  return true;
}

/// Searches as the step would: only when the ranges do not hold.
struct Seeker {
  explicit Seeker(double ahead_ = 0, double buffer_ = 0.5) : ahead(ahead_), buffer(buffer_) {}

  double ahead;
  double buffer;
  double distance = 0.1;
  MotionRanges ranges;
  GlobalSearch search;
  CandidatePairs pairs;
  SearchCounts counts;
  std::vector<CaptureBox> boxes;
  ThreadTeam team{2};

  void step(const Swarm& swarm) {
    if (ranges.hold(swarm.position, swarm.velocity, 1, team)) return;
    ranges.predict(swarm.position, swarm.velocity, std::max(ahead, 1.0), buffer, team);
    boxes.clear();
    for (const auto& face : swarm.face) boxes.push_back(ranges.of_face(face, distance));
    search.find(ranges.ranges(), boxes, team, pairs, counts);
  }
};

int lost_pairs(const Swarm& swarm, const Seeker& seeker, int& near) {
  int lost = 0;
  for (std::size_t f = 0; f < swarm.face.size(); ++f) {
    const auto found = seeker.pairs.of_box(f);
    for (std::size_t node = 0; node < swarm.position.size(); ++node)
      for (double part : {0.0, 0.5, 1.0})
        if (is_near(swarm, swarm.face[f], node, part, seeker.distance)) {
          ++near;
          if (!std::binary_search(found.begin(), found.end(), static_cast<int>(node))) ++lost;
        }
  }
  return lost;
}

/// Steps, searching only when due; returns how many searches were made and expects that no pair is lost.
std::uint64_t searches_of(Swarm swarm, Seeker& seeker, int steps) {
  int near = 0;
  for (int step = 0; step < steps; ++step) {
    swarm.shake();
    seeker.step(swarm);
    EXPECT_EQ(lost_pairs(swarm, seeker, near), 0) << "step " << step;
    swarm.move();
  }
  EXPECT_GT(near, steps * static_cast<int>(swarm.position.size()));  // more than each face's own corners
  return seeker.counts.searches;
}

TEST(MotionRanges, LoseNoPairWhileSearchesAreSkipped) {
  for (double buffer : {0.0, 0.3, 1.0})
    for (double ahead : {0.0, 20.0}) {
      Seeker seeker(ahead, buffer);
      const std::uint64_t searches = searches_of(Swarm(60, 1), seeker, 40);
      EXPECT_LE(searches, buffer < 0.3 ? 40u : 20u) << "buffer " << buffer << " ahead " << ahead;
    }
}

TEST(MotionRanges, FollowNodesThatKeepTheirVelocity) {
  Seeker without(0);
  Seeker with(20);
  EXPECT_LT(2 * searches_of(Swarm(60, 2), with, 60), searches_of(Swarm(60, 2), without, 60));
}

TEST(MotionRanges, IgnoreATranslationCommonToAll) {
  Swarm resting(60, 3);
  Swarm travelling = resting;
  travelling.frame = {100, -70, 35};
  Seeker at_rest, on_the_way;
  EXPECT_EQ(searches_of(resting, at_rest, 40), searches_of(travelling, on_the_way, 40));
}

TEST(MotionRanges, OneFastFragmentDoesNotEnlargeTheOthers) {
  Swarm calm(200, 4);
  Swarm with_fragment = calm;
  with_fragment.drift[0] = {2, 0, 0};
  with_fragment.shake();
  Seeker calm_seeker(10);
  Seeker seeker(10);
  calm_seeker.step(calm);
  seeker.step(with_fragment);
  EXPECT_LT(static_cast<double>(seeker.pairs.size()), 1.2 * static_cast<double>(calm_seeker.pairs.size()));
}

TEST(MotionRanges, HoldUpToTheBufferAndNoFurther) {
  ThreadTeam team;
  const std::vector<Position> start{{0, 0, 0}, {1, 0, 0}};
  const std::vector<Position> at_rest{{0, 0, 0}, {0, 0, 0}};
  MotionRanges ranges;
  EXPECT_FALSE(ranges.hold(start, at_rest, 1, team));
  ranges.predict(start, at_rest, 0, 0.5, team);
  EXPECT_TRUE(ranges.hold(start, at_rest, 1, team));
  EXPECT_TRUE(ranges.hold(std::vector<Position>{{0, 0, 0}, {1.5, 0, 0}}, at_rest, 1, team));
  EXPECT_FALSE(ranges.hold(std::vector<Position>{{0, 0, 0}, {1.51, 0, 0}}, at_rest, 1, team));
  EXPECT_TRUE(ranges.hold(start, std::vector<Position>{{0, 0, -0.25}, {0, 0, 0.25}}, 1, team));
  EXPECT_FALSE(ranges.hold(start, std::vector<Position>{{0, 0, -0.26}, {0, 0, 0.25}}, 1, team));
  EXPECT_FALSE(ranges.hold(std::vector<Position>{{0, 0, 0}}, std::vector<Position>{{0, 0, 0}}, 1, team));
  ranges.forget();
  EXPECT_FALSE(ranges.hold(start, at_rest, 1, team));
}

TEST(MotionRanges, AreTheSameForAnyNumberOfThreadsAndAllocateNothing) {
  Swarm swarm(4000, 5);
  MotionRanges one, many;
  ThreadTeam single(1), team(3);
  one.predict(swarm.position, swarm.velocity, 3, 0.2, single);
  many.predict(swarm.position, swarm.velocity, 3, 0.2, team);
  for (std::size_t i = 0; i < swarm.position.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(one.ranges()[i].lower[axis], many.ranges()[i].lower[axis]);
      ASSERT_EQ(one.ranges()[i].upper[axis], many.ranges()[i].upper[axis]);
    }
  EXPECT_TRUE(many.hold(swarm.position, swarm.velocity, 1, team));
  const AllocationCount allocations;
  many.predict(swarm.position, swarm.velocity, 3, 0.2, team);
  EXPECT_TRUE(many.hold(swarm.position, swarm.velocity, 1, team));
  EXPECT_EQ(allocations.count(), 0u);
}

}  // namespace
}  // namespace brio
