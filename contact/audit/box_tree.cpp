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
  const double extent = boxes.empty() ? 0 : largest_component(all.upper - all.lower);
  const double scale = extent > 0 ? cells / extent : 0;
  std::vector<std::pair<std::uint64_t, int>> key(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vector3d at = scale * (0.5 * (boxes[i].lower + boxes[i].upper) - all.lower);
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

BoxTree::Bounds BoxTree::rounded_outwards(const BoundingBox& box) {
  constexpr double unit = 0x1p-23;  // twice the relative error of single precision
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lower[axis] = static_cast<float>(box.lower[axis] - unit * std::abs(box.lower[axis]));
    bounds.upper[axis] = static_cast<float>(box.upper[axis] + unit * std::abs(box.upper[axis]));
  }
  return bounds;
}

BoxTree::BoxTree(std::vector<BoundingBox> boxes) : box_(std::move(boxes)) {
  if (box_.empty()) return;
  std::vector<Bounds> below(box_.size());
  for (std::size_t i = 0; i < below.size(); ++i) below[i] = rounded_outwards(box_[i]);
  do {
    const std::size_t count = (below.size() + width - 1) / width;
    std::vector<Branch>& branches = level_.emplace_back(count);
    std::vector<Bounds> all(count);
    for (std::size_t b = 0; b < count; ++b)
      for (int axis = 0; axis < 3; ++axis) {
        float lower = HUGE_VALF, upper = -HUGE_VALF;
        for (std::size_t i = 0; i < width; ++i) {
          const std::size_t child = width * b + i;
          const bool known = child < below.size();
          branches[b].lower[axis][i] = known ? below[child].lower[axis] : HUGE_VALF;
          branches[b].upper[axis][i] = known ? below[child].upper[axis] : -HUGE_VALF;
          lower = std::min(lower, branches[b].lower[axis][i]);
          upper = std::max(upper, branches[b].upper[axis][i]);
        }
        all[b].lower[axis] = lower;
        all[b].upper[axis] = upper;
      }
    below = std::move(all);
  } while (below.size() > 1);
}

}  // namespace brio
