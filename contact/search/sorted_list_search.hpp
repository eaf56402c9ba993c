#pragma once
/// The search of Heinstein et al. (1993), after Swegle: for each axis the points' indices in ascending order
/// and each point's rank in that order; with the points found for a box, 7 n integers. Two binary searches an
/// axis give the slab of a box; the points of the shortest slab are tested by their ranks on the other two
/// axes. A slab of a large scene holds many points, so that the cost grows faster than n log n: this is the
/// counted reference.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/search/pair_pieces.hpp"
#include "contact/search/search.hpp"

namespace brio {

class SortedListSearch {
 public:
  /// Replace `pairs` by all (box, node) pairs with the node inside the box, and add the work to `counts`. The
  /// same for any number of threads; allocates nothing once as many nodes, boxes and pairs have been seen.
  ///
  /// \throws std::length_error when the pairs cannot be numbered by an int.
  void find(const SearchNodes& nodes, std::span<const CaptureBox> boxes, ThreadTeam& team,
            CandidatePairs& pairs, SearchCounts& counts);

 private:
  struct Slab {
    int begin, end;  ///< positions in order_
  };
  void sort(const SearchNodes& nodes, int axis);
  Slab slab(int axis, const SearchNodes& nodes, double lower, double upper, std::uint64_t& comparisons) const;
  void find_in_box(const SearchNodes& nodes, std::span<const CaptureBox> boxes, std::size_t box,
                   PairPiece& piece) const;

  std::vector<int> left_in_;     ///< nodes that are somewhere: their coordinates are numbers
  std::vector<int> order_[3];    ///< these nodes by ascending (lower) coordinate
  std::vector<int> rank_[3];     ///< position of a node in order_
  double width_[3] = {0, 0, 0};  ///< a bound of the nodes' ranges, by which the slabs are grown; 0 for points
  std::vector<PairPiece> pieces_;
};

}  // namespace brio
