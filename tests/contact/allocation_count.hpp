#pragma once
/// Counts what operator new hands out, in any thread, while a counter lives. The operators are replaced in
/// allocation_count.cpp for the whole test program; nothing is counted elsewhere.

#include <cstddef>

namespace brio {

class AllocationCount {
 public:
  AllocationCount();
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  /// Allocations since this counter began.
  std::size_t count() const;
};

}  // namespace brio
