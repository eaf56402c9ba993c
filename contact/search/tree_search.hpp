#pragma once
/// Search by a tree. The points are laid along a space-filling curve and cut into leaves of 16, sixteen
/// leaves or branches to a branch. The boxes are laid along a curve too; groups of neighbours descend
/// together by their common bounds, and each box then tests only the few points found. The cost grows like n
/// log n.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/search/pair_pieces.hpp"
#include "contact/search/search.hpp"
#include "contact/search/spatial_order.hpp"
#include "src/base/aligned.hpp"
#include "src/base/index.hpp"

namespace brio {

inline constexpr int tree_width = 16;

/// Sixteen boxes in single precision, as they lie beside `origin`, over a length. Both the difference and the
/// roundings keep the order of coordinates: boxes that meet meet here too, and few others do.
struct alignas(64) TreeBlock {
  float lower[3][tree_width];
  float upper[3][tree_width];
  double origin[3];
  double per_length;

  BRIO_INLINE float seen(double coordinate, int axis) const {
    return static_cast<float>(std::clamp((coordinate - origin[axis]) * per_length, -farthest, farthest));
  }
  static constexpr double farthest = 1e30;  ///< beyond, order does not matter: within single precision
};

class NodeTree {
 public:
  void build(const SearchNodes& nodes, ThreadTeam& team);

  /// Of all nodes; holds nothing where there is none.
  CaptureBox bounds() const { return bounds_.empty() ? empty_box : bounds_.front(); }
  bool holds_points() const { return holds_points_; }
  /// The node at a place in the order of the tree, and where it may be.
  int node(int place) const { return order_[index(place)]; }
  const CaptureBox& range(int place) const { return range_[index(place)]; }

  struct Branch {
    std::size_t level, block;
  };
  /// Branches that hold all nodes inside `box`, where boxes inside it may begin; they are kept in `room`.
  std::span<const Branch> narrow(const CaptureBox& box, std::vector<Branch>& room,
                                 std::uint64_t& comparisons) const;
  /// The places of all nodes of `branches` inside `box`, and of some beside it. Stops as soon as there are
  /// more than `most`. Returns how many.
  std::size_t collect(const CaptureBox& box, std::span<const Branch> branches, std::size_t most,
                      std::vector<int>& places, std::uint64_t& comparisons) const;

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(order_, holds_points_, range_, blocks_, first_, bounds_);
  }

 private:
  void add_level(std::span<const CaptureBox> boxes, ThreadTeam& team);

  std::vector<Vector3d> centres_;
  SpatialOrder order_;
  bool holds_points_ = true;
  std::vector<CaptureBox> range_;   ///< of each place
  std::vector<TreeBlock> blocks_;   ///< level by level, from the leaves up
  std::vector<std::size_t> first_;  ///< block of each level
  std::vector<CaptureBox> bounds_;  ///< of the blocks of the level last added
  std::vector<CaptureBox> below_;   ///< of the level before
};

/// The nodes about the common bounds of a group of boxes, in ascending order.
struct NodesNearby {
  std::vector<NodeTree::Branch> room;
  std::span<const NodeTree::Branch> branches;  ///< about several groups

  std::vector<int> node;
  std::vector<double> lower[3];
  std::vector<double> upper[3];  ///< empty for points

  std::vector<int> place;  ///< of the same nodes in the tree
  std::vector<int> found;  ///< their numbers, in the same order
  std::vector<int> rank;   ///< of each of them among all
};

class TreeSearch {
 public:
  /// Replace `pairs` by all (box, node) pairs with the node inside the box, and add the work to `counts`. The
  /// same for any number of threads; allocates nothing once as many nodes, boxes and pairs have been seen.
  ///
  /// \throws std::length_error when the pairs cannot be numbered by an int.
  void find(const SearchNodes& nodes, std::span<const CaptureBox> boxes, ThreadTeam& team,
            CandidatePairs& pairs, SearchCounts& counts);

  /// The same in two steps, so that one tree serves several searches: the tree of the nodes as they are now
  /// ...
  void build(const SearchNodes& nodes, ThreadTeam& team) { tree_.build(nodes, team); }
  /// ... and the pairs with the nodes as they were then.
  void find(std::span<const CaptureBox> boxes, ThreadTeam& team, CandidatePairs& pairs, SearchCounts& counts);

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(tree_);
  }

 private:
  void find_in_groups(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end,
                      NodesNearby& nearby, PairPiece& piece) const;
  void find_in_group(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end,
                     NodesNearby& nearby, PairPiece& piece) const;
  CaptureBox bounds_of(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end) const;

  NodeTree tree_;
  std::vector<Vector3d> centres_;
  SpatialOrder box_order_;
  std::vector<PairPiece> pieces_;
  std::vector<NodesNearby> nearby_;
};

}  // namespace brio
