#include "contact/pairs/active_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/features/gather.hpp"
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

  bool is_awake(double left) const { return !(left > surplus); }
};

/// Remaining path of a pair before it has to be examined.
double left_of(const PairBlock& block, const double* wake, const Ahead& ahead, std::size_t place) {
  return wake[place] - (ahead.first[block.first[place]] + ahead.second[block.second[place]] +
                        ahead.frames[block.relation_of[place]]);
}
// The same of eight.
Pack left_of_eight(const PairBlock& block, const double* wake, const Ahead& ahead, std::size_t place) {
  return Pack::load(wake + place) - (gather_numbers(ahead.first, &block.first[place]) +
                                     gather_numbers(ahead.second, &block.second[place]) +
                                     gather_numbers(ahead.frames, &block.relation_of[place]));
}

void lay_down(PairBlock& block, const PathAndAhead& total, double left) {
  for (std::size_t k = 0; k < index(block.relations); ++k) {
    const auto r = index(block.relation[k]);
    block.wake[k] =
        std::min(block.wake[k], total.path[r] + left - rounding * (total.ahead[r] + std::abs(left)));
  }
}

// All pairs of the block: `count` places.
void look_into(PairBlock& block, const double* wake, const Ahead& ahead, const PathAndAhead& total,
               std::size_t count) {
  Pack least(infinity);
  block.active = 0;
  std::size_t i = 0;
  for (; i + pack_size <= count; i += pack_size) {
    const Pack left = left_of_eight(block, wake, ahead, i);
    const MaskOf<Pack> sleeps = left > Pack(ahead.surplus);
    block.active |= std::uint32_t{~lane_bits(sleeps) & first_lanes(pack_size)} << i;
    least = min(least, where(sleeps, left, Pack(infinity)));
  }
  double least_left = infinity;
  for (int lane = 0; lane < pack_size; ++lane) least_left = std::min(least_left, least[lane]);
  for (; i < count; ++i) {
    const double left = left_of(block, wake, ahead, i);
    if (ahead.is_awake(left))
      block.active |= std::uint32_t{1} << i;
    else
      least_left = std::min(least_left, left);
  }
  block.inactive = block.relations >= 0;
  block.wake.fill(infinity);
  if (block.inactive && least_left < infinity) lay_down(block, total, least_left);
}

// Those that were active.
void look_at_awake(PairBlock& block, const double* wake, const Ahead& ahead, const PathAndAhead& total) {
  for (std::uint32_t bits = block.active; bits != 0; bits &= bits - 1) {
    const double left = left_of(block, wake, ahead, index(std::countr_zero(bits)));
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

// What of the pairs does not change while they are in the list.
void take_over(PairBlock& block, const PairList& pairs, std::size_t begin, std::size_t end) {
  std::size_t count = 0;
  int last = -1;
  for (std::size_t i = begin; i < end; ++i) {
    const PairRecord& pair = pairs[i];
    block.first[i - begin] = pair.first;
    block.second[i - begin] = pair.second;
    block.relation_of[i - begin] = pair.relation;
    const int relation = pair.relation;
    if (relation == last || pair.spacing == Spacing::none || count > block.relation.size()) continue;
    last = relation;
    const auto known = block.relation.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(block.relation.begin(), known, relation) != known) continue;
    if (count < block.relation.size()) block.relation[count] = relation;
    ++count;
  }
  block.relations = count > block.relation.size() ? std::int8_t{-1} : static_cast<std::int8_t>(count);
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
      const double* wake = pairs.wake.data() + from;
      if (is_known && still_sleeps(block, groups.total, surplus)) {
        look_at_awake(block, wake, ahead, groups.total);
      } else {
        block.version = pairs.version(b);
        if (!is_known) take_over(block, pairs, from, last);
        look_into(block, wake, ahead, groups.total, last - from);
      }
      for (std::uint32_t left = block.active; left != 0; left &= left - 1)
        *to++ = static_cast<int>(from) + std::countr_zero(left);
    }
    blocks.count[begin / blocks_a_range] = index(to - start);
  });
  join(blocks, active);
}

}  // namespace brio
