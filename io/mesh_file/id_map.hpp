#pragma once
/// Numbers of a file to places in lists.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace brio {

/// Of numbers that nearly follow each other a table, else sorted pairs: memory is proportional to their
/// count, whatever they are.
class IdMap {
 public:
  explicit IdMap(std::span<const std::int64_t> ids);

  /// Place of a number among the ids; -1 where it is not among them.
  int find(std::int64_t id) const;
  /// The second place of a number that stands twice, the least such; -1 where there is none.
  int repeated() const { return repeated_; }

 private:
  std::int64_t least_ = 0;
  std::vector<int> table_;
  std::vector<std::pair<std::int64_t, int>> sorted_;
  int repeated_ = -1;
};

}  // namespace brio
