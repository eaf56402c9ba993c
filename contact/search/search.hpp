#pragma once
/// Global contact search: which points lie inside which capture boxes. Independent of meshes.
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
#include "src/base/index.hpp"
#include "src/base/parallel.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// Closed box: holds its faces.
struct CaptureBox {
  double lower[3];
  double upper[3];

  /// Grows to hold a point or another box. What is not a number is left out.
  BRIO_INLINE void include(const Vector3d& x) { include({{x.x, x.y, x.z}, {x.x, x.y, x.z}}); }
  template <class Point>
  BRIO_INLINE void include(const Point& x) {
    for (int axis = 0; axis < 3; ++axis) grow(axis, x[axis], x[axis]);
  }
  BRIO_INLINE void include(const CaptureBox& box) {
    for (int axis = 0; axis < 3; ++axis) grow(axis, box.lower[axis], box.upper[axis]);
  }

  /// False where lower > upper or a face is not a number: nothing is in such a box.
  bool holds_anything() const { return overlaps(*this); }

  /// Whether two boxes, each of which holds something, share a point.
  bool overlaps(const CaptureBox& other) const {
    return std::islessequal(other.lower[0], upper[0]) && std::isgreaterequal(other.upper[0], lower[0]) &&
           std::islessequal(other.lower[1], upper[1]) && std::isgreaterequal(other.upper[1], lower[1]) &&
           std::islessequal(other.lower[2], upper[2]) && std::isgreaterequal(other.upper[2], lower[2]);
  }

 private:
  BRIO_INLINE void grow(int axis, double from, double to) {
    lower[axis] = from < lower[axis] ? from : lower[axis];
    upper[axis] = to > upper[axis] ? to : upper[axis];
  }
};

/// Holds nothing.
inline constexpr CaptureBox empty_box{{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};

/// Query of the search: points, or nodes each of which may be anywhere in a closed box of its
/// own; such a node is paired with the boxes that share a point with its own. A view: the array must outlive
/// the search.
class SearchNodes {
 public:
  SearchNodes(std::span<const Vector3d> points)
      : first_(reinterpret_cast<const double*>(points.data())),
        count_(points.size()),
        stride_(3),
        to_upper_(0) {
    static_assert(sizeof(Vector3d) == 3 * sizeof(double));
  }
  SearchNodes(std::span<const CaptureBox> ranges)
      : first_(reinterpret_cast<const double*>(ranges.data())),
        count_(ranges.size()),
        stride_(6),
        to_upper_(3) {
    static_assert(sizeof(CaptureBox) == 6 * sizeof(double));
  }
  SearchNodes(const std::vector<Vector3d>& points) : SearchNodes(std::span(points)) {}
  SearchNodes(const std::vector<CaptureBox>& ranges) : SearchNodes(std::span(ranges)) {}

  std::size_t size() const { return count_; }
  bool are_points() const { return to_upper_ == 0; }
  double lower(std::size_t node, int axis) const { return first_[node * stride_ + index(axis)]; }
  double upper(std::size_t node, int axis) const { return first_[node * stride_ + to_upper_ + index(axis)]; }
  CaptureBox range(std::size_t node) const {
    return {{lower(node, 0), lower(node, 1), lower(node, 2)},
            {upper(node, 0), upper(node, 1), upper(node, 2)}};
  }

 private:
  const double* first_;
  std::size_t count_, stride_, to_upper_;
};

/// The pairs found, box by box: indices of the nodes in box b are node[first[b]] ... node[first[b + 1] -
/// 1], ascending.
struct CandidatePairs {
  std::vector<int> first;  ///< boxes + 1 entries
  std::vector<int> node;

  std::size_t size() const { return node.size(); }
  std::span<const int> of_box(std::size_t box) const {
    const auto begin = index(first[box]);
    const auto end = index(first[box + 1]);
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
