#pragma once
/// Parts that share nodes.

#include <string>

namespace brio {

/// What became of one connection.
struct MergedParts {
  std::string first, second;
  int nodes = 0;        ///< of the second that became nodes of the first
  double farthest = 0;  ///< that any of them was moved
};

}  // namespace brio
