#pragma once
/// Every node against every box: the reference of the searches.

#include <span>
#include <vector>

#include "contact/search/search.hpp"

namespace brio {

inline CandidatePairs search_by_brute_force(const SearchNodes& nodes, std::span<const CaptureBox> boxes) {
  CandidatePairs pairs;
  pairs.first.push_back(0);
  for (const CaptureBox& box : boxes) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const CaptureBox range = nodes.range(i);
      if (box.holds_anything() && range.holds_anything() && box.overlaps(range))
        pairs.node.push_back(static_cast<int>(i));
    }
    pairs.first.push_back(static_cast<int>(pairs.node.size()));
  }
  return pairs;
}

}  // namespace brio
