#include "src/forecast/pareto.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

bool dominates(const CostAndError& a, const CostAndError& b) {
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

}  // namespace

std::vector<bool> pareto_front(std::span<const CostAndError> runs) {
  std::vector<bool> on_front;
  on_front.reserve(runs.size());
  for (const CostAndError& run : runs)
    on_front.push_back(std::isfinite(run.cost) && std::isfinite(run.error) &&
                       std::none_of(runs.begin(), runs.end(),
                                    [&](const CostAndError& other) { return dominates(other, run); }));
  return on_front;
}

bool beats(const CostAndError& run, const CostAndError& other, double share) {
  return run.cost < (1 - share) * other.cost && run.error < (1 - share) * other.error;
}

}  // namespace brio
