#pragma once
/// Global search of contact, with a choice of strategy.

#include <span>

#include "contact/search/search.hpp"
#include "contact/search/sorted_list_search.hpp"
#include "contact/search/tree_search.hpp"

namespace brio {

/// Nodes and boxes up to which the sorted lists are the faster: measured on blocks, both take 27 microseconds
/// at 224 nodes and 216 boxes; at 52 and 48 the lists take a third of the tree's time, at 784 and 768 nearly
/// four times.
inline constexpr std::size_t most_for_sorted_lists = 400;

class GlobalSearch {
 public:
  explicit GlobalSearch(SearchStrategy strategy = SearchStrategy::automatic) : strategy_(strategy) {}

  /// Replace `pairs` by all (box, node) pairs with the node inside the box, and add the work to `counts`.
  /// Every strategy and any number of threads give the same pairs; allocates nothing once as many nodes,
  /// boxes and pairs have been seen.
  ///
  /// \throws std::length_error when the pairs cannot be numbered by an int.
  void find(const SearchNodes& nodes, std::span<const CaptureBox> boxes, ThreadTeam& team,
            CandidatePairs& pairs, SearchCounts& counts) {
    const bool small = nodes.size() + boxes.size() <= most_for_sorted_lists;
    if (strategy_ == SearchStrategy::sorted_lists || (strategy_ == SearchStrategy::automatic && small)) {
      sorted_lists_.find(nodes, boxes, team, pairs, counts);
    } else {
      tree_.find(nodes, boxes, team, pairs, counts);
    }
  }

 private:
  SearchStrategy strategy_;
  SortedListSearch sorted_lists_;
  TreeSearch tree_;
};

}  // namespace brio
