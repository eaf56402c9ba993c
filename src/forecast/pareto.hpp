#pragma once
/// Pareto front of cost against error.

#include <span>
#include <vector>

namespace brio {

/// Of one run; not-a-number where it failed.
struct CostAndError {
  double cost = 0;
  double error = 0;
};

/// True of those that no other is at least as cheap and as accurate as, and better in one of the two.
std::vector<bool> pareto_front(std::span<const CostAndError> runs);

/// True where a run is both cheaper and more accurate than another by more than a share of the other's
/// figures.
bool beats(const CostAndError& run, const CostAndError& other, double share);

}  // namespace brio
