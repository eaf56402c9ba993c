#include "src/deck.hpp"

#include <algorithm>

namespace brio {

namespace {

// Index of the first point after `time`, in [0, count].
std::size_t next_point(const std::vector<std::array<double, 2>>& points, double time) {
  return static_cast<std::size_t>(std::upper_bound(points.begin(), points.end(), time,
                                                   [](double t, const auto& point) { return t < point[0]; }) -
                                  points.begin());
}

}  // namespace

double Curve::operator()(double time) const {
  const std::size_t next = next_point(points, time);
  if (next == 0) return points.front()[1];
  if (next == points.size()) return points.back()[1];
  const auto& [t0, y0] = points[next - 1];
  const auto& [t1, y1] = points[next];
  return y0 + (y1 - y0) * (time - t0) / (t1 - t0);
}

double Curve::slope(double time) const {
  const std::size_t next = next_point(points, time);
  if (next == 0 || next == points.size()) return 0;
  return (points[next][1] - points[next - 1][1]) / (points[next][0] - points[next - 1][0]);
}

}  // namespace brio
