#pragma once
/// Islands: sets of blocks joined by rows, found in parallel. The sets do not
/// depend on the order in which they are joined.

#include <atomic>
#include <cstdint>
#include <vector>

namespace brio {

class IslandFinder {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  void reset(std::size_t blocks) {
    parent_.resize(blocks);
    island_.assign(blocks, none);
    for (std::size_t b = 0; b < blocks; ++b) parent_[b] = static_cast<std::uint32_t>(b);
    islands_ = 0;
  }
  /// May be called by several threads. A root is the first block of its set.
  void join(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = root(a);
      b = root(b);
      if (a == b) return;
      std::uint32_t last = a > b ? a : b;
      const std::uint32_t first = a > b ? b : a;
      if (at(last).compare_exchange_strong(last, first, std::memory_order_relaxed)) return;
    }
  }
  /// Number of the island of a block; numbers are given in the order in which they are first asked for.
  std::uint32_t number(std::uint32_t block) {
    std::uint32_t& island = island_[root(block)];
    if (island == none) island = islands_++;
    return island;
  }
  /// The same, where it has a number; else none.
  std::uint32_t number_if_any(std::uint32_t block) { return island_[root(block)]; }
  std::uint32_t size() const { return islands_; }

 private:
  std::atomic_ref<std::uint32_t> at(std::uint32_t block) {
    return std::atomic_ref<std::uint32_t>(parent_[block]);
  }
  // Paths are halved on the way: a parent is replaced by its parent, which is of the same set.
  std::uint32_t root(std::uint32_t block) {
    for (;;) {
      std::uint32_t parent = at(block).load(std::memory_order_relaxed);
      if (parent == block) return block;
      const std::uint32_t above = at(parent).load(std::memory_order_relaxed);
      if (above == parent) return parent;
      at(block).compare_exchange_weak(parent, above, std::memory_order_relaxed);
      block = above;
    }
  }

  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> island_;  ///< by root
  std::uint32_t islands_ = 0;
};

}  // namespace brio
