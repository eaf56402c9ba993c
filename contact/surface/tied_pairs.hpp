#pragma once
/// Pairs that are excluded from contact because they are tied. Empty where nothing is tied.

#include <algorithm>
#include <utility>
#include <vector>

#include "src/base/index.hpp"

namespace brio {

struct TiedPairs {
  std::vector<int> main_part;  ///< of each global node: the part of its main surface, or -1
  /// Excluded pairs of global nodes and parts, ascending: tied nodes and the part of their main surface;
  /// corners of main faces and the parts tied to them.
  std::vector<std::pair<int, int>> pairs;
  std::vector<int> piece;            ///< of each body as built: the least body tied to it
  std::vector<int> part_of_surface;  ///< of each part with a main surface: its number in the surface, or -1

  bool empty() const { return main_part.empty(); }
  bool apart(int global_node, int part) const {
    return std::binary_search(pairs.begin(), pairs.end(), std::pair(global_node, part));
  }
  /// Whether two bodies are the same, or were tied when they were built.
  bool one_piece(int a, int b) const {
    if (a == b) return true;
    const int count = static_cast<int>(piece.size());
    return a < count && b < count && piece[index(a)] == piece[index(b)];
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(main_part, pairs, piece, part_of_surface);
  }
};

}  // namespace brio
