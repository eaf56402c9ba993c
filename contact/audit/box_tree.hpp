#pragma once
/// The audit's own search: a tree of bounding boxes over items sorted along a Morton curve.

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#if defined(__AVX__)
#include <immintrin.h>

#include "src/base/index.hpp"
#include "src/base/tensor.hpp"
#endif

namespace brio {

/// Axis-aligned, closed.
struct BoundingBox {
  Vector3d lower{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vector3d upper{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void add(const Vector3d& x) {
    lower = minimum(lower, x);
    upper = maximum(upper, x);
  }
  void add(const BoundingBox& other) {
    lower = minimum(lower, other.lower);
    upper = maximum(upper, other.upper);
  }
  BoundingBox grown(double by) const {
    const Vector3d margin{by, by, by};
    return {lower - margin, upper + margin};
  }
  bool overlaps(const BoundingBox& other) const {
    return lower[0] <= other.upper[0] && other.lower[0] <= upper[0] && lower[1] <= other.upper[1] &&
           other.lower[1] <= upper[1] && lower[2] <= other.upper[2] && other.lower[2] <= upper[2];
  }
  bool holds(const BoundingBox& other) const {
    return minimum(lower, other.lower) == lower && maximum(upper, other.upper) == upper;
  }
  double squared_distance(const Vector3d& x) const {
    return squared_norm(maximum(maximum(lower - x, x - upper), {0, 0, 0}));
  }
};

/// The order of items along the Morton curve through the centres of their boxes, ties by number.
std::vector<int> morton_order(std::span<const BoundingBox> boxes);

/// Over boxes in their given order, which should be that of the curve. Each branch holds the bounds of eight
/// boxes below it, in single precision rounded outwards, so that they are compared at once.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::vector<BoundingBox> boxes);

  const BoundingBox& box(int item) const { return box_[index(item)]; }
  int size() const { return static_cast<int>(box_.size()); }

  /// `visit(item)` for every item from `first` on, ascending, whose box overlaps `box` but for rounding to
  /// single precision.
  template <class Visit>
  void for_overlapping(const BoundingBox& box, int first, const Visit& visit) const {
    if (size() > first) descend(level_.size() - 1, 0, rounded_outwards(box), first, visit);
  }

 private:
  static constexpr int width = 8;
  static constexpr int bits_of_width = 3;

  struct Bounds {
    float lower[3];
    float upper[3];
  };
  using EightFloats = float __attribute__((vector_size(32)));
  using EightInts = std::int32_t __attribute__((vector_size(32)));
  struct alignas(64) Branch {
    EightFloats lower[3];
    EightFloats upper[3];
  };

  static Bounds rounded_outwards(const BoundingBox& box);

  // Bit i: child i overlaps.
  static unsigned overlapping(const Branch& branch, const Bounds& bounds) {
    EightInts hit = (branch.lower[0] <= bounds.upper[0]) & (branch.upper[0] >= bounds.lower[0]);
    for (int axis = 1; axis < 3; ++axis)
      hit &= (branch.lower[axis] <= bounds.upper[axis]) & (branch.upper[axis] >= bounds.lower[axis]);
#if defined(__AVX__)
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(hit)));
#else
    unsigned bits = 0;
    for (int i = 0; i < width; ++i) bits |= (hit[i] != 0 ? 1u : 0u) << i;
    return bits;
#endif
  }

  template <class Visit>
  void descend(std::size_t level, int branch, const Bounds& bounds, int first, const Visit& visit) const {
    // Items below a child: eight to the power of the level.
    const int shift = bits_of_width * static_cast<int>(level);
    for (unsigned bits = overlapping(level_[level][index(branch)], bounds); bits != 0; bits &= bits - 1) {
      const int child = width * branch + std::countr_zero(bits);
      if (((child + 1) << shift) <= first) continue;
      if (level == 0) {
        visit(child);
      } else {
        descend(level - 1, child, bounds, first, visit);
      }
    }
  }

  std::vector<BoundingBox> box_;
  std::vector<std::vector<Branch>> level_;  ///< over the items, then over each level
};

}  // namespace brio
