#pragma once
/// Search by a tree. The points are laid along a space-filling curve and cut into leaves of 16, sixteen
/// leaves or nodes to a node. The boxes are laid along a curve too; 16 neighbours at a time descend together
/// by their common bounds, and each of them then tests only the few points found. The cost grows like n log
/// n.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/pair_pieces.hpp"
#include "contact/search.hpp"
#include "contact/spatial_order.hpp"
#include "src/base/aligned.hpp"

namespace brio {

inline constexpr int tree_width = 16;

/// Nodes in the order of the curve: where each may be. Of points only the lower bounds are filled in.
struct alignas(64) TreeLeaf {
  double lower[3][tree_width];
  double upper[3][tree_width];
  int node[tree_width];
};

/// Bounds of up to sixteen leaves or branches.
struct alignas(64) TreeBranch {
  double lower[3][tree_width];
  double upper[3][tree_width];
};

class NodeTree {
 public:
  void build(const SearchNodes& nodes, ThreadTeam& team);

  /// Of all nodes; holds nothing where there is none.
  Bounds bounds() const { return bounds_.empty() ? Bounds() : bounds_.front(); }
  bool holds_points() const { return holds_points_; }
  const TreeLeaf& leaf(int number) const { return leaves_[static_cast<std::size_t>(number)]; }

  /// The nodes inside `box`, in the order of the tree, and into `places` 16 times the leaf's number plus the
  /// place in the leaf. Stops as soon as there are more than `most`. Returns how many.
  std::size_t collect(const CaptureBox& box, std::size_t most, std::vector<int>& nodes,
                      std::vector<int>& places, std::uint64_t& comparisons) const;

 private:
  struct Level {
    std::size_t first;     ///< in branches_
    std::size_t children;  ///< leaves, or branches of the level below
  };
  void fill_leaves(const SearchNodes& nodes, ThreadTeam& team);
  void add_level(ThreadTeam& team);

  std::vector<Vector3<double>> centres_;
  SpatialOrder order_;
  bool holds_points_ = true;
  std::vector<TreeLeaf> leaves_;
  std::vector<TreeBranch> branches_;
  std::vector<Level> levels_;   ///< from the leaves up
  std::vector<Bounds> bounds_;  ///< of the leaves, or of the branches of the level last added
};

/// The nodes within the common bounds of a group of boxes, in ascending order.
struct NodesNearby {
  std::vector<int> node;
  std::vector<double> lower[3];
  std::vector<double> upper[3];  ///< empty for points

  std::vector<int> found;  ///< the same nodes in the order of the tree
  std::vector<int> place;  ///< of a found node in the tree
  std::vector<int> rank;   ///< of a found node among the found
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

 private:
  void find_in_group(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end,
                     NodesNearby& nearby, PairPiece& piece) const;

  NodeTree tree_;
  std::vector<Vector3<double>> centres_;
  SpatialOrder box_order_;
  std::vector<PairPiece> pieces_;
  std::vector<NodesNearby> nearby_;
};

}  // namespace brio
