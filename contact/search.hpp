#pragma once
/// Global contact search: which points lie inside which capture boxes. It knows nothing of meshes.
///
/// After Heinstein, Attaway, Swegle, Mello (1993), "A general contact detection algorithm for finite element
/// analysis": a capture box bounds a master surface over a time step, the points are the slave nodes. Two
/// strategies find the identical pairs: the paper's sorted lists (sorted_list_search.hpp) and a tree
/// (tree_search.hpp) whose cost grows like n log n. Neither depends on the extent of the domain. Inclusion is
/// tested in double on closed boxes; a point or a box with a coordinate that is not a number, or a box with
/// lower > upper, belongs to no pair.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/base/fields.hpp"
#include "src/base/parallel.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// Closed box: holds its faces.
struct CaptureBox {
  double lower[3];
  double upper[3];

  bool contains(const Vector3<double>& point) const {
    return point.x >= lower[0] && point.x <= upper[0] && point.y >= lower[1] && point.y <= upper[1] &&
           point.z >= lower[2] && point.z <= upper[2];
  }
};

/// Whether the box has an inside; false where a face is not a number.
inline bool can_hold_points(const CaptureBox& box) {
  return std::islessequal(box.lower[0], box.upper[0]) && std::islessequal(box.lower[1], box.upper[1]) &&
         std::islessequal(box.lower[2], box.upper[2]);
}

/// The pairs found, box by box: indices of the points inside box b are node[first[b]] ... node[first[b + 1] -
/// 1], ascending.
struct CandidatePairs {
  std::vector<int> first;  ///< boxes + 1 entries
  std::vector<int> node;

  std::size_t size() const { return node.size(); }
  std::span<const int> of_box(std::size_t box) const {
    const auto begin = static_cast<std::size_t>(first[box]);
    const auto end = static_cast<std::size_t>(first[box + 1]);
    return {node.data() + begin, end - begin};
  }
};

/// Work done so far. A comparison is one test of a number, or of a rank, against a bound; how many a strategy
/// needs for given points and boxes does not depend on the number of threads.
struct SearchCounts {
  std::uint64_t searches = 0;
  std::uint64_t comparisons = 0;
  std::uint64_t candidate_pairs = 0;
};

enum class SearchStrategy { automatic, sorted_lists, tree };
constexpr std::array<NamedValue<SearchStrategy>, 3> named_values(SearchStrategy) {
  return {{{"automatic", SearchStrategy::automatic},
           {"sorted_lists", SearchStrategy::sorted_lists},
           {"tree", SearchStrategy::tree}}};
}

}  // namespace brio
