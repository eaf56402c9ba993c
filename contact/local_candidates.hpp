#pragma once
/// Candidates of faces and slave nodes that come to the surface between two searches.
///
/// Every slave node has a starting point, where the last search saw it; a newcomer is given the one from
/// which it would have come had it moved with a node beside it. As long as no two slave nodes have moved from
/// their starting points by more than the buffer relative to each other, no node and face can have come
/// within reach of each other unless the starting point lies in the capture box around the starting points of
/// the face's corners: that is what the search tests, and what is tested here for the newcomers alone.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/candidates.hpp"
#include "contact/surface_topology.hpp"
#include "contact/tree_search.hpp"

namespace brio {

/// A tree over boxes to which boxes may be added. What is added is sorted into further trees, each at least
/// twice as large as the next: a box is sorted and a question asked as often as a logarithm of their number.
class GrowingTree {
 public:
  void build(const SearchNodes& boxes, ThreadTeam& team);
  void add(int number, const CaptureBox& box) {
    number_.push_back(number);
    box_.push_back(box);
  }
  /// Keep what was added lately few: to be called after some were added.
  void sort_in(ThreadTeam& team);
  /// Call `visit` with the number of every box that shares a point with `box`.
  template <class Visit>
  void for_overlapping(const CaptureBox& box, std::uint64_t& comparisons, const Visit& visit);

 private:
  struct Later {
    NodeTree tree;
    std::size_t begin, end;  ///< of the boxes added
    std::size_t size() const { return end - begin; }
  };
  std::size_t sorted_in() const { return later_.empty() ? 0 : later_.back().end; }

  NodeTree all_;
  std::vector<Later> later_;     ///< over the boxes added, one after the other
  std::vector<int> number_;      ///< of the boxes added
  std::vector<CaptureBox> box_;  ///< the boxes added
  std::vector<int> found_, places_;
};

class LocalCandidates {
 public:
  /// Add the pairs of new faces and new slave nodes, take dead slave nodes out. Dead faces stay in the lists
  /// until the next search. Does nothing where a search is due.
  void add(Candidates& candidates, const Surface& surface, const Lists& excluded,
           const ContactOptions& options, const Nodes& nodes, const SurfaceChange& change, ThreadTeam& team);
  /// Add one pair of a living slave node and a living face. A search has been made.
  void add_pair(Candidates& candidates, int slave, int face, ThreadTeam& team);

  std::uint64_t comparisons = 0;  ///< so far, of additions

 private:
  void follow_search(const Candidates& candidates, ThreadTeam& team);
  void include(Candidates& candidates, int slave, int face);
  void place_newcomers(Candidates& candidates, const Surface& surface, const ContactOptions& options,
                       const Nodes& nodes, const SurfaceChange& change);

  GrowingTree slaves_;              ///< starting points
  GrowingTree faces_;               ///< capture boxes
  std::uint64_t search_ = 0;        ///< number of the search that the trees belong to; 0: none
  std::vector<char> is_candidate_;  ///< of each face, whether it is in Candidates::face
};

}  // namespace brio
