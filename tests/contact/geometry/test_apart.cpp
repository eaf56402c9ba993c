/// The rejection over lanes: never wrong, the same in every lane, and worth having.

#include "contact/geometry/apart.hpp"

#include <gtest/gtest.h>

#include "tests/contact/geometry/adversarial_queries.hpp"
#include "tests/contact/geometry/exact_judge.hpp"

namespace brio {
namespace {

template <class T>
void put(MovingPair<T>& pair, const Query& query, int lane) {
  const auto one = [&](Vector3<T>& to, const Vector3d& from) {
    if constexpr (NumberTraits<T>::lanes == 1) {
      to = {from[0], from[1], from[2]};
    } else {
      to.x.set(lane, from[0]);
      to.y.set(lane, from[1]);
      to.z.set(lane, from[2]);
    }
  };
  one(pair.start[0], query.node.start);
  one(pair.displacement[0], query.node.displacement);
  for (std::size_t k = 0; k < 4; ++k) {
    one(pair.start[k + 1], query.face.start[k]);
    one(pair.displacement[k + 1], query.face.displacement[k]);
  }
}

TEST(SurelyApart, NeverDismissesATouch) {
  int dismissed = 0;
  for (int f = 0; f < family_count; ++f) {
    Random random(static_cast<std::uint64_t>(100 + f));
    for (int i = 0; i < 500; ++i) {
      const Query query = adversarial_query(static_cast<Family>(f), random);
      MovingPair<double> pair;
      put(pair, query, 0);
      if (!surely_apart(pair, 0.0)) continue;
      ++dismissed;
      EXPECT_FALSE(exact::first_contact(query.node, query.face))
          << name_of(static_cast<Family>(f)) << ' ' << i;
    }
  }
  EXPECT_GT(dismissed, 100);
}

TEST(SurelyApart, LanesAgreeWithOneAtATime) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    MovingPair<Lanes<double>> pack;
    bool expected[8];
    for (int lane = 0; lane < 8; ++lane) {
      const Query query = adversarial_query(static_cast<Family>(random.integer(0, family_count - 1)), random);
      put(pack, query, lane);
      MovingPair<double> pair;
      put(pair, query, 0);
      expected[lane] = surely_apart(pair, 0.0);
    }
    const auto apart = surely_apart(pack, Lanes<double>(0.0));
    for (int lane = 0; lane < 8; ++lane) EXPECT_EQ(apart.v[lane] != 0, expected[lane]);
  }
}

TEST(SurelyApart, ReachIsPartOfTheFace) {
  Query query;
  query.face.start = {Vector3d{0, 0, 0}, Vector3d{1, 0, 0.25}, Vector3d{1, 1, 0.5}, Vector3d{0, 1, 0.25}};
  query.face.displacement.fill(Vector3d{});
  const Vector3d normal = normalized(Vector3d{-1, -1, 4});
  query.node = {Vector3d{0.5, 0.5, 0.25} + 0.1 * normal, Vector3d{}};
  MovingPair<double> pair;
  put(pair, query, 0);
  EXPECT_TRUE(surely_apart(pair, 0.099999));
  EXPECT_FALSE(surely_apart(pair, 0.100001));
}

}  // namespace
}  // namespace brio
