#pragma once
/// Sets of numbers that are only ever joined.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "src/base/index.hpp"

namespace brio {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  /// The least number of the set.
  int root(int number) {
    while (at(number) != number) number = at(number) = at(at(number));
    return number;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    at(std::max(a, b)) = std::min(a, b);
  }

 private:
  int& at(int number) { return parent_[index(number)]; }
  std::vector<int> parent_;
};

}  // namespace brio
