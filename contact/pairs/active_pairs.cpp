#include "contact/pairs/active_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t pairs_a_block = PairList::block_size;
constexpr std::size_t blocks_a_range = 64;
/// Relative rounding, downwards, of the motion bound of a block.
constexpr double rounding = 1e-14;

/// Predicted paths of the features of pairs and of the frames of their relations.
struct Ahead {
  const double *first, *second, *frames;
  double surplus;

  /// Remaining path of a pair before it has to be examined.
  double left_of(const PairList& pairs, std::size_t i) const {
    const PairRecord& pair = pairs[i];
    return pairs.wake[i] - (first[pair.first] + second[pair.second] + frames[pair.relation]);
  }
  bool is_awake(double left) const { return !(left > surplus); }
};

void lay_down(PairBlock& block, const PathAndAhead& total, double left) {
  for (std::size_t k = 0; k < index(block.relations); ++k) {
    const auto r = index(block.relation[k]);
    block.wake[k] =
        std::min(block.wake[k], total.path[r] + left - rounding * (total.ahead[r] + std::abs(left)));
  }
}

// All pairs of the block.
void look_into(PairBlock& block, const PairList& pairs, const Ahead& ahead, const PathAndAhead& total,
               std::size_t begin, std::size_t end) {
  double least = infinity;
  block.active = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const double left = ahead.left_of(pairs, i);
    const bool active = ahead.is_awake(left);
    block.active |= std::uint32_t{active} << (i - begin);
    if (!active) least = std::min(least, left);
  }
  block.inactive = block.relations >= 0;
  block.wake.fill(infinity);
  if (block.inactive && least < infinity) lay_down(block, total, least);
}

// Those that were active.
void look_at_awake(PairBlock& block, const PairList& pairs, const Ahead& ahead, const PathAndAhead& total,
                   std::size_t begin) {
  for (std::uint32_t bits = block.active; bits != 0; bits &= bits - 1) {
    const double left = ahead.left_of(pairs, begin + index(std::countr_zero(bits)));
    if (ahead.is_awake(left)) continue;
    block.active &= ~(bits & -bits);
    if (left < infinity) lay_down(block, total, left);
  }
}

bool still_sleeps(const PairBlock& block, const PathAndAhead& total, double surplus) {
  if (!block.inactive) return false;
  for (std::size_t k = 0; k < index(block.relations); ++k)
    if (!(total.ahead[index(block.relation[k])] + surplus < block.wake[k])) return false;
  return true;
}

void find_relations(PairBlock& block, const PairList& pairs, std::size_t begin, std::size_t end) {
  std::size_t count = 0;
  int last = -1;
  for (std::size_t i = begin; i < end; ++i) {
    const int relation = pairs[i].relation;
    if (relation == last || pairs.spacing(i) == Spacing::none) continue;
    last = relation;
    const auto known = block.relation.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(block.relation.begin(), known, relation) != known) continue;
    if (count == block.relation.size()) {
      block.relations = -1;
      return;
    }
    block.relation[count++] = relation;
  }
  block.relations = static_cast<std::int8_t>(count);
}

void join(const PairBlocks& blocks, std::vector<int>& active) {
  std::size_t total = 0;
  for (std::size_t count : blocks.count) total += count;
  active.resize(total);
  int* to = active.data();
  for (std::size_t range = 0; range < blocks.count.size(); ++range)
    to = std::copy_n(&blocks.found[range * blocks_a_range * pairs_a_block], blocks.count[range], to);
}

}  // namespace

void select_active_pairs(PairBlocks& blocks, const PairList& pairs, const PathAndAhead& first,
                         const PathAndAhead& second, const FeatureMotion& motion, double surplus,
                         ThreadTeam& team, std::vector<int>& active) {
  const std::size_t count = (pairs.size() + pairs_a_block - 1) / pairs_a_block;
  if (blocks.restarts != motion.restarts()) blocks.block.clear();
  blocks.block.resize(count);
  blocks.restarts = motion.restarts();
  if (blocks.found.size() < pairs.size()) blocks.found.resize(pairs.size());
  blocks.count.assign((count + blocks_a_range - 1) / blocks_a_range, 0);
  const MotionGroups& groups = motion.groups;
  const Ahead ahead{first.ahead.data(), second.ahead.data(), groups.relation.ahead.data(), surplus};
  team.for_ranges(count, blocks_a_range, [&](std::size_t begin, std::size_t end) {
    int* const start = &blocks.found[begin * pairs_a_block];
    int* to = start;
    for (std::size_t b = begin; b < end; ++b) {
      PairBlock& block = blocks.block[b];
      const std::size_t from = b * pairs_a_block, last = std::min(from + pairs_a_block, pairs.size());
      const bool is_known = block.version == pairs.version(b);
      if (is_known && still_sleeps(block, groups.total, surplus)) {
        look_at_awake(block, pairs, ahead, groups.total, from);
      } else {
        block.version = pairs.version(b);
        if (!is_known) find_relations(block, pairs, from, last);
        look_into(block, pairs, ahead, groups.total, from, last);
      }
      for (std::uint32_t left = block.active; left != 0; left &= left - 1)
        *to++ = static_cast<int>(from) + std::countr_zero(left);
    }
    blocks.count[begin / blocks_a_range] = index(to - start);
  });
  join(blocks, active);
}

}  // namespace brio
