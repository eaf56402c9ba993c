#include "contact/reach.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace brio {

namespace {

constexpr std::size_t slice_size = 4096;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::size_t slice_count(std::size_t nodes) { return (nodes + slice_size - 1) / slice_size; }

/// Sum over slices first, so that it does not depend on the threads.
Vector3<double> mean(std::span<const Vector3<double>> values, std::vector<Vector3<double>>& slice_sum,
                     ThreadTeam& team) {
  slice_sum.assign(slice_count(values.size()), Vector3<double>{0.0, 0.0, 0.0});
  team.for_ranges(values.size(), slice_size, [&](std::size_t begin, std::size_t end) {
    Vector3<double> sum{0.0, 0.0, 0.0};
    for (std::size_t i = begin; i < end; ++i) sum = sum + values[i];
    slice_sum[begin / slice_size] = sum;
  });
  Vector3<double> total{0.0, 0.0, 0.0};
  for (const Vector3<double>& sum : slice_sum) total = total + sum;
  return values.empty() ? total : 1.0 / static_cast<double>(values.size()) * total;
}

}  // namespace

void MotionRanges::predict(std::span<const Vector3<double>> positions,
                           std::span<const Vector3<double>> velocities, double ahead, double buffer,
                           ThreadTeam& team) {
  assert(positions.size() == velocities.size() && ahead >= 0 && buffer >= 0);
  const Vector3<double> frame = mean(velocities, velocity_sum_, team);
  range_.resize(positions.size());
  team.for_ranges(positions.size(), slice_size, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3<double> path = ahead * (velocities[i] - frame);
      const double from[3] = {positions[i].x, positions[i].y, positions[i].z};
      const double along[3] = {path.x, path.y, path.z};
      for (int axis = 0; axis < 3; ++axis) {
        range_[i].lower[axis] = from[axis] + std::min(along[axis], 0.0) - 0.5 * buffer;
        range_[i].upper[axis] = from[axis] + std::max(along[axis], 0.0) + 0.5 * buffer;
      }
    }
  });
}

bool MotionRanges::hold(std::span<const Vector3<double>> positions,
                        std::span<const Vector3<double>> velocities, double dt, ThreadTeam& team) {
  assert(positions.size() == velocities.size());
  if (range_.empty() || range_.size() != positions.size()) return false;
  translations_.resize(slice_count(positions.size()));
  team.for_ranges(positions.size(), slice_size, [&](std::size_t begin, std::size_t end) {
    Translations slice;
    std::fill_n(&slice.least[0][0], 6, -infinity);
    std::fill_n(&slice.most[0][0], 6, infinity);
    for (std::size_t i = begin; i < end; ++i) {
      const double now[3] = {positions[i].x, positions[i].y, positions[i].z};
      const double moved[3] = {dt * velocities[i].x, dt * velocities[i].y, dt * velocities[i].z};
      for (int axis = 0; axis < 3; ++axis) {
        const double place[2] = {now[axis], now[axis] + moved[axis]};
        for (int at = 0; at < 2; ++at) {
          slice.least[at][axis] = std::max(slice.least[at][axis], place[at] - range_[i].upper[axis]);
          slice.most[at][axis] = std::min(slice.most[at][axis], place[at] - range_[i].lower[axis]);
        }
      }
    }
    translations_[begin / slice_size] = slice;
  });
  for (int at = 0; at < 2; ++at)
    for (int axis = 0; axis < 3; ++axis) {
      double least = -infinity;
      double most = infinity;
      for (const Translations& slice : translations_) {
        least = std::max(least, slice.least[at][axis]);
        most = std::min(most, slice.most[at][axis]);
      }
      if (!(least <= most)) return false;
    }
  return true;
}

}  // namespace brio
