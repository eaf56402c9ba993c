/// The edge check on cases whose answer is known in closed form, and under exchange, reflection, rotation and
/// in other units, places and frames.

#include "contact/geometry/edge_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/geometry/edges_apart.hpp"
#include "tests/contact/geometry/adversarial_edges.hpp"
#include "tests/contact/geometry/exact_edges.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {
using enum SegmentFeature;

MovingEdge edge(const Vector3d& first, const Vector3d& second, const Vector3d& motion, double radius = 0) {
  return {{first, second}, {motion, motion}, radius};
}

const Vector3d rest{};
const MovingEdge along_x = edge({-1, 0, 0}, {1, 0, 0}, rest);

TEST(EdgeCheck, CrossedEdgesMeetWhenTheirHeightIsUsedUp) {
  const auto contact = edge_check(edge({0.5, -1, 1}, {0.5, 3, 1}, {0, 0, -4}), along_x);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.25, 5e-14);
  EXPECT_NEAR(contact->parameters[0], 0.25, 5e-14);
  EXPECT_NEAR(contact->parameters[1], 0.75, 5e-14);
  EXPECT_EQ(contact->features[0], inside);
  EXPECT_EQ(contact->features[1], inside);
  EXPECT_NEAR(norm(contact->normal - Vector3d{0, 0, 1}), 0, 5e-14);
  EXPECT_NEAR(contact->distance, 0, 5e-14);
}

TEST(EdgeCheck, TheNormalPointsToTheSideThatTheFirstComesFrom) {
  for (const double from : {1.0, -1.0}) {
    for (const double turn : {1.0, -1.0}) {
      const auto contact = edge_check(edge({0, -turn, from}, {0, turn, from}, {0, 0, -2 * from}), along_x);
      ASSERT_TRUE(contact);
      EXPECT_NEAR(contact->normal.z, from, 5e-14);
      EXPECT_EQ(contact->side, from * turn < 0 ? 1 : -1);
    }
  }
}

TEST(EdgeCheck, TooShortAStepOrAnAimPastTheEndIsNoContact) {
  EXPECT_FALSE(edge_check(edge({0.5, -1, 1}, {0.5, 3, 1}, {0, 0, -0.999}), along_x));
  EXPECT_FALSE(edge_check(edge({1.001, -1, 1}, {1.001, 3, 1}, {0, 0, -4}), along_x));
  EXPECT_FALSE(edge_check(edge({0.5, 0.001, 1}, {0.5, 3, 1}, {0, 0, -4}), along_x));
}

TEST(EdgeCheck, WithRadiiContactBeginsAtTheirSum) {
  MovingEdge thick = along_x;
  thick.radius = 0.2;
  const auto contact = edge_check(edge({0, -1, 1}, {0, 1, 1}, {0, 0, -1}, 0.1), thick);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.7, 5e-14);
  EXPECT_NEAR(contact->distance, 0.3, 5e-14);
  EXPECT_NEAR(norm(contact->normal - Vector3d{0, 0, 1}), 0, 5e-14);
  // Past the end by 0.18 it is a sphere's cap: at the height 0.24.
  const auto beside = edge_check(edge({1.18, -1, 1}, {1.18, 1, 1}, {0, 0, -1}, 0.1), thick);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(beside->time, 0.76, 5e-14);
  EXPECT_EQ(beside->features[1], second_end);
  EXPECT_NEAR(norm(beside->normal - Vector3d{0.6, 0, 0.8}), 0, 1e-13);
  EXPECT_FALSE(edge_check(edge({1.301, -1, 1}, {1.301, 1, 1}, {0, 0, -1}, 0.1), thick));
}

TEST(EdgeCheck, ParallelEdgesMeetInTheMiddleOfWhatTheyShare) {
  for (const double radius : {0.0, 0.25}) {
    const auto contact = edge_check(edge({0, 0, 1}, {4, 0, 1}, {0, 0, -2}, radius), along_x);
    ASSERT_TRUE(contact);
    EXPECT_NEAR(contact->time, 0.5 - 0.5 * radius, 5e-14);
    EXPECT_NEAR(contact->parameters[0], 0.125, 5e-14);
    EXPECT_NEAR(contact->parameters[1], 0.75, 5e-14);
    EXPECT_NEAR(norm(contact->normal - Vector3d{0, 0, 1}), 0, 5e-14);
    EXPECT_EQ(contact->side, 0);
  }
}

TEST(EdgeCheck, InOneLineTheyMeetEndOnEnd) {
  const auto contact = edge_check(edge({3, 0, 0}, {2, 0, 0}, {-2, 0, 0}), along_x);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.5, 5e-14);
  EXPECT_EQ(contact->features[0], second_end);
  EXPECT_EQ(contact->features[1], second_end);
  EXPECT_NEAR(norm(contact->normal - Vector3d{1, 0, 0}), 0, 5e-14);
  EXPECT_FALSE(edge_check(edge({3, 0, 0}, {2, 0, 0}, {-0.999, 0, 0}), along_x));
}

TEST(EdgeCheck, InOnePlaneAnEndMeetsTheInside) {
  const auto contact = edge_check(edge({0.5, 1, 0}, {0.75, 3, 0}, {0, -2, 0}), along_x);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.5, 5e-14);
  EXPECT_EQ(contact->features[0], first_end);
  EXPECT_NEAR(contact->parameters[1], 0.75, 5e-14);
  EXPECT_NEAR(norm(contact->normal - Vector3d{0, 1, 0}), 0, 5e-14);
  EXPECT_EQ(contact->side, 0);
}

TEST(EdgeCheck, ATurningEdgeIsMetWhereTheChordMotionPutsIt) {
  // The end at x = 1 comes up from z = -1 to 1: the height at x is (2 t - 1) (x + 1) / 2.
  MovingEdge lifted = along_x;
  lifted.start[1].z = -1;
  lifted.displacement[1].z = 2;
  const auto contact = edge_check(edge({0, -1, 0.25}, {0, 1, 0.25}, rest), lifted);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->time, 0.75, 1e-13);
  EXPECT_GT(contact->normal.z, 0);
}

TEST(EdgeCheck, TouchingAtTheStartIsContactAtTimeZero) {
  const auto crossed = edge_check(edge({0, -1, 0}, {0, 1, 0}, {0, 0, 1}), along_x);
  ASSERT_TRUE(crossed);
  EXPECT_EQ(crossed->time, 0);
  EXPECT_NEAR(std::abs(crossed->normal.z), 1, 1e-15);
  EXPECT_EQ(crossed->side, 0);
  const auto shared = edge_check(edge({1, 0, 0}, {3, 1, 0}, {0, 0, 1}), along_x);
  ASSERT_TRUE(shared);
  EXPECT_EQ(shared->time, 0);
  const auto deep = edge_check(edge({0, -1, 0.25}, {0, 1, 0.25}, {0, 0, 1}, 0.5), along_x);
  ASSERT_TRUE(deep);
  EXPECT_EQ(deep->time, 0);
  EXPECT_EQ(deep->distance, 0.25);
}

EdgeQuery any_edges(Random& random) {
  return adversarial_edges(static_cast<EdgeFamily>(random.integer(0, edge_family_count - 1)), random);
}

// As any_edges, but multiples of 2^-10.
EdgeQuery rounded_edges(Random& random) {
  EdgeQuery query{edge(rest, rest, rest), edge(rest, rest, rest)};
  const auto place = [&] { return rounded_to(random.vector(1), 1.0 / 1024); };
  for (MovingEdge* e : {&query.a, &query.b})
    for (std::size_t k = 0; k < 2; ++k) {
      e->start[k] = place();
      e->displacement[k] = place();
    }
  query.a.radius = random.coin() ? 0 : 0.25;
  return query;
}

template <class Change>
MovingEdge changed(MovingEdge e, const Change& change) {
  for (std::size_t k = 0; k < 2; ++k) {
    e.start[k] = change(e.start[k]);
    e.displacement[k] = change(e.displacement[k]);
  }
  return e;
}

void expect_same(const std::optional<EdgeContact>& a, const std::optional<EdgeContact>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->time, b->time);
  EXPECT_EQ(a->parameters, b->parameters);
  EXPECT_EQ(a->features, b->features);
  EXPECT_EQ(a->normal, b->normal);
  EXPECT_EQ(a->distance, b->distance);
  EXPECT_EQ(a->side, b->side);
}

TEST(EdgeCheck, ExchangeMirrorAndUnitGiveTheSameBits) {
  Random random(41);
  int reported = 0;
  for (int i = 0; i < 20000; ++i) {
    const EdgeQuery query = any_edges(random);
    const auto contact = edge_check(query.a, query.b);
    reported += contact.has_value();

    auto exchanged = edge_check(query.b, query.a);
    if (exchanged) {
      std::swap(exchanged->parameters[0], exchanged->parameters[1]);
      std::swap(exchanged->features[0], exchanged->features[1]);
      exchanged->normal = -exchanged->normal;
    }
    expect_same(contact, exchanged);

    const Vector3d mirror{1, 1, -1};
    const auto reflect = [&](const Vector3d& v) { return Vector3d(componentwise_product(v, mirror)); };
    auto mirrored = edge_check(changed(query.a, reflect), changed(query.b, reflect));
    if (mirrored) {
      const bool from_side = mirrored->time == 0 && mirrored->side == 0;  // then of either sign
      mirrored->normal = reflect(mirrored->normal);
      if (from_side && contact && mirrored->normal == -contact->normal) mirrored->normal = contact->normal;
      mirrored->side = -mirrored->side;
    }
    expect_same(contact, mirrored);

    const double unit = 0x1p-40;
    const auto scale = [&](const Vector3d& v) { return Vector3d(unit * v); };
    MovingEdge a = changed(query.a, scale);
    MovingEdge b = changed(query.b, scale);
    a.radius *= unit;
    b.radius *= unit;
    auto other = edge_check(a, b);
    if (other) other->distance /= unit;
    expect_same(contact, other);
    if (testing::Test::HasFailure()) FAIL() << i;
  }
  EXPECT_GT(reported, 10000);
}

// To the last bit where the shift is exact.
TEST(EdgeCheck, OriginAndFrameAreNotSeen) {
  Random random(42);
  int reported = 0;
  for (int i = 0; i < 5000; ++i) {
    const EdgeQuery home = rounded_edges(random);
    EdgeQuery away = home;
    for (MovingEdge* e : {&away.a, &away.b})
      for (std::size_t k = 0; k < 2; ++k) {
        e->start[k] += Vector3d{1e6, -2e6, 5e5};
        e->displacement[k] += Vector3d{-1000, 3000, 500};
      }
    const auto here = edge_check(home.a, home.b);
    expect_same(here, edge_check(away.a, away.b));
    reported += here.has_value();
  }
  EXPECT_GT(reported, 500);
}

TEST(EdgeCheck, TurnsWithTheEdges) {
  Random random(43);
  int reported = 0;
  for (int i = 0; i < 5000; ++i) {
    const EdgeQuery query = rounded_edges(random);
    const Tensor<double> turn = rotation_matrix(normalized(
        Quaternion<double>{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 1.1}));
    const auto rotate = [&](const Vector3d& v) { return Vector3d(turn * v); };
    const auto contact = edge_check(query.a, query.b);
    const auto turned = edge_check(changed(query.a, rotate), changed(query.b, rotate));
    ASSERT_EQ(contact.has_value(), turned.has_value()) << i;
    if (!contact) continue;
    ++reported;
    // At the turned time the unturned edges are within the tolerance too, and the earlier of both times is
    // not far from the other.
    const double tolerance = 2 * touch_tolerance(query.a, query.b);
    EXPECT_TRUE(exact::within(query.a, query.b, turned->time, tolerance)) << i;
    EXPECT_NEAR(turned->time, contact->time, 1e-6) << i;
    EXPECT_EQ(turned->side, contact->side) << i;
    EXPECT_NEAR(norm(turned->normal - rotate(contact->normal)), 0, 1e-5) << i;
  }
  EXPECT_GT(reported, 500);
}

template <class T>
void put(MovingEdgePair<T>& pair, const EdgeQuery& query, int lane) {
  const auto one = [&](Vector3<T>& to, const Vector3d& from) {
    if constexpr (NumberTraits<T>::lanes == 1) {
      to = {from[0], from[1], from[2]};
    } else {
      to.x.set(lane, from[0]);
      to.y.set(lane, from[1]);
      to.z.set(lane, from[2]);
    }
  };
  for (std::size_t k = 0; k < 2; ++k) {
    one(pair.start_a[k], query.a.start[k]);
    one(pair.displacement_a[k], query.a.displacement[k]);
    one(pair.start_b[k], query.b.start[k]);
    one(pair.displacement_b[k], query.b.displacement[k]);
  }
}

TEST(EdgesSurelyApart, NeverDismissesATouchAndLanesAgree) {
  Random random(44);
  int dismissed = 0;
  for (int i = 0; i < 2000; ++i) {
    MovingEdgePair<Lanes<double>> pack;
    Lanes<double> reach(0.0);
    bool expected[8];
    for (int lane = 0; lane < 8; ++lane) {
      const EdgeQuery query = any_edges(random);
      MovingEdgePair<double> pair;
      put(pair, query, 0);
      put(pack, query, lane);
      reach.set(lane, query.a.radius + query.b.radius);
      expected[lane] = surely_apart(pair, query.a.radius + query.b.radius);
      if (!expected[lane]) continue;
      ++dismissed;
      EXPECT_FALSE(exact::first_contact(query.a, query.b)) << i;
    }
    const auto apart = surely_apart(pack, reach);
    for (int lane = 0; lane < 8; ++lane) EXPECT_EQ(apart.v[lane] != 0, expected[lane]) << i;
  }
  EXPECT_GT(dismissed, 2000);
}

TEST(EdgesSurelyApart, SeesParallelEdgesApartOfWhichTheBoxesOverlap) {
  const EdgeQuery query{edge({0, 0, 0}, {1, 1, 1}, rest), edge({0.3, -0.2, -0.1}, {1.3, 0.8, 0.9}, rest)};
  MovingEdgePair<double> pair;
  put(pair, query, 0);
  const double distance = norm(Vector3d{0.3, -0.2, -0.1});  // it is at right angles to both
  EXPECT_TRUE(surely_apart(pair, 0.999999 * distance));
  EXPECT_FALSE(surely_apart(pair, 1.000001 * distance));
}

}  // namespace
}  // namespace brio
