#pragma once

#include <algorithm>
#include <vector>

namespace brio {

/// Ascending, each but once.
template <class T>
void sort_out(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace brio
