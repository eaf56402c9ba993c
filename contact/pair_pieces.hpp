#pragma once
/// Pairs found by separate tasks, and their merging. A task handles boxes of its own and keeps what it found
/// to itself, so that the merged pairs do not depend on who ran which task.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/search.hpp"

namespace brio {

/// What one task found: node[...] holds count[0] points of box[0], then count[1] points of box[1], ...
struct PairPiece {
  std::vector<int> box;
  std::vector<int> count;
  std::vector<int> node;
  std::uint64_t comparisons = 0;

  void clear() {
    box.clear();
    count.clear();
    node.clear();
    comparisons = 0;
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
