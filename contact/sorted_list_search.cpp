#include "contact/sorted_list_search.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

double coordinate(const Vector3<double>& point, int axis) {
  return axis == 0 ? point.x : axis == 1 ? point.y : point.z;
}

bool is_number(const Vector3<double>& point) {
  return !std::isnan(point.x) && !std::isnan(point.y) && !std::isnan(point.z);
}

}  // namespace

double comparisons_by_pairs(int bodies, int nodes_per_body) {
  const double both = 2.0 * nodes_per_body;
  return static_cast<double>(bodies) * bodies * both * std::log2(both);
}

double comparisons_of_global_search(int bodies, int nodes_per_body) {
  const double all = static_cast<double>(bodies) * nodes_per_body;
  return all * std::log2(all);
}

/// The order of the last search is nearly that of this one, and sorts in about half the time of an arbitrary
/// one.
void SortedListSearch::sort(std::span<const Vector3<double>> points, int axis) {
  std::vector<int>& order = order_[axis];
  std::vector<int>& rank = rank_[axis];
  const auto all_numbers = static_cast<std::size_t>(std::count_if(points.begin(), points.end(), is_number));
  if (rank.size() != points.size() || order.size() != points.size() || all_numbers != points.size()) {
    rank.resize(points.size());
    order.clear();
    order.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      if (is_number(points[i])) order.push_back(static_cast<int>(i));
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return coordinate(points[static_cast<std::size_t>(a)], axis) <
           coordinate(points[static_cast<std::size_t>(b)], axis);
  });
  if (order.size() != points.size()) std::fill(rank.begin(), rank.end(), -1);
  for (std::size_t i = 0; i < order.size(); ++i)
    rank[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
}

SortedListSearch::Slab SortedListSearch::slab(int axis, std::span<const Vector3<double>> points, double lower,
                                              double upper, std::uint64_t& comparisons) const {
  const std::vector<int>& order = order_[axis];
  const auto value = [&](int point) { return coordinate(points[static_cast<std::size_t>(point)], axis); };
  const auto begin = std::partition_point(order.begin(), order.end(), [&](int point) {
    ++comparisons;
    return value(point) < lower;
  });
  const auto end = std::partition_point(begin, order.end(), [&](int point) {
    ++comparisons;
    return value(point) <= upper;
  });
  return {static_cast<int>(begin - order.begin()), static_cast<int>(end - order.begin())};
}

void SortedListSearch::find_in_box(std::span<const Vector3<double>> points, std::span<const CaptureBox> boxes,
                                   std::size_t box, PairPiece& piece) const {
  if (!can_hold_points(boxes[box])) return;
  Slab slabs[3];
  int shortest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    slabs[axis] = slab(axis, points, boxes[box].lower[axis], boxes[box].upper[axis], piece.comparisons);
    if (slabs[axis].end - slabs[axis].begin < slabs[shortest].end - slabs[shortest].begin) shortest = axis;
  }
  const int second = (shortest + 1) % 3;
  const int third = (shortest + 2) % 3;
  int* const found = piece.room(static_cast<std::size_t>(slabs[shortest].end - slabs[shortest].begin));
  std::size_t count = 0;
  for (int position = slabs[shortest].begin; position < slabs[shortest].end; ++position) {
    const int point = order_[shortest][static_cast<std::size_t>(position)];
    const auto inside = [&](int axis) {
      const int rank = rank_[axis][static_cast<std::size_t>(point)];
      piece.comparisons += 2;
      return rank >= slabs[axis].begin && rank < slabs[axis].end;
    };
    if (inside(second) && inside(third)) found[count++] = point;
  }
  std::sort(found, found + count);
  piece.add(static_cast<int>(box), count);
}

void SortedListSearch::find(std::span<const Vector3<double>> points, std::span<const CaptureBox> boxes,
                            ThreadTeam& team, CandidatePairs& pairs, SearchCounts& counts) {
  team.for_each(3, [&](std::size_t axis) { sort(points, static_cast<int>(axis)); });
  const std::size_t pieces = piece_count(boxes.size(), 256);
  if (pieces_.size() < pieces) pieces_.resize(pieces);
  team.for_each(pieces, [&](std::size_t p) {
    pieces_[p].clear();
    const std::size_t end = boxes.size() * (p + 1) / pieces;
    for (std::size_t box = boxes.size() * p / pieces; box < end; ++box)
      find_in_box(points, boxes, box, pieces_[p]);
  });
  merge({pieces_.data(), pieces}, boxes.size(), team, pairs, counts);
}

}  // namespace brio
