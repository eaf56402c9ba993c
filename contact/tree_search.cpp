#include "contact/tree_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "contact/overlap_bits.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

namespace {

constexpr auto width = static_cast<std::size_t>(tree_width);
constexpr std::size_t group_size = 4;              // boxes that descend together
constexpr std::size_t most_of_group = 128;         // nodes nearby beyond which a group is halved
constexpr std::size_t most_ranked_by_count = 256;  // beyond, sorting costs less
constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
constexpr int tests_per_block = 6 * tree_width;

/// The first `count` bits of sixteen.
constexpr unsigned first_bits(std::size_t count) { return count >= width ? 0xffffu : (1u << count) - 1u; }

/// Which of sixteen boxes overlap `box`.
BRIO_INLINE unsigned overlap_bits_of_sixteen(const double (&lower)[3][tree_width],
                                             const double (&upper)[3][tree_width], const BoxLanes& box) {
  unsigned bits = 0;
  for (int half = 0; half < tree_width; half += bits_lanes) {
    const double* const from[3] = {lower[0] + half, lower[1] + half, lower[2] + half};
    const double* const to[3] = {upper[0] + half, upper[1] + half, upper[2] + half};
    bits |= overlap_bits(from, to, box) << half;
  }
  return bits;
}

constexpr CaptureBox everywhere{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};

}  // namespace

void NodeTree::build(const SearchNodes& nodes, ThreadTeam& team) {
  holds_points_ = nodes.are_points();
  lay_centres(nodes, everywhere, team, centres_);
  order_.sort(centres_, team);
  fill_leaves(nodes, team);
  branches_.clear();
  levels_.clear();
  while (bounds_.size() > 1 || (levels_.empty() && !bounds_.empty())) add_level(team);
}

void NodeTree::fill_leaves(const SearchNodes& nodes, ThreadTeam& team) {
  constexpr std::size_t leaves_per_task = 512;
  constexpr CaptureBox nowhere{{infinity, infinity, infinity}, {infinity, infinity, infinity}};
  const std::size_t leaves = (order_.size() + width - 1) / width;
  leaves_.resize(leaves);
  bounds_.resize(leaves);
  team.for_ranges(leaves, leaves_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t l = begin; l < end; ++l) {
      TreeLeaf& leaf = leaves_[l];
      Bounds bounds;
      for (std::size_t i = 0; i < width; ++i) {
        const bool present = l * width + i < order_.size();
        const int node = present ? order_[l * width + i] : 0;
        const CaptureBox range = present ? nodes.range(static_cast<std::size_t>(node)) : nowhere;
        for (int axis = 0; axis < 3; ++axis) {
          leaf.lower[axis][i] = range.lower[axis];
          if (!holds_points_) leaf.upper[axis][i] = range.upper[axis];
        }
        leaf.node[i] = node;
        if (present) bounds.include(range);
      }
      bounds_[l] = bounds;
    }
  });
}

/// Put branches over `bounds_`, and replace these by the bounds of the branches.
void NodeTree::add_level(ThreadTeam& team) {
  constexpr std::size_t branches_per_task = 512;
  const std::size_t children = bounds_.size();
  const std::size_t first = branches_.size();
  const std::size_t added = (children + width - 1) / width;
  branches_.resize(first + added);
  levels_.push_back({first, children});
  team.for_ranges(added, branches_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (std::size_t i = 0; i < width; ++i) {
        const Bounds bounds = n * width + i < children ? bounds_[n * width + i] : Bounds();
        for (int axis = 0; axis < 3; ++axis) {
          branches_[first + n].lower[axis][i] = bounds.lower[axis];
          branches_[first + n].upper[axis][i] = bounds.upper[axis];
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

std::size_t NodeTree::collect(const CaptureBox& box, std::size_t most, std::vector<int>& nodes,
                              std::vector<int>& places, std::uint64_t& comparisons) const {
  struct Block {
    int level;  // -1 for a leaf
    std::size_t number;
  };
  std::array<Block, 10 * width>
      stack;  // fifteen siblings of each ancestor: a tree of 2^31 nodes has 8 levels
  std::size_t waiting = 0;
  std::size_t found = 0;
  if (!levels_.empty()) stack[waiting++] = {static_cast<int>(levels_.size()) - 1, 0};
  const BoxLanes lanes(box);
  while (waiting > 0 && found <= most) {
    const Block block = stack[--waiting];
    comparisons += tests_per_block;
    if (block.level >= 0) {
      const Level& level = levels_[static_cast<std::size_t>(block.level)];
      const TreeBranch& branch = branches_[level.first + block.number];
      unsigned bits = overlap_bits_of_sixteen(branch.lower, branch.upper, lanes) &
                      first_bits(level.children - block.number * width);
      for (; bits != 0; bits &= bits - 1)
        stack[waiting++] = {block.level - 1,
                            block.number * width + static_cast<std::size_t>(__builtin_ctz(bits))};
    } else {
      const TreeLeaf& leaf = leaves_[block.number];
      const unsigned bits =
          overlap_bits_of_sixteen(leaf.lower, holds_points_ ? leaf.lower : leaf.upper, lanes) &
          first_bits(order_.size() - block.number * width);
      if (bits == 0) continue;
      make_room(nodes, found + width + bits_lanes);
      make_room(places, found + width + bits_lanes);
      int place[tree_width];
      std::iota(place, place + tree_width, static_cast<int>(block.number * width));
      for (int half = 0; half < tree_width; half += bits_lanes) {
        const unsigned here = (bits >> half) & 0xffu;
        append_selected(places.data() + found, place + half, here);
        found += static_cast<std::size_t>(append_selected(nodes.data() + found, leaf.node + half, here));
      }
    }
  }
  return found;
}

namespace {

/// Rank of each of `count` different numbers among them.
void rank(const int* numbers, std::size_t count, NodesNearby& nearby) {
  make_room(nearby.rank, count);
  int* ranks = nearby.rank.data();
  if (count <= most_ranked_by_count) {
    std::fill_n(ranks, count, 0);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j) ranks[j] += numbers[i] < numbers[j] ? 1 : 0;
  } else {
    make_room(nearby.node, count);
    int* order = nearby.node.data();
    std::iota(order, order + count, 0);
    std::sort(order, order + count, [&](int a, int b) { return numbers[a] < numbers[b]; });
    for (std::size_t i = 0; i < count; ++i) ranks[order[i]] = static_cast<int>(i);
  }
}

/// Lay out the first `count` nodes found in ascending order.
void lay_out(const NodeTree& tree, std::size_t count, NodesNearby& nearby) {
  rank(nearby.found.data(), count, nearby);
  make_room(nearby.node, count + bits_lanes);
  for (int axis = 0; axis < 3; ++axis) {
    make_room(nearby.lower[axis], count + bits_lanes);
    if (!tree.holds_points()) make_room(nearby.upper[axis], count + bits_lanes);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto to = static_cast<std::size_t>(nearby.rank[i]);
    const int place = nearby.place[i];
    const TreeLeaf& leaf = tree.leaf(place / tree_width);
    nearby.node[to] = nearby.found[i];
    for (int axis = 0; axis < 3; ++axis) {
      nearby.lower[axis][to] = leaf.lower[axis][place % tree_width];
      if (!tree.holds_points()) nearby.upper[axis][to] = leaf.upper[axis][place % tree_width];
    }
  }
}

/// Add the nodes of `nearby`, of which there are `count`, that are in `box`.
void add_nodes_inside(const CaptureBox& box, int box_number, const NodesNearby& nearby, bool points,
                      std::size_t count, PairPiece& piece) {
  const BoxLanes lanes(box);
  int* const target = piece.room(count + bits_lanes);
  const auto& nearby_upper = points ? nearby.lower : nearby.upper;
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += bits_lanes) {
    const double* const lower[3] = {nearby.lower[0].data() + i, nearby.lower[1].data() + i,
                                    nearby.lower[2].data() + i};
    const double* const upper[3] = {nearby_upper[0].data() + i, nearby_upper[1].data() + i,
                                    nearby_upper[2].data() + i};
    const unsigned bits = overlap_bits(lower, upper, lanes) & first_bits(count - i);
    found += static_cast<std::size_t>(append_selected(target + found, nearby.node.data() + i, bits));
  }
  piece.comparisons += 6 * count;
  piece.add(box_number, found);
}

}  // namespace

void TreeSearch::find_in_group(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end,
                               NodesNearby& nearby, PairPiece& piece) const {
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
    add_nodes_inside(boxes[static_cast<std::size_t>(box_order_[i])], box_order_[i], nearby,
                     tree_.holds_points(), count, piece);
}

void TreeSearch::find(const SearchNodes& nodes, std::span<const CaptureBox> boxes, ThreadTeam& team,
                      CandidatePairs& pairs, SearchCounts& counts) {
  build(nodes, team);
  find(boxes, team, pairs, counts);
}

void TreeSearch::find(std::span<const CaptureBox> boxes, ThreadTeam& team, CandidatePairs& pairs,
                      SearchCounts& counts) {
  lay_centres(boxes, tree_.bounds(), team, centres_);
  box_order_.sort(centres_, team);
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
