#include "contact/search/sorted_list_search.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"

namespace brio {

/// The order of the last search is nearly that of this one; std::sort starts from it instead of from an
/// arbitrary one.
void SortedListSearch::sort(const SearchNodes& nodes, int axis) {
  std::vector<int>& order = order_[axis];
  std::vector<int>& rank = rank_[axis];
  rank.resize(nodes.size());
  if (order.size() != left_in_.size() || left_in_.size() != nodes.size())
    order.assign(left_in_.begin(), left_in_.end());
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return nodes.lower(index(a), axis) < nodes.lower(index(b), axis); });
  double width = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto node = index(order[i]);
    rank[node] = static_cast<int>(i);
    width = std::max(width, nodes.are_points() ? 0 : nodes.upper(node, axis) - nodes.lower(node, axis));
  }
  width_[axis] = width == 0 ? 0 : std::nextafter(width, infinity);
}

SortedListSearch::Slab SortedListSearch::slab(int axis, const SearchNodes& nodes, double lower, double upper,
                                              std::uint64_t& comparisons) const {
  const std::vector<int>& order = order_[axis];
  const auto value = [&](int node) { return nodes.lower(index(node), axis); };
  const double lowest = width_[axis] == 0 ? lower : std::nextafter(lower - width_[axis], -infinity);
  const auto begin = std::partition_point(order.begin(), order.end(), [&](int node) {
    ++comparisons;
    return value(node) < lowest;
  });
  const auto end = std::partition_point(begin, order.end(), [&](int node) {
    ++comparisons;
    return value(node) <= upper;
  });
  return {static_cast<int>(begin - order.begin()), static_cast<int>(end - order.begin())};
}

void SortedListSearch::find_in_box(const SearchNodes& nodes, std::span<const CaptureBox> boxes,
                                   std::size_t box, PairPiece& piece) const {
  if (!boxes[box].holds_anything()) return;
  Slab slabs[3];
  int shortest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    slabs[axis] = slab(axis, nodes, boxes[box].lower[axis], boxes[box].upper[axis], piece.comparisons);
    if (slabs[axis].end - slabs[axis].begin < slabs[shortest].end - slabs[shortest].begin) shortest = axis;
  }
  const int second = (shortest + 1) % 3;
  const int third = (shortest + 2) % 3;
  int* const found = piece.room(index(slabs[shortest].end - slabs[shortest].begin));
  std::size_t count = 0;
  for (int position = slabs[shortest].begin; position < slabs[shortest].end; ++position) {
    const int node = order_[shortest][index(position)];
    const auto inside = [&](int axis) {
      const int rank = rank_[axis][index(node)];
      piece.comparisons += 2;
      return rank >= slabs[axis].begin && rank < slabs[axis].end;
    };
    if (!inside(second) || !inside(third)) continue;
    if (!nodes.are_points()) {
      piece.comparisons += 6;
      if (!boxes[box].overlaps(nodes.range(index(node)))) continue;
    }
    found[count++] = node;
  }
  std::sort(found, found + count);
  piece.add(static_cast<int>(box), count);
}

void SortedListSearch::find(const SearchNodes& nodes, std::span<const CaptureBox> boxes, ThreadTeam& team,
                            CandidatePairs& pairs, SearchCounts& counts) {
  left_in_.clear();
  left_in_.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes.range(i).holds_anything()) left_in_.push_back(static_cast<int>(i));
  team.for_each(3, [&](std::size_t axis) { sort(nodes, static_cast<int>(axis)); });
  const std::size_t pieces = piece_count(boxes.size(), 256);
  if (pieces_.size() < pieces) pieces_.resize(pieces);
  team.for_each(pieces, [&](std::size_t p) {
    pieces_[p].clear();
    const std::size_t end = boxes.size() * (p + 1) / pieces;
    for (std::size_t box = boxes.size() * p / pieces; box < end; ++box)
      find_in_box(nodes, boxes, box, pieces_[p]);
  });
  merge({pieces_.data(), pieces}, boxes.size(), team, pairs, counts);
}

}  // namespace brio
