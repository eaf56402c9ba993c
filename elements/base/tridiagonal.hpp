#pragma once
/// Largest eigenvalue of a symmetric tridiagonal matrix, for Lanczos' method.

#include <algorithm>
#include <cstddef>
#include <span>

namespace brio {

/// By bisection, from above: with a shift beyond it all pivots are negative.
/// \param beside entries beside the diagonal; those beyond the size of the matrix are not read
inline double largest_eigenvalue(std::span<const double> diagonal, std::span<const double> beside) {
  constexpr int bisections = 60;
  double lower = diagonal[0], upper = diagonal[0];
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    const double reach = (i > 0 ? beside[i - 1] : 0) + (i + 1 < diagonal.size() ? beside[i] : 0);
    lower = std::max(lower, diagonal[i]);
    upper = std::max(upper, diagonal[i] + reach);
  }
  for (int pass = 0; pass < bisections; ++pass) {
    const double shift = 0.5 * (lower + upper);
    double pivot = diagonal[0] - shift;
    bool all_negative = pivot < 0;
    for (std::size_t i = 1; i < diagonal.size() && all_negative; ++i) {
      pivot = diagonal[i] - shift - beside[i - 1] * beside[i - 1] / pivot;
      all_negative = pivot < 0;
    }
    (all_negative ? upper : lower) = shift;
  }
  return upper;
}

}  // namespace brio
