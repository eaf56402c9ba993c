#pragma once
/// Entries by block, in the order of rows: those that a block gathers.

#include <cstdint>
#include <vector>

#include "src/base/parallel.hpp"

namespace brio {

template <class Item>
class EntryLists {
 public:
  const Item* begin(std::size_t block) const { return item_.data() + first_[block]; }
  const Item* end(std::size_t block) const { return item_.data() + first_[block + 1]; }
  std::size_t place(std::size_t block) const { return first_[block]; }  ///< of its first item among all
  std::size_t size() const { return item_.size(); }

  /// \param each_entry each_entry(i, visit) calls visit(block, make) for the entries of row i, where make()
  /// gives the item.
  template <class EachEntry>
  void build(std::size_t rows, std::size_t blocks, ThreadTeam& team, EachEntry&& each_entry) {
    if (rows == 0) {
      first_.assign(blocks + 1, 0);
      return item_.clear();
    }
    // Each range of rows counts for itself; a block's items are those of the first range, then the second ...
    const std::size_t ranges = rows / rows_a_range >= most_ranges ? most_ranges : rows / rows_a_range + 1;
    const auto range_begin = [&](std::size_t r) { return rows * r / ranges; };
    count_.resize(ranges * blocks);
    first_.resize(blocks + 1);
    team.for_each(ranges, [&](std::size_t r) {
      std::uint32_t* count = count_.data() + r * blocks;
      for (std::size_t b = 0; b < blocks; ++b) count[b] = 0;
      for (std::size_t i = range_begin(r); i < range_begin(r + 1); ++i)
        each_entry(i, [&](int block, auto&&) { ++count[block]; });
    });
    std::uint32_t total = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      first_[b] = total;
      for (std::size_t r = 0; r < ranges; ++r) {
        const std::uint32_t own = count_[r * blocks + b];
        count_[r * blocks + b] = total;
        total += own;
      }
    }
    first_[blocks] = total;
    item_.resize(total);
    team.for_each(ranges, [&](std::size_t r) {
      std::uint32_t* next = count_.data() + r * blocks;
      for (std::size_t i = range_begin(r); i < range_begin(r + 1); ++i)
        each_entry(i, [&](int block, auto&& make) { item_[next[block]++] = make(); });
    });
  }

 private:
  static constexpr std::size_t rows_a_range = 4096;
  static constexpr std::size_t most_ranges = 8;

  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> count_;
  std::vector<Item> item_;
};

}  // namespace brio
