#pragma once
/// Positions in the order of a Z-shaped space-filling curve (Morton 1966), so that neighbours in the list are
/// neighbours in space.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "contact/search/search.hpp"

namespace brio {

/// What stands farther out is taken to stand here: sums and differences of coordinates stay numbers.
inline constexpr double farthest_coordinate = std::numeric_limits<double>::max() / 4;

/// Centres of what the boxes share with `within`: not a number where they share nothing, and of infinite
/// boxes somewhere inside.
void lay_centres(const SearchNodes& boxes, const CaptureBox& within, ThreadTeam& team,
                 std::vector<Vector3d>& centres);

class SpatialOrder {
 public:
  /// Order the indices of `positions`, which are finite (at most a quarter of the largest number), leaving
  /// out those with a coordinate that is not a number. Where the curve's cells hold many positions they are
  /// ordered among themselves by a finer curve, so that a few positions far away do not blur the order of the
  /// others. Positions of the same cell of the finest curve stand in ascending order.
  void sort(std::span<const Vector3d> positions, ThreadTeam& team);

  std::size_t size() const { return size_; }
  int operator[](std::size_t place) const { return static_cast<int>(entries_[place] & 0xffffffffu); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(size_, entries_);
  }

 private:
  void sort_by_key(std::size_t count, ThreadTeam& team);
  void refine(std::span<const Vector3d> positions, std::size_t begin, std::size_t end);
  void refine_crowded_cells(std::span<const Vector3d> positions, std::size_t begin, std::size_t end);

  std::size_t size_ = 0;
  std::vector<std::uint64_t> entries_;  ///< key of the curve in the upper half, index in the lower
  std::vector<std::uint64_t> scratch_;
  std::vector<std::uint32_t> histogram_;
  std::vector<CaptureBox> slice_bounds_;
};

}  // namespace brio
