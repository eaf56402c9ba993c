#pragma once
/// The audit's own search: a tree of bounding boxes over items sorted along a Morton curve.

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

namespace brio {

/// Axis-aligned, closed.
struct BoundingBox {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(HUGE_VAL);
  Eigen::Vector3d upper = Eigen::Vector3d::Constant(-HUGE_VAL);

  void add(const Eigen::Vector3d& x) {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  void add(const BoundingBox& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  BoundingBox grown(double by) const { return {lower.array() - by, upper.array() + by}; }
  bool overlaps(const BoundingBox& other) const {
    return lower[0] <= other.upper[0] && other.lower[0] <= upper[0] && lower[1] <= other.upper[1] &&
           other.lower[1] <= upper[1] && lower[2] <= other.upper[2] && other.lower[2] <= upper[2];
  }
  bool holds(const BoundingBox& other) const {
    return (lower.array() <= other.lower.array()).all() && (other.upper.array() <= upper.array()).all();
  }
  double squared_distance(const Eigen::Vector3d& x) const {
    return (lower - x).cwiseMax(x - upper).cwiseMax(0.0).squaredNorm();
  }
};

/// The order of items along the Morton curve through the centres of their boxes, ties by number.
std::vector<int> morton_order(std::span<const BoundingBox> boxes);

/// Over boxes in their given order, which should be that of the curve. Each branch holds four.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::vector<BoundingBox> boxes);

  const BoundingBox& box(int item) const { return level_[0][static_cast<std::size_t>(item)]; }
  int size() const { return level_.empty() ? 0 : static_cast<int>(level_[0].size()); }

  /// `visit(item)` for every item from `first` on, ascending, whose box overlaps `box`.
  template <class Visit>
  void for_overlapping(const BoundingBox& box, int first, const Visit& visit) const {
    if (size() > first) descend(level_.size() - 1, 0, box, first, visit);
  }

 private:
  static constexpr int width = 4;

  template <class Visit>
  void descend(std::size_t level, int begin, const BoundingBox& box, int first, const Visit& visit) const {
    const auto& boxes = level_[level];
    const int shift = 2 * static_cast<int>(level);  // items of a box of the level: four to its power
    const int end =
        begin + width < static_cast<int>(boxes.size()) ? begin + width : static_cast<int>(boxes.size());
    for (int i = begin; i < end; ++i) {
      if (((i + 1) << shift) <= first || !boxes[static_cast<std::size_t>(i)].overlaps(box)) continue;
      if (level == 0) {
        visit(i);
      } else {
        descend(level - 1, width * i, box, first, visit);
      }
    }
  }

  std::vector<std::vector<BoundingBox>> level_;  ///< items, then the branches over each level
};

}  // namespace brio
