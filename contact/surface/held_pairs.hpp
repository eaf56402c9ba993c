#pragma once
/// What does not meet in contact because ties hold it together. Nothing is kept where nothing is tied.

#include <algorithm>
#include <utility>
#include <vector>

namespace brio {

struct HeldPairs {
  std::vector<int> holder;  ///< of each global node: the part of the surface whose face holds it, or -1
  /// Global nodes and parts that they never meet, ascending: held nodes and the part that holds them; corners
  /// of the faces that hold, and the parts that they hold.
  std::vector<std::pair<int, int>> pairs;
  std::vector<int> piece;            ///< of each body as built: the least of those that ties join to it
  std::vector<int> part_of_surface;  ///< of each part that holds: its number in the surface, or -1

  bool empty() const { return holder.empty(); }
  bool apart(int global_node, int part) const {
    return std::binary_search(pairs.begin(), pairs.end(), std::pair(global_node, part));
  }
  /// Whether two bodies are the same, or were joined by ties when they were built.
  bool one_piece(int a, int b) const {
    if (a == b) return true;
    const int count = static_cast<int>(piece.size());
    return a < count && b < count && piece[static_cast<std::size_t>(a)] == piece[static_cast<std::size_t>(b)];
  }
};

}  // namespace brio
