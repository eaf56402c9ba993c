#include "src/output/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brio {

std::string what_results_cannot_hold(const Snapshot& snapshot) {
  // To the end, without a branch: in lanes.
  const auto holds = [](const std::vector<double>& values, double limit, bool is_partial) {
    int outside = 0;
    if (is_partial)
      for (const double v : values) outside |= static_cast<int>(std::abs(v) > limit);
    else
      for (const double v : values) outside |= static_cast<int>(!(std::abs(v) <= limit));
    return outside == 0;
  };
  if (!holds(snapshot.points, std::numeric_limits<double>::max(), false)) return "the position of a node";
  for (const auto* fields : {&snapshot.point_fields, &snapshot.cell_fields})
    for (const FieldArray& one : *fields) {
      const bool single = one.storage == Storage::single_precision;
      if (!holds(one.values,
                 single ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max(),
                 one.is_partial))
        return "a value of '" + one.name + "'";
    }
  return {};
}

}  // namespace brio
