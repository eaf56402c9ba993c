#include "contact/detection/awake_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "src/base/floating_point.hpp"

namespace brio {

namespace {

constexpr std::size_t pairs_a_block = PairList::block_size;
constexpr std::size_t blocks_a_range = 64;
/// Of the lengths added, by which a block's wake is rounded down.
constexpr double rounding = 1e-14;

struct Slack {
  std::uint64_t awake = 0;  ///< bit i: pair i of the block
  double least = infinity;  ///< wake minus looks ahead
};

Slack look_into(const PairList& pairs, const double* first, const double* second, const double* frames,
                double surplus, std::size_t begin, std::size_t end) {
  Slack slack;
  for (std::size_t i = begin; i < end; ++i) {
    const PairRecord& pair = pairs[i];
    const double left = pairs.wake[i] - (first[pair.first] + second[pair.second] + frames[pair.relation]);
    slack.least = std::min(slack.least, left);
    slack.awake |= std::uint64_t{!(left > surplus)} << (i - begin);
  }
  return slack;
}

bool still_sleeps(const PairBlock& block, const PathAndAhead& total, double surplus) {
  if (!block.sleeps) return false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(block.relations); ++k)
    if (!(total.ahead[static_cast<std::size_t>(block.relation[k])] + surplus < block.wake[k])) return false;
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

// A block of which no pair is awake.
void lay_down(PairBlock& block, const PathAndAhead& total, double least) {
  block.sleeps = block.relations >= 0;
  for (std::size_t k = 0; block.sleeps && k < static_cast<std::size_t>(block.relations); ++k) {
    const auto r = static_cast<std::size_t>(block.relation[k]);
    block.wake[k] = total.path[r] + least - rounding * (total.ahead[r] + std::abs(least));
  }
}

void join(const PairBlocks& blocks, std::vector<int>& awake) {
  std::size_t total = 0;
  for (std::size_t count : blocks.count) total += count;
  awake.resize(total);
  int* to = awake.data();
  for (std::size_t range = 0; range < blocks.count.size(); ++range)
    to = std::copy_n(&blocks.found[range * blocks_a_range * pairs_a_block], blocks.count[range], to);
}

}  // namespace

void select_awake_pairs(PairBlocks& blocks, const PairList& pairs, const PathAndAhead& first,
                        const PathAndAhead& second, const FeatureMotion& motion, double surplus,
                        ThreadTeam& team, std::vector<int>& awake) {
  const std::size_t count = (pairs.size() + pairs_a_block - 1) / pairs_a_block;
  if (blocks.restarts != motion.restarts()) blocks.block.clear();
  blocks.block.resize(count);
  blocks.restarts = motion.restarts();
  if (blocks.found.size() < pairs.size()) blocks.found.resize(pairs.size());
  blocks.count.assign((count + blocks_a_range - 1) / blocks_a_range, 0);
  const MotionGroups& groups = motion.groups;
  team.for_ranges(count, blocks_a_range, [&](std::size_t begin, std::size_t end) {
    int* const start = &blocks.found[begin * pairs_a_block];
    int* to = start;
    for (std::size_t b = begin; b < end; ++b) {
      PairBlock& block = blocks.block[b];
      const std::size_t from = b * pairs_a_block, last = std::min(from + pairs_a_block, pairs.size());
      if (block.version != pairs.version(b)) {
        block.version = pairs.version(b);
        find_relations(block, pairs, from, last);
      } else if (still_sleeps(block, groups.total, surplus)) {
        continue;
      }
      const Slack slack = look_into(pairs, first.ahead.data(), second.ahead.data(),
                                    groups.relation.ahead.data(), surplus, from, last);
      block.sleeps = false;
      if (slack.awake == 0) lay_down(block, groups.total, slack.least);
      for (std::uint64_t left = slack.awake; left != 0; left &= left - 1)
        *to++ = static_cast<int>(from) + std::countr_zero(left);
    }
    blocks.count[begin / blocks_a_range] = static_cast<std::size_t>(to - start);
  });
  join(blocks, awake);
}

}  // namespace brio
