#include "contact/tree_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "contact/inside_bits.hpp"

namespace brio {

namespace {

constexpr auto width = static_cast<std::size_t>(tree_width);
constexpr std::size_t group_size = 8;              // boxes that descend together
constexpr std::size_t most_of_group = 512;         // points nearby beyond which a group is halved
constexpr std::size_t most_ranked_by_count = 256;  // beyond, sorting costs less
constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int tests_per_block = 6 * tree_width;

/// The first `count` bits of sixteen.
constexpr unsigned first_bits(std::size_t count) { return count >= width ? 0xffffu : (1u << count) - 1u; }

unsigned overlap_bits(const TreeNode& node, const BoxLanes& box) {
  unsigned bits = 0;
  for (int half = 0; half < tree_width; half += bits_lanes) {
    const double* const lower[3] = {node.lower[0] + half, node.lower[1] + half, node.lower[2] + half};
    const double* const upper[3] = {node.upper[0] + half, node.upper[1] + half, node.upper[2] + half};
    bits |= overlap_bits(lower, upper, box) << half;
  }
  return bits;
}

unsigned inside_bits(const TreeLeaf& leaf, const BoxLanes& box) {
  unsigned bits = 0;
  for (int half = 0; half < tree_width; half += bits_lanes) {
    const double* const coordinate[3] = {leaf.coordinate[0] + half, leaf.coordinate[1] + half,
                                         leaf.coordinate[2] + half};
    bits |= inside_bits(coordinate, box) << half;
  }
  return bits;
}

}  // namespace

void PointTree::build(std::span<const Vector3<double>> points, ThreadTeam& team) {
  order_.sort(points, team);
  fill_leaves(points, team);
  nodes_.clear();
  levels_.clear();
  while (bounds_.size() > 1 || (levels_.empty() && !bounds_.empty())) add_level(team);
}

void PointTree::fill_leaves(std::span<const Vector3<double>> points, ThreadTeam& team) {
  constexpr std::size_t leaves_per_task = 512;
  const std::size_t leaves = (order_.size() + width - 1) / width;
  leaves_.resize(leaves);
  bounds_.resize(leaves);
  team.for_ranges(leaves, leaves_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t l = begin; l < end; ++l) {
      TreeLeaf& leaf = leaves_[l];
      Bounds bounds;
      for (std::size_t i = 0; i < width; ++i) {
        const bool present = l * width + i < order_.size();
        const int index = present ? order_[l * width + i] : 0;
        const Vector3<double> p =
            present ? points[static_cast<std::size_t>(index)] : Vector3<double>{infinity, infinity, infinity};
        leaf.coordinate[0][i] = p.x;
        leaf.coordinate[1][i] = p.y;
        leaf.coordinate[2][i] = p.z;
        leaf.point[i] = index;
        if (present) bounds.include(p);
      }
      bounds_[l] = bounds;
    }
  });
}

/// Put nodes over `bounds_`, and replace these by the bounds of the nodes.
void PointTree::add_level(ThreadTeam& team) {
  constexpr std::size_t nodes_per_task = 512;
  const std::size_t children = bounds_.size();
  const std::size_t first = nodes_.size();
  const std::size_t added = (children + width - 1) / width;
  nodes_.resize(first + added);
  levels_.push_back({first, children});
  team.for_ranges(added, nodes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (std::size_t i = 0; i < width; ++i) {
        const Bounds bounds = n * width + i < children ? bounds_[n * width + i] : Bounds();
        for (int axis = 0; axis < 3; ++axis) {
          nodes_[first + n].lower[axis][i] = bounds.lower[axis];
          nodes_[first + n].upper[axis][i] = bounds.upper[axis];
        }
      }
  });
  for (std::size_t n = 0; n < added; ++n) {
    Bounds bounds;
    for (std::size_t i = n * width; i < std::min(children, (n + 1) * width); ++i) bounds.include(bounds_[i]);
    bounds_[n] = bounds;
  }
  bounds_.resize(added);
}

std::size_t PointTree::collect(const CaptureBox& box, std::size_t most, std::vector<int>& points,
                               std::vector<int>& places, std::uint64_t& comparisons) const {
  struct Block {
    int level;  // -1 for a leaf
    std::size_t number;
  };
  std::array<Block, 10 * width>
      stack;  // fifteen siblings of each ancestor: a tree of 2^31 points has 8 levels
  std::size_t waiting = 0;
  std::size_t found = 0;
  if (!levels_.empty()) stack[waiting++] = {static_cast<int>(levels_.size()) - 1, 0};
  const BoxLanes lanes(box);
  while (waiting > 0 && found <= most) {
    const Block block = stack[--waiting];
    comparisons += tests_per_block;
    if (block.level >= 0) {
      const Level& level = levels_[static_cast<std::size_t>(block.level)];
      unsigned bits = overlap_bits(nodes_[level.first_node + block.number], lanes) &
                      first_bits(level.children - block.number * width);
      for (; bits != 0; bits &= bits - 1)
        stack[waiting++] = {block.level - 1,
                            block.number * width + static_cast<std::size_t>(__builtin_ctz(bits))};
    } else {
      const TreeLeaf& leaf = leaves_[block.number];
      const unsigned bits = inside_bits(leaf, lanes) & first_bits(order_.size() - block.number * width);
      if (bits == 0) continue;
      make_room(points, found + width + bits_lanes);
      make_room(places, found + width + bits_lanes);
      int place[tree_width];
      std::iota(place, place + tree_width, static_cast<int>(block.number * width));
      for (int half = 0; half < tree_width; half += bits_lanes) {
        const unsigned here = (bits >> half) & 0xffu;
        append_selected(places.data() + found, place + half, here);
        found += static_cast<std::size_t>(append_selected(points.data() + found, leaf.point + half, here));
      }
    }
  }
  return found;
}

namespace {

/// Rank of each of `count` different numbers among them.
void rank(const int* numbers, std::size_t count, PointsNearby& nearby) {
  make_room(nearby.rank, count);
  int* ranks = nearby.rank.data();
  if (count <= most_ranked_by_count) {
    std::fill_n(ranks, count, 0);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j) ranks[j] += numbers[i] < numbers[j] ? 1 : 0;
  } else {
    make_room(nearby.point, count);
    int* order = nearby.point.data();
    std::iota(order, order + count, 0);
    std::sort(order, order + count, [&](int a, int b) { return numbers[a] < numbers[b]; });
    for (std::size_t i = 0; i < count; ++i) ranks[order[i]] = static_cast<int>(i);
  }
}

/// Lay out the first `count` points found in ascending order.
void lay_out(const PointTree& tree, std::size_t count, PointsNearby& nearby) {
  rank(nearby.found.data(), count, nearby);
  make_room(nearby.point, count + bits_lanes);
  for (auto& coordinate : nearby.coordinate) make_room(coordinate, count + bits_lanes);
  for (std::size_t i = 0; i < count; ++i) {
    const auto to = static_cast<std::size_t>(nearby.rank[i]);
    const int place = nearby.place[i];
    const TreeLeaf& leaf = tree.leaf(place / tree_width);
    nearby.point[to] = nearby.found[i];
    for (int axis = 0; axis < 3; ++axis)
      nearby.coordinate[axis][to] = leaf.coordinate[axis][place % tree_width];
  }
}

/// Add the points of `nearby`, of which there are `count`, that lie inside `box`.
void add_points_inside(const CaptureBox& box, int box_number, const PointsNearby& nearby, std::size_t count,
                       PairPiece& piece) {
  const BoxLanes lanes(box);
  int* const target = piece.room(count + bits_lanes);
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += bits_lanes) {
    const double* const coordinate[3] = {nearby.coordinate[0].data() + i, nearby.coordinate[1].data() + i,
                                         nearby.coordinate[2].data() + i};
    const unsigned bits = inside_bits(coordinate, lanes) & first_bits(count - i);
    found += static_cast<std::size_t>(append_selected(target + found, nearby.point.data() + i, bits));
  }
  piece.comparisons += 6 * count;
  piece.add(box_number, found);
}

}  // namespace

void TreeSearch::find_in_group(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end,
                               PointsNearby& nearby, PairPiece& piece) const {
  Bounds bounds;
  for (std::size_t i = begin; i < end; ++i) bounds.include(boxes[static_cast<std::size_t>(box_order_[i])]);
  const std::size_t most = end - begin > 1 ? most_of_group : no_limit;
  const std::size_t count = tree_.collect(bounds, most, nearby.found, nearby.place, piece.comparisons);
  if (count > most) {
    const std::size_t middle = begin + (end - begin) / 2;
    find_in_group(boxes, begin, middle, nearby, piece);
    find_in_group(boxes, middle, end, nearby, piece);
    return;
  }
  lay_out(tree_, count, nearby);
  for (std::size_t i = begin; i < end; ++i)
    add_points_inside(boxes[static_cast<std::size_t>(box_order_[i])], box_order_[i], nearby, count, piece);
}

/// Lay the boxes that can hold a point along a curve, by the centre of what they share with the points'
/// bounds.
void TreeSearch::order_boxes(std::span<const CaptureBox> boxes, ThreadTeam& team) {
  constexpr std::size_t boxes_per_task = 8192;
  constexpr double far = std::numeric_limits<double>::max() / 4;
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const Bounds& bounds = tree_.bounds();
  centres_.resize(boxes.size());
  team.for_ranges(boxes.size(), boxes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      double centre[3];
      for (int axis = 0; axis < 3; ++axis) {
        const double lower = boxes[b].lower[axis];
        const double upper = boxes[b].upper[axis];
        const bool possible =
            std::islessequal(lower, upper) && lower <= bounds.upper[axis] && upper >= bounds.lower[axis];
        centre[axis] = possible ? 0.5 * std::clamp(std::max(lower, bounds.lower[axis]), -far, far) +
                                      0.5 * std::clamp(std::min(upper, bounds.upper[axis]), -far, far)
                                : not_a_number;
      }
      centres_[b] = {centre[0], centre[1], centre[2]};
    }
  });
  box_order_.sort(centres_, team);
}

void TreeSearch::find(std::span<const Vector3<double>> points, std::span<const CaptureBox> boxes,
                      ThreadTeam& team, CandidatePairs& pairs, SearchCounts& counts) {
  tree_.build(points, team);
  order_boxes(boxes, team);
  const std::size_t groups = (box_order_.size() + group_size - 1) / group_size;
  const std::size_t tasks = piece_count(groups, 16);
  if (pieces_.size() < tasks) pieces_.resize(tasks);
  if (nearby_.size() < tasks) nearby_.resize(tasks);
  team.for_each(tasks, [&](std::size_t task) {
    pieces_[task].clear();
    for (std::size_t group = groups * task / tasks; group < groups * (task + 1) / tasks; ++group)
      find_in_group(boxes, group * group_size, std::min(box_order_.size(), (group + 1) * group_size),
                    nearby_[task], pieces_[task]);
  });
  merge({pieces_.data(), tasks}, boxes.size(), team, pairs, counts);
}

}  // namespace brio
