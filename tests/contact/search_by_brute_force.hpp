#pragma once
/// Every point against every box: what the searches are held against.

#include <span>
#include <vector>

#include "contact/search.hpp"

namespace brio {

inline CandidatePairs search_by_brute_force(std::span<const Vector3<double>> points,
                                            std::span<const CaptureBox> boxes) {
  CandidatePairs pairs;
  pairs.first.push_back(0);
  for (const CaptureBox& box : boxes) {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (box.contains(points[i])) pairs.node.push_back(static_cast<int>(i));
    pairs.first.push_back(static_cast<int>(pairs.node.size()));
  }
  return pairs;
}

}  // namespace brio
