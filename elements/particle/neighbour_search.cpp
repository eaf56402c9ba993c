#include "elements/particle/neighbour_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "src/base/index.hpp"
#include "src/base/lanes.hpp"

namespace brio {

namespace {

using Number = Lanes<double>;
constexpr std::size_t width = lane_count<double>;
constexpr std::size_t points_per_task = 256;
/// Cells on either side of a point's that its neighbours lie in.
constexpr int cells_aside = 2;
/// Along an axis, beyond which cells grow: their numbers fit into 63 bits.
constexpr double most_cells = 1 << 20;

/// Also one whose motion has broken down, which the time step will say.
bool is_left_out(const ReachingPoint& point) {
  const double* x = point.position;
  return !(point.reach >= 0 && std::isfinite(x[0] + x[1] + x[2]));
}

Number load(const double* first) {
  Number lanes;
  std::memcpy(&lanes.v, first, sizeof lanes.v);
  return lanes;
}

}  // namespace

/// Sorted points in rows of five cells around a cell; moves on with the cell.
class NeighbourSearch::Ranges {
 public:
  struct Range {
    std::size_t begin, end;
  };

  Ranges(const std::vector<Cell>& cells, std::int64_t row, std::int64_t layer, std::int64_t first_cell)
      : cells_(cells) {
    std::size_t r = 0;
    for (int z = -cells_aside; z <= cells_aside; ++z)
      for (int y = -cells_aside; y <= cells_aside; ++y, ++r) {
        offset_[r] = z * layer + y * row;
        const auto is_before = [](const Cell& cell, std::int64_t number) { return cell.number < number; };
        const auto at =
            std::lower_bound(cells.begin(), cells.end(), first_cell + offset_[r] - cells_aside, is_before);
        const auto where = static_cast<std::size_t>(at - cells.begin());
        range_[r] = {where, where};
      }
  }
  /// \param cell not before the last one
  void move_to(std::int64_t cell) {
    for (std::size_t r = 0; r < range_.size(); ++r) {
      auto& [begin, end] = range_[r];
      const std::int64_t middle = cell + offset_[r];
      while (begin < cells_.size() && cells_[begin].number < middle - cells_aside) ++begin;
      end = std::max(begin, end);
      while (end < cells_.size() && cells_[end].number <= middle + cells_aside) ++end;
    }
  }
  const std::array<Range, 25>& all() const { return range_; }
  std::size_t size() const {
    std::size_t sum = 0;
    for (const Range& range : range_) sum += range.end - range.begin;
    return sum;
  }

 private:
  const std::vector<Cell>& cells_;
  std::array<std::int64_t, 25> offset_;
  std::array<Range, 25> range_;
};

void NeighbourSearch::sort_by_cells(std::span<const ReachingPoint> points) {
  double lower[3], upper[3], largest = 0;
  std::fill_n(lower, 3, HUGE_VAL);
  std::fill_n(upper, 3, -HUGE_VAL);
  for (const ReachingPoint& point : points) {
    if (is_left_out(point)) continue;
    largest = std::max(largest, point.reach);
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], point.position[axis]);
      upper[axis] = std::max(upper[axis], point.position[axis]);
    }
  }
  // Half of the largest reach of a pair, and a little more for what rounding does to numbers of cells.
  double edge = largest * (1 + 1e-9);
  for (int axis = 0; axis < 3; ++axis) edge = std::max(edge, (upper[axis] - lower[axis]) / most_cells);
  std::int64_t count[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = edge > 0 && upper[axis] > lower[axis] ? (upper[axis] - lower[axis]) / edge : 0;
    count[axis] = static_cast<std::int64_t>(cells) + 1 + 2 * cells_aside;
  }
  row_ = count[0];
  layer_ = count[0] * count[1];
  cells_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_left_out(points[i])) continue;
    std::int64_t at[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double cells = edge > 0 ? (points[i].position[axis] - lower[axis]) / edge : 0;
      at[axis] = static_cast<std::int64_t>(cells) + cells_aside;
    }
    cells_.push_back({at[0] + row_ * at[1] + layer_ * at[2], static_cast<int>(i)});
  }
  std::sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) {
    return a.number != b.number ? a.number < b.number : a.point < b.point;
  });
  for (std::vector<double>* of : {&x_, &y_, &z_, &reach_}) of->assign(cells_.size() + width, 0);
  for (std::size_t p = 0; p < cells_.size(); ++p) {
    const ReachingPoint& point = points[index(cells_[p].point)];
    x_[p] = point.position[0], y_[p] = point.position[1], z_[p] = point.position[2];
    reach_[p] = point.reach;
  }
}

void NeighbourSearch::find_of_range(std::size_t begin, std::size_t end, List& list) {
  Ranges ranges(cells_, row_, layer_, cells_[begin].number);
  list.used = 0;
  std::size_t candidates = 0;
  for (std::size_t p = begin; p < end; ++p) {
    if (p == begin || cells_[p].number != cells_[p - 1].number) {
      ranges.move_to(cells_[p].number);
      candidates = ranges.size();
    }
    if (list.neighbour.size() < list.used + candidates) list.neighbour.resize(2 * (list.used + candidates));
    int* next = list.neighbour.data() + list.used;
    const Number x(x_[p]), y(y_[p]), z(z_[p]), reach(reach_[p]);
    for (const auto& [first, last] : ranges.all())
      for (std::size_t q = first; q < last; q += width) {
        const Number dx = load(&x_[q]) - x, dy = load(&y_[q]) - y, dz = load(&z_[q]) - z;
        const auto is_near = dx * dx + dy * dy + dz * dz < square(load(&reach_[q]) + reach);
        unsigned bits = bits_of_lanes(is_near.v);
        if (last - q < width) bits &= (1U << (last - q)) - 1;
        if (p - q < width) bits &= ~(1U << (p - q));
        for (; bits != 0; bits &= bits - 1) *next++ = cells_[q + index(__builtin_ctz(bits))].point;
      }
    Place& place = place_[index(cells_[p].point)];
    place.first = list.used;
    place.count = static_cast<int>(next - (list.neighbour.data() + list.used));
    list.used += index(place.count);
  }
}

void NeighbourSearch::find(std::span<const ReachingPoint> points, ThreadTeam& team) {
  sort_by_cells(points);
  place_.assign(points.size(), {});
  const std::size_t tasks = (cells_.size() + points_per_task - 1) / points_per_task;
  if (lists_.size() < tasks || lists_.empty()) lists_.resize(std::max<std::size_t>(tasks, 1));
  for (std::size_t p = 0; p < cells_.size(); ++p)
    place_[index(cells_[p].point)].list = static_cast<std::uint32_t>(p / points_per_task);
  team.for_ranges(cells_.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
    find_of_range(begin, end, lists_[begin / points_per_task]);
  });
}

}  // namespace brio
