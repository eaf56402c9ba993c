#pragma once
/// The contact search with its strategy chosen.

#include <span>

#include "contact/search.hpp"
#include "contact/sorted_list_search.hpp"
#include "contact/tree_search.hpp"

namespace brio {

class GlobalSearch {
 public:
  explicit GlobalSearch(SearchStrategy strategy = SearchStrategy::automatic) : strategy_(strategy) {}

  /// Replace `pairs` by all (box, point) pairs with the point inside the box, and add the work to `counts`.
  /// Every strategy and any number of threads give the same pairs; allocates nothing once as many points,
  /// boxes and pairs have been seen. \throws std::length_error when the pairs cannot be numbered by an int.
  void find(std::span<const Vector3<double>> points, std::span<const CaptureBox> boxes, ThreadTeam& team,
            CandidatePairs& pairs, SearchCounts& counts) {
    if (strategy_ == SearchStrategy::sorted_lists) {
      sorted_lists_.find(points, boxes, team, pairs, counts);
    } else {
      tree_.find(points, boxes, team, pairs, counts);
    }
  }

 private:
  SearchStrategy strategy_;
  SortedListSearch sorted_lists_;
  TreeSearch tree_;
};

}  // namespace brio
