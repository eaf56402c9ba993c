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

/// Points in the order of the curve, axis by axis.
struct alignas(64) TreeLeaf {
  double coordinate[3][tree_width];
  int point[tree_width];
};

/// Bounds of up to sixteen leaves or nodes.
struct alignas(64) TreeNode {
  double lower[3][tree_width];
  double upper[3][tree_width];
};

class PointTree {
 public:
  void build(std::span<const Vector3<double>> points, ThreadTeam& team);

  const Bounds& bounds() const { return order_.bounds(); }
  const TreeLeaf& leaf(int number) const { return leaves_[static_cast<std::size_t>(number)]; }

  /// The points inside `box`, in the order of the tree: their indices into `points`, and into `places` 16
  /// times the leaf's number plus the place in the leaf. Stops as soon as there are more than `most`. Returns
  /// how many.
  std::size_t collect(const CaptureBox& box, std::size_t most, std::vector<int>& points,
                      std::vector<int>& places, std::uint64_t& comparisons) const;

 private:
  struct Level {
    std::size_t first_node;  ///< in nodes_
    std::size_t children;    ///< leaves, or nodes of the level below
  };
  void fill_leaves(std::span<const Vector3<double>> points, ThreadTeam& team);
  void add_level(ThreadTeam& team);

  SpatialOrder order_;
  std::vector<TreeLeaf> leaves_;
  std::vector<TreeNode> nodes_;
  std::vector<Level> levels_;   ///< from the leaves up
  std::vector<Bounds> bounds_;  ///< of the leaves, or of the nodes of the level last added
};

/// The points within the common bounds of a group of boxes, in ascending order.
struct PointsNearby {
  std::vector<int> point;
  std::vector<double> coordinate[3];

  std::vector<int> found;  ///< the same points in the order of the tree
  std::vector<int> place;  ///< of a found point in the tree
  std::vector<int> rank;   ///< of a found point among the found
};

class TreeSearch {
 public:
  /// Replace `pairs` by all (box, point) pairs with the point inside the box, and add the work to `counts`.
  /// The same for any number of threads; allocates nothing once as many points, boxes and pairs have been
  /// seen. \throws std::length_error when the pairs cannot be numbered by an int.
  void find(std::span<const Vector3<double>> points, std::span<const CaptureBox> boxes, ThreadTeam& team,
            CandidatePairs& pairs, SearchCounts& counts);

 private:
  void order_boxes(std::span<const CaptureBox> boxes, ThreadTeam& team);
  void find_in_group(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end,
                     PointsNearby& nearby, PairPiece& piece) const;

  PointTree tree_;
  std::vector<Vector3<double>> centres_;  ///< not a number where a box cannot hold any point
  SpatialOrder box_order_;
  std::vector<PairPiece> pieces_;
  std::vector<PointsNearby> nearby_;
};

}  // namespace brio
