#include "contact/search/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "src/base/index.hpp"

namespace brio {

namespace {

using Entry = std::uint64_t;

constexpr int bits_per_axis = 10;
constexpr int last_cell = (1 << bits_per_axis) - 1;
constexpr std::uint32_t no_cell = std::uint32_t{1} << (3 * bits_per_axis);  // behind every cell
constexpr std::size_t crowd = 32;             // positions in a cell that are worth a finer curve
constexpr std::size_t smallest_slice = 8192;  // positions worth a task of their own
constexpr std::size_t fewest_for_radix = 2048;

constexpr int digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;
constexpr std::array<int, 3> digit_shift = {32, 32 + digit_bits, 32 + 2 * digit_bits};

constexpr std::size_t digit(Entry entry, int shift) { return index(entry >> shift) & (digits - 1); }

constexpr std::uint32_t key_of(Entry entry) { return static_cast<std::uint32_t>(entry >> 32); }

bool is_number(const Vector3d& p) { return !std::isnan(p.x) && !std::isnan(p.y) && !std::isnan(p.z); }

/// Two zeros after each of ten bits.
constexpr std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  return (x | (x << 2)) & 0x09249249u;
}

/// The cubic cells of a curve that covers a box.
struct Cells {
  double origin[3];
  double per_length = 0;

  explicit Cells(const CaptureBox& covered) {
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = covered.lower[axis];
      if (covered.upper[axis] > covered.lower[axis])
        extent = std::max(extent, covered.upper[axis] - origin[axis]);
    }
    constexpr double smallest_extent = 4 * (last_cell + 1) * std::numeric_limits<double>::min();
    if (extent > smallest_extent) per_length = (last_cell + 1) / extent;
  }

  std::uint32_t cell(double coordinate, int axis) const {
    return static_cast<std::uint32_t>(
        std::min(static_cast<int>((coordinate - origin[axis]) * per_length), last_cell));
  }
  std::uint32_t key(const Vector3d& p) const {
    return spread(cell(p.x, 0)) | spread(cell(p.y, 1)) << 1 | spread(cell(p.z, 2)) << 2;
  }
};

/// Stable sort of `entries` by key; `scratch` holds as many.
void radix_sort(Entry* entries, Entry* scratch, std::size_t count) {
  std::array<std::array<std::uint32_t, digits>, digit_shift.size()> next{};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t pass = 0; pass < next.size(); ++pass) ++next[pass][digit(entries[i], digit_shift[pass])];
  Entry* from = entries;
  Entry* to = scratch;
  for (std::size_t pass = 0; pass < next.size(); ++pass) {
    std::uint32_t place = 0;
    for (std::uint32_t& count_then_place : next[pass]) place += std::exchange(count_then_place, place);
    for (std::size_t i = 0; i < count; ++i) to[next[pass][digit(from[i], digit_shift[pass])]++] = from[i];
    std::swap(from, to);
  }
  std::copy_n(from, count, entries);
}

}  // namespace

void lay_centres(const SearchNodes& boxes, const CaptureBox& within, ThreadTeam& team,
                 std::vector<Vector3d>& centres) {
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  centres.resize(boxes.size());
  team.for_ranges(boxes.size(), smallest_slice, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const CaptureBox box = boxes.range(b);
      Vector3d centre{not_a_number, not_a_number, not_a_number};
      if (box.holds_anything() && box.overlaps(within))
        for (int axis = 0; axis < 3; ++axis)
          centre[axis] = 0.5 * std::clamp(std::max(box.lower[axis], within.lower[axis]), -farthest_coordinate,
                                          farthest_coordinate) +
                         0.5 * std::clamp(std::min(box.upper[axis], within.upper[axis]), -farthest_coordinate,
                                          farthest_coordinate);
      centres[b] = centre;
    }
  });
}

void SpatialOrder::sort(std::span<const Vector3d> positions, ThreadTeam& team) {
  const std::size_t count = positions.size();
  entries_.resize(count);
  scratch_.resize(count);
  const std::size_t slices = (count + smallest_slice - 1) / smallest_slice;
  slice_bounds_.assign(slices, empty_box);
  team.for_each(slices, [&](std::size_t s) {
    CaptureBox bounds = empty_box;
    const std::size_t end = std::min(count, (s + 1) * smallest_slice);
    for (std::size_t i = s * smallest_slice; i < end; ++i)
      if (is_number(positions[i])) bounds.include(positions[i]);
    slice_bounds_[s] = bounds;
  });
  CaptureBox bounds = empty_box;
  for (const CaptureBox& slice : slice_bounds_) bounds.include(slice);

  const Cells cells(bounds);
  team.for_ranges(count, smallest_slice, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t key = is_number(positions[i]) ? cells.key(positions[i]) : no_cell;
      entries_[i] = Entry{key} << 32 | i;
    }
  });
  sort_by_key(count, team);
  size_ = count;
  while (size_ > 0 && key_of(entries_[size_ - 1]) == no_cell) --size_;
  refine_crowded_cells(positions, 0, size_);
}

/// Radix sort, stable; slices of the list are counted and moved by separate tasks.
void SpatialOrder::sort_by_key(std::size_t count, ThreadTeam& team) {
  const std::size_t most_slices = team.size() == 1 ? 1 : 4 * index(team.size());
  const std::size_t slices = std::clamp<std::size_t>(count / smallest_slice, 1, most_slices);
  histogram_.resize(slices * digits);
  for (const int shift : digit_shift) {
    team.for_each(slices, [&](std::size_t s) {
      std::uint32_t* histogram = histogram_.data() + s * digits;
      std::fill_n(histogram, digits, 0u);
      for (std::size_t i = count * s / slices; i < count * (s + 1) / slices; ++i)
        ++histogram[digit(entries_[i], shift)];
    });
    std::uint32_t place = 0;
    for (std::size_t d = 0; d < digits; ++d)
      for (std::size_t s = 0; s < slices; ++s) {
        const std::uint32_t here = histogram_[s * digits + d];
        histogram_[s * digits + d] = place;
        place += here;
      }
    team.for_each(slices, [&](std::size_t s) {
      std::uint32_t* next = histogram_.data() + s * digits;
      for (std::size_t i = count * s / slices; i < count * (s + 1) / slices; ++i)
        scratch_[next[digit(entries_[i], shift)]++] = entries_[i];
    });
    entries_.swap(scratch_);
  }
}

void SpatialOrder::refine_crowded_cells(std::span<const Vector3d> positions, std::size_t begin,
                                        std::size_t end) {
  for (std::size_t first = begin; first < end;) {
    std::size_t last = first + 1;
    while (last < end && key_of(entries_[last]) == key_of(entries_[first])) ++last;
    if (last - first > crowd) refine(positions, first, last);
    first = last;
  }
}

/// Order the positions of one cell by a curve of their own bounds, and so on. It ends: where the bounds have
/// an extent, their opposite sides fall in different cells.
void SpatialOrder::refine(std::span<const Vector3d> positions, std::size_t begin, std::size_t end) {
  CaptureBox bounds = empty_box;
  for (std::size_t i = begin; i < end; ++i)
    bounds.include(positions[static_cast<std::uint32_t>(entries_[i])]);
  const Cells cells(bounds);
  bool divided = false;
  for (std::size_t i = begin; i < end; ++i) {
    const auto index = static_cast<std::uint32_t>(entries_[i]);
    entries_[i] = Entry{cells.key(positions[index])} << 32 | index;
    divided = divided || key_of(entries_[i]) != key_of(entries_[begin]);
  }
  if (!divided) return;
  if (end - begin < fewest_for_radix) {
    std::sort(entries_.data() + begin, entries_.data() + end);
  } else {
    radix_sort(entries_.data() + begin, scratch_.data() + begin, end - begin);
  }
  refine_crowded_cells(positions, begin, end);
}

}  // namespace brio
