/// Closed surfaces let nothing through, for reasons of topology, and a reach is kept.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "src/base/index.hpp"
#include "tests/contact/geometry/adversarial_queries.hpp"
#include "tests/contact/geometry/exact_judge.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {

// How everything is seen: turned, shifted by many sizes, and moving along.
struct Frame {
  Tensor<double> turn;
  Vector3d shift;
  Vector3d motion;

  explicit Frame(Random& random) {
    turn = rotation_matrix(normalized(
        Quaternion<double>{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 1.1}));
    shift = random.vector(random.coin() ? 0 : 1e6);
    motion = random.vector(random.coin() ? 0 : 1e3);
  }
  MovingNode operator()(const MovingNode& point) const {
    return {turn * point.start + shift, turn * point.displacement + motion};
  }
};

// Each face lists its vertices from where it likes, in the sense it likes.
MovingFace face_of(const std::vector<MovingNode>& vertices, std::array<std::size_t, 4> corners,
                   Random& random) {
  std::rotate(corners.begin(), corners.begin() + random.integer(0, 3), corners.end());
  if (random.coin()) std::swap(corners[1], corners[3]);
  MovingFace face;
  for (std::size_t k = 0; k < 4; ++k) {
    face.start[k] = vertices[corners[k]].start;
    face.displacement[k] = vertices[corners[k]].displacement;
  }
  return face;
}

bool touches_any(const MovingNode& node, const std::vector<MovingFace>& faces) {
  return std::any_of(faces.begin(), faces.end(),
                     [&](const MovingFace& face) { return velocity_check(node, face).has_value(); });
}

MovingNode riser(double x, double y, Random& random) {
  return {{x, y, random.uniform(-1, 1)}, {0, 0, random.uniform(-1, 1)}};
}

// Quads about a common vertex. Seen from above they are a plane figure that does not move; heights move
// between -2 and 2, so a node that goes from 3 to -3 above its inside must meet one, wherever it goes: here
// at the seams.
TEST(VelocityCheckSurface, AFanLetsNothingThrough) {
  Random random(21);
  for (int i = 0; i < 20000; ++i) {
    const int quads = random.integer(3, 8);
    const double sector = std::numbers::pi / quads;
    std::vector<MovingNode> vertices{riser(0, 0, random)};
    for (int k = 0; k < 2 * quads; ++k) {
      const double angle = sector * (k + random.uniform(-0.1, 0.1));
      const double radius = k % 2 == 0 ? 1 : 1.2;
      vertices.push_back(riser(radius * std::cos(angle), radius * std::sin(angle), random));
    }
    // At the common vertex, or on an edge that leads to it.
    const MovingNode& spoke = vertices[index(1 + 2 * random.integer(0, quads - 1))];
    const double share = random.integer(0, 3) == 0 ? 0 : random.uniform(0, 0.4);
    const double time = random.uniform(0.2, 0.8);
    const Vector3d drift{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0};
    MovingNode node{share * spoke.start - time * drift, drift};
    node.start.z = 3;
    node.displacement.z = -6;

    const Frame frame(random);
    for (MovingNode& vertex : vertices) vertex = frame(vertex);
    std::vector<MovingFace> faces;
    for (int k = 0; k < quads; ++k) {
      const auto first = index(1 + 2 * k);
      const auto last = index(1 + (2 * k + 2) % (2 * quads));
      faces.push_back(face_of(vertices, {0, first, first + 1, last}, random));
    }
    EXPECT_TRUE(touches_any(frame(node), faces)) << i;
  }
}

TEST(VelocityCheckSurface, AStripLetsNothingThrough) {
  Random random(22);
  for (int i = 0; i < 20000; ++i) {
    std::vector<MovingNode> vertices;
    for (int k = 0; k < 5; ++k) {
      vertices.push_back(riser(k + random.uniform(-0.2, 0.2), random.uniform(-0.2, 0), random));
      vertices.push_back(riser(k + random.uniform(-0.2, 0.2), 1 + random.uniform(0, 0.2), random));
    }
    const auto rung = index(2 * random.integer(1, 3));  // an edge between two faces
    const double share = random.uniform(0.3, 0.7);
    const double time = random.uniform(0.2, 0.8);
    const Vector3d drift{random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0};
    MovingNode node{(1 - share) * vertices[rung].start + share * vertices[rung + 1].start - time * drift,
                    drift};
    node.start.z = 3;
    node.displacement.z = -6;

    const Frame frame(random);
    for (MovingNode& vertex : vertices) vertex = frame(vertex);
    std::vector<MovingFace> faces;
    for (std::size_t k = 0; k < 8; k += 2)
      faces.push_back(face_of(vertices, {k, k + 2, k + 3, k + 1}, random));
    EXPECT_TRUE(touches_any(frame(node), faces)) << i;
  }
}

// With a reach, the time reported is the first at which the distance is the reach: not nearer before (exact
// at sampled times, the nearest of a fine sweep among them), and at the reach then.
TEST(VelocityCheckSurface, ReachIsEnteredFirstAtTheReportedTime) {
  Random random(23);
  int reported = 0;
  for (int i = 0; i < 2000; ++i) {
    const Query query = adversarial_query(static_cast<Family>(random.integer(0, 4)), random);
    double size = 0;
    for (std::size_t k = 1; k < 4; ++k)
      size = std::max(size, norm(query.face.start[k] - query.face.start[0]));
    const double reach = size * random.power_of_ten(-4, 0);
    const double tolerance = touch_tolerance(query.node, query.face, reach);
    const auto contact = velocity_check(query.node, query.face, reach);
    const double until = contact ? contact->time : 1;
    double nearest_time = 0;
    double nearest = 1e300;
    for (int k = 0; k < 200; ++k) {
      const double time = until * k / 200;
      FaceVertices vertices;
      for (std::size_t j = 0; j < 4; ++j)
        vertices[j] = query.face.start[j] + time * query.face.displacement[j];
      const double distance =
          closest_point_on_quad(query.node.start + time * query.node.displacement, vertices).squared_distance;
      if (distance >= nearest) continue;
      nearest = distance;
      nearest_time = time;
    }
    if (!contact || contact->time > 0) {
      EXPECT_FALSE(exact::within(query.node, query.face, nearest_time, reach)) << i;
    }
    if (!contact) continue;
    ++reported;
    EXPECT_TRUE(exact::within(query.node, query.face, contact->time, reach + tolerance)) << i;
    if (contact->time > 0) {
      EXPECT_FALSE(exact::within(query.node, query.face, contact->time, reach - tolerance)) << i;
    }
  }
  EXPECT_GT(reported, 1000);
}

// Far from the origin and in a fast frame the answer is that of the same inputs at home, to the last bit
// where the shift is exact.
TEST(VelocityCheckSurface, OriginAndFrameAreNotSeen) {
  Random random(24);
  for (int i = 0; i < 2000; ++i) {
    const auto tenths = [&] { return 0x1p-10 * random.integer(-1024, 1024); };
    const auto place = [&] { return Vector3d{tenths(), tenths(), tenths()}; };
    Query home;
    home.node = {place(), place()};
    for (std::size_t k = 0; k < 4; ++k) {
      home.face.start[k] = place();
      home.face.displacement[k] = place();
    }
    Query away = home;
    const Vector3d shift{1e6, -2e6, 5e5};
    const Vector3d motion{-1000, 3000, 500};
    away.node.start += shift;
    away.node.displacement += motion;
    for (std::size_t k = 0; k < 4; ++k) {
      away.face.start[k] += shift;
      away.face.displacement[k] += motion;
    }
    const auto here = velocity_check(home.node, home.face);
    const auto there = velocity_check(away.node, away.face);
    ASSERT_EQ(here.has_value(), there.has_value());
    if (!here) continue;
    EXPECT_EQ(here->time, there->time);
    EXPECT_EQ(here->weights, there->weights);
  }
}

}  // namespace
}  // namespace brio
