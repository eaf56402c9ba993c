#include "src/output/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brio {

std::string what_results_cannot_hold(const Snapshot& snapshot) {
  const auto holds = [](const std::vector<double>& values, double limit, bool is_partial) {
    return std::all_of(values.begin(), values.end(),
                       [=](double v) { return (is_partial && std::isnan(v)) || std::abs(v) <= limit; });
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
