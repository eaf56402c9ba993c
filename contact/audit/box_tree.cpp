#include "contact/audit/box_tree.hpp"

#include <algorithm>
#include <utility>

namespace brio {

namespace {

constexpr int bits_of_axis = 21;

// The lowest 21 bits, two zeros after each.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<int> morton_order(std::span<const BoundingBox> boxes) {
  BoundingBox all;
  for (const BoundingBox& box : boxes) all.add(0.5 * (box.lower + box.upper));
  constexpr double cells = (1 << bits_of_axis) - 1;
  const double extent = boxes.empty() ? 0 : (all.upper - all.lower).maxCoeff();
  const double scale = extent > 0 ? cells / extent : 0;
  std::vector<std::pair<std::uint64_t, int>> key(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Eigen::Vector3d at = scale * (0.5 * (boxes[i].lower + boxes[i].upper) - all.lower);
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis)
      code |= spread(static_cast<std::uint64_t>(std::clamp(at[axis], 0.0, cells))) << axis;
    key[i] = {code, static_cast<int>(i)};
  }
  std::sort(key.begin(), key.end());
  std::vector<int> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = key[i].second;
  return order;
}

BoxTree::BoxTree(std::vector<BoundingBox> boxes) {
  if (boxes.empty()) return;
  level_.push_back(std::move(boxes));
  while (level_.back().size() > width) {
    const std::vector<BoundingBox>& below = level_.back();
    std::vector<BoundingBox> branches((below.size() + width - 1) / width);
    for (std::size_t i = 0; i < below.size(); ++i) branches[i / width].add(below[i]);
    level_.push_back(std::move(branches));
  }
}

}  // namespace brio
