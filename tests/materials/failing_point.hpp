#pragma once
/// A point of a failing material that tests strain.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "materials/failing.hpp"
#include "src/base/index.hpp"
#include "src/base/lanes.hpp"
#include "tests/materials/paths.hpp"

namespace brio {

template <class Law>
struct Point {
  Law law;
  SymmetricTensor<double> stress{};
  typename Law::template History<double> history{};

  explicit Point(const Law& running, double size = 1) : law(running) {
    if constexpr (can_fail<Law>) law.start(history, size);
  }
  void strain(const SymmetricTensor<double>& increment) { law.update(increment, stress, history); }
  bool failed() const { return law.has_failed(history); }
};
template <class Law>
Point(const Law&) -> Point<Law>;

/// Strains a point along x with free sides.
template <class P>
void pull(P& point, double increment) {
  double low = -1.5 * std::abs(increment), high = 1.5 * std::abs(increment);
  const auto side_stress = [&](double side) {
    P trial = point;
    trial.strain({increment, side, side, 0, 0, 0});
    return trial.stress.yy;
  };
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (side_stress(middle) > 0 ? high : low) = middle;
  }
  point.strain({increment, low, low, 0, 0, 0});
}

template <class Law>
void expect_monotone(const Law& law, unsigned seed) {
  constexpr int paths = 50;
  int failures = 0;
  for (int path = 0; path < paths; ++path) {
    RandomPath random(seed + static_cast<unsigned>(path));
    Point point(law);
    for (int step = 0; step < 2000; ++step) {
      const double before = point.history.damage;
      const double plastic = point.history.equivalent_plastic_strain;
      const bool failed = point.failed();
      point.strain(random.next());
      ASSERT_GE(point.history.damage, before);
      ASSERT_LE(point.history.damage, 1.0);
      ASSERT_GE(point.history.equivalent_plastic_strain, plastic);
      if (!point.failed()) continue;
      ASSERT_EQ(contract(point.stress, point.stress), 0.0);
      if (!failed) continue;
      ASSERT_EQ(point.history.damage, before);
      ASSERT_EQ(point.history.equivalent_plastic_strain, plastic);
    }
    failures += point.failed() ? 1 : 0;
  }
  EXPECT_GT(failures, paths / 2);  // some paths lead into compression and stay there
}

template <Floating Real, class Law>
void expect_lanes_agree(const Law& law, double tolerance) {
  using T = Lanes<Real>;
  constexpr int width = lane_count<Real>;
  RandomPath random(17);
  SymmetricTensor<T> stress{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
  typename Law::template History<T> history;
  std::memset(static_cast<void*>(&history), 0, sizeof history);
  law.start(history, T(1.0));
  std::vector<Point<Law>> points(index(width), Point<Law>(law));
  for (int step = 0; step < 400; ++step) {
    SymmetricTensor<T> strain;
    T* component[6] = {&strain.xx, &strain.yy, &strain.zz, &strain.xy, &strain.yz, &strain.xz};
    for (int lane = 0; lane < width; ++lane) {
      const SymmetricTensor<double> one = random.next();
      const double entries[6] = {one.xx, one.yy, one.zz, one.xy, one.yz, one.xz};
      for (int c = 0; c < 6; ++c) component[c]->set(lane, static_cast<Real>(entries[c]));
      points[index(lane)].strain({component[0]->operator[](lane), (*component[1])[lane],
                                  (*component[2])[lane], (*component[3])[lane], (*component[4])[lane],
                                  (*component[5])[lane]});
    }
    law.update(strain, stress, history);
    for (int lane = 0; lane < width; ++lane) {
      const Point<Law>& point = points[index(lane)];
      ASSERT_NEAR(history.damage[lane], point.history.damage, tolerance);
      if (point.failed() || static_cast<double>(history.damage[lane]) >= 0.9 - tolerance) continue;
      ASSERT_NEAR(stress.xx[lane], point.stress.xx, 100 * tolerance * law.yield_stress);
    }
  }
}

}  // namespace brio
