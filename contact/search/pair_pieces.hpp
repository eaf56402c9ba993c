#pragma once
/// Pairs found by separate tasks, and their merging. A task handles boxes of its own and keeps what it found
/// to itself, so that the merged pairs do not depend on who ran which task.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/search/search.hpp"

namespace brio {

/// Make room for `size` elements in a list that only ever grows.
template <class T>
void make_room(std::vector<T>& list, std::size_t size) {
  if (list.size() < size) list.resize(std::max(size, 2 * list.size()));
}

/// What one task found: node[0] ... node[found - 1] holds count[0] points of box[0], then count[1] of box[1],
/// ...
struct PairPiece {
  std::vector<int> box;
  std::vector<int> count;
  std::vector<int> node;  ///< room for more than was found
  std::size_t found = 0;
  std::uint64_t comparisons = 0;

  void clear() {
    box.clear();
    count.clear();
    found = 0;
    comparisons = 0;
  }
  /// Where the next box may write up to `most` points.
  int* room(std::size_t most) {
    make_room(node, found + most);
    return node.data() + found;
  }
  void add(int box_number, std::size_t points) {
    box.push_back(box_number);
    count.push_back(static_cast<int>(points));
    found += points;
  }
};

/// Tasks into which `items` are cut: enough of them to even out the load, few enough to keep them large.
inline std::size_t piece_count(std::size_t items, std::size_t smallest_piece) {
  constexpr std::size_t most_pieces = 64;
  return std::min(most_pieces, (items + smallest_piece - 1) / smallest_piece);
}

/// Write the pieces' pairs in the order of the boxes, of which there are `boxes`, and add up the work.
/// \throws std::length_error when the pairs cannot be numbered by an int.
void merge(std::span<const PairPiece> pieces, std::size_t boxes, ThreadTeam& team, CandidatePairs& pairs,
           SearchCounts& counts);

}  // namespace brio
