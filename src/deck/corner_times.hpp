#pragma once
/// Curves together.

#include <algorithm>
#include <vector>

#include "src/deck/deck.hpp"

namespace brio {

/// 0, the end, and the corners in between of all curves; those that are null are left out. Ascending.
inline std::vector<double> corner_times(const std::vector<const Curve*>& curves, double end) {
  std::vector<double> times{0, end};
  for (const Curve* curve : curves)
    if (curve != nullptr)
      for (const auto& point : curve->points)
        if (point[0] > 0 && point[0] < end) times.push_back(point[0]);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace brio
