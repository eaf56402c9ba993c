#include "contact/search/tree_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "contact/search/overlap_bits.hpp"
#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr auto width = index(tree_width);
constexpr std::size_t group_size = 4;                 // boxes that descend together
constexpr std::size_t bundle_size = 16 * group_size;  // boxes whose groups begin at the same branches
constexpr std::size_t most_branches = 16;             // of a bundle, that give way to those below
constexpr std::size_t most_of_group = 128;            // nodes nearby beyond which a group is halved
constexpr std::size_t most_ranked_by_count = 256;     // beyond, sorting costs less
constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
constexpr int tests_per_block = 6 * tree_width;

/// The first `count` bits of sixteen.
constexpr unsigned first_bits(std::size_t count) { return count >= width ? 0xffffu : (1u << count) - 1u; }

/// Which of the sixteen boxes of a block overlap `box`, or nearly do.
BRIO_INLINE unsigned overlap_bits(const TreeBlock& block, const CaptureBox& box) {
  const auto all_of = [](const float(&source)[tree_width]) {
    Lanes<float> values;
    __builtin_memcpy(&values.v, source, sizeof values.v);
    return values;
  };
  const auto meets = [&](int axis) {
    return (all_of(block.lower[axis]) <= Lanes<float>(block.seen(box.upper[axis], axis))) &
           (all_of(block.upper[axis]) >= Lanes<float>(block.seen(box.lower[axis], axis)));
  };
  return bits_of_lanes((meets(0) & meets(1) & meets(2)).v);
}

constexpr CaptureBox everywhere{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};

}  // namespace

void NodeTree::build(const SearchNodes& nodes, ThreadTeam& team) {
  constexpr std::size_t places_per_task = 8192;
  holds_points_ = nodes.are_points();
  lay_centres(nodes, everywhere, team, centres_);
  order_.sort(centres_, team);
  range_.resize(order_.size());
  team.for_ranges(order_.size(), places_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) range_[i] = nodes.range(index(order_[i]));
  });
  blocks_.clear();
  first_.clear();
  bounds_.clear();
  if (range_.empty()) return;
  add_level(range_, team);
  while (bounds_.size() > 1) {
    bounds_.swap(below_);
    add_level(below_, team);
  }
}

/// Put blocks over `boxes`, and their bounds into `bounds_`.
void NodeTree::add_level(std::span<const CaptureBox> boxes, ThreadTeam& team) {
  constexpr std::size_t blocks_per_task = 512;
  constexpr float infinite = std::numeric_limits<float>::infinity();  // of a box that is not there
  const std::size_t first = blocks_.size();
  const std::size_t added = (boxes.size() + width - 1) / width;
  blocks_.resize(first + added);
  bounds_.resize(added);
  first_.push_back(first);
  team.for_ranges(added, blocks_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const auto inside = boxes.subspan(b * width, std::min(width, boxes.size() - b * width));
      CaptureBox bounds = empty_box;
      for (const CaptureBox& box : inside) bounds.include(box);
      bounds_[b] = bounds;
      TreeBlock& block = blocks_[first + b];
      double extent = 0;
      for (int axis = 0; axis < 3; ++axis) {
        block.origin[axis] = std::clamp(bounds.lower[axis], -farthest_coordinate, farthest_coordinate);
        extent = std::max(extent, std::min(bounds.upper[axis], farthest_coordinate) - block.origin[axis]);
      }
      block.per_length = extent > std::numeric_limits<double>::min() ? 1 / extent : 1;
      for (std::size_t i = 0; i < width; ++i)
        for (int axis = 0; axis < 3; ++axis) {
          block.lower[axis][i] = i < inside.size() ? block.seen(inside[i].lower[axis], axis) : infinite;
          block.upper[axis][i] = i < inside.size() ? block.seen(inside[i].upper[axis], axis) : -infinite;
        }
    }
  });
}

std::span<const NodeTree::Branch> NodeTree::narrow(const CaptureBox& box, std::vector<Branch>& room,
                                                   std::uint64_t& comparisons) const {
  room.clear();
  if (!first_.empty()) room.push_back({first_.size() - 1, 0});
  // Level by level, branches give way to those below them that meet the box while these are few.
  std::span<const Branch> branches(room);
  while (!branches.empty() && branches.front().level > 1) {
    const std::size_t begin = room.size() - branches.size(), end = room.size();
    for (std::size_t i = begin; i < end; ++i) {
      const auto [level, number] = room[i];
      comparisons += tests_per_block;
      for (unsigned bits = overlap_bits(blocks_[first_[level] + number], box); bits != 0; bits &= bits - 1)
        room.push_back({level - 1, number * width + index(std::countr_zero(bits))});
    }
    if (room.size() - end > most_branches) return std::span(room).subspan(begin, end - begin);
    branches = std::span(room).subspan(end);
  }
  return branches;
}

std::size_t NodeTree::collect(const CaptureBox& box, std::span<const Branch> branches, std::size_t most,
                              std::vector<int>& places, std::uint64_t& comparisons) const {
  std::array<Branch, 10 * width> below;  // fifteen siblings of each ancestor: 2^31 nodes make 8 levels
  std::size_t found = 0;
  for (const Branch& start : branches) {
    std::size_t waiting = 0;
    below[waiting++] = start;
    while (waiting > 0 && found <= most) {
      const auto [level, number] = below[--waiting];
      comparisons += tests_per_block;
      unsigned bits = overlap_bits(blocks_[first_[level] + number], box);
      if (level > 0) {
        for (; bits != 0; bits &= bits - 1)
          below[waiting++] = {level - 1, number * width + index(std::countr_zero(bits))};
      } else {
        make_room(places, found + width);
        for (; bits != 0; bits &= bits - 1)
          places[found++] = static_cast<int>(number * width) + std::countr_zero(bits);
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
  make_room(nearby.found, count);
  for (std::size_t i = 0; i < count; ++i) nearby.found[i] = tree.node(nearby.place[i]);
  rank(nearby.found.data(), count, nearby);
  make_room(nearby.node, count + bits_lanes);
  for (int axis = 0; axis < 3; ++axis) {
    make_room(nearby.lower[axis], count + bits_lanes);
    if (!tree.holds_points()) make_room(nearby.upper[axis], count + bits_lanes);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto to = index(nearby.rank[i]);
    const CaptureBox& range = tree.range(nearby.place[i]);
    nearby.node[to] = nearby.found[i];
    for (int axis = 0; axis < 3; ++axis) {
      nearby.lower[axis][to] = range.lower[axis];
      if (!tree.holds_points()) nearby.upper[axis][to] = range.upper[axis];
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
    found += index(append_selected(target + found, nearby.node.data() + i, bits));
  }
  piece.comparisons += 6 * count;
  piece.add(box_number, found);
}

}  // namespace

CaptureBox TreeSearch::bounds_of(std::span<const CaptureBox> boxes, std::size_t begin,
                                 std::size_t end) const {
  CaptureBox bounds = empty_box;
  for (std::size_t i = begin; i < end; ++i) bounds.include(boxes[index(box_order_[i])]);
  return bounds;
}

void TreeSearch::find_in_groups(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end,
                                NodesNearby& nearby, PairPiece& piece) const {
  nearby.branches = tree_.narrow(bounds_of(boxes, begin, end), nearby.room, piece.comparisons);
  for (std::size_t i = begin; i < end; i += group_size)
    find_in_group(boxes, i, std::min(end, i + group_size), nearby, piece);
}

void TreeSearch::find_in_group(std::span<const CaptureBox> boxes, std::size_t begin, std::size_t end,
                               NodesNearby& nearby, PairPiece& piece) const {
  const std::size_t most = end - begin > 1 ? most_of_group : no_limit;
  const std::size_t count =
      tree_.collect(bounds_of(boxes, begin, end), nearby.branches, most, nearby.place, piece.comparisons);
  if (count > most) {
    const std::size_t middle = begin + (end - begin) / 2;
    find_in_group(boxes, begin, middle, nearby, piece);
    find_in_group(boxes, middle, end, nearby, piece);
    return;
  }
  lay_out(tree_, count, nearby);
  for (std::size_t i = begin; i < end; ++i)
    add_nodes_inside(boxes[index(box_order_[i])], box_order_[i], nearby, tree_.holds_points(), count, piece);
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
  const std::size_t bundles = (box_order_.size() + bundle_size - 1) / bundle_size;
  const std::size_t tasks = piece_count(bundles, 1);
  if (pieces_.size() < tasks) pieces_.resize(tasks);
  if (nearby_.size() < tasks) nearby_.resize(tasks);
  team.for_each(tasks, [&](std::size_t task) {
    pieces_[task].clear();
    for (std::size_t bundle = bundles * task / tasks; bundle < bundles * (task + 1) / tasks; ++bundle)
      find_in_groups(boxes, bundle * bundle_size, std::min(box_order_.size(), (bundle + 1) * bundle_size),
                     nearby_[task], pieces_[task]);
  });
  merge({pieces_.data(), tasks}, boxes.size(), team, pairs, counts);
}

}  // namespace brio
