#include "contact/detection/awake_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/detection/pair_packs.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

namespace {

constexpr std::size_t pairs_a_block = 64;
constexpr std::size_t blocks_a_range = 64;
/// Of the lengths added, by which a block's wake is rounded down.
constexpr double rounding = 1e-14;

struct Slack {
  std::uint64_t awake = 0;  ///< bit i: pair i of the block
  double least = infinity;  ///< wake minus looks ahead
};

Slack look_into(const PairList& pairs, const double* first, const double* second, double surplus,
                std::size_t begin, std::size_t end) {
  Slack slack;
  std::size_t i = begin;
  Pack least(infinity);
  for (; i + pack_size <= end; i += pack_size) {
    const Pack ahead = gather_numbers(first, &pairs.first[i]) + gather_numbers(second, &pairs.second[i]);
    const Pack left = load_numbers(&pairs.wake[i]) - ahead;
    least = min(least, left);
    slack.awake |= static_cast<std::uint64_t>(lane_bits(!(left > Pack(surplus)))) << (i - begin);
  }
  slack.least = minimum(least, pack_size);
  for (; i < end; ++i) {
    const double left = pairs.wake[i] - (first[pairs.first[i]] + second[pairs.second[i]]);
    slack.least = std::min(slack.least, left);
    if (!(left > surplus)) slack.awake |= std::uint64_t{1} << (i - begin);
  }
  return slack;
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

void select_awake_pairs(PairBlocks& blocks, const PairList& pairs, const FeatureWays& first,
                        const FeatureWays& second, const FeatureMotion& motion, double surplus,
                        ThreadTeam& team, std::vector<int>& awake) {
  const std::size_t count = (pairs.size() + pairs_a_block - 1) / pairs_a_block;
  if (blocks.changes != pairs.changes || blocks.restarts != motion.restarts() || blocks.wake.size() != count)
    blocks.wake.assign(count, -infinity);
  blocks.changes = pairs.changes;
  blocks.restarts = motion.restarts();
  if (blocks.found.size() < pairs.size()) blocks.found.resize(pairs.size());
  blocks.count.assign((count + blocks_a_range - 1) / blocks_a_range, 0);
  const double longest = 2 * motion.longest_ahead(), since = 2 * motion.longest_path();
  team.for_ranges(count, blocks_a_range, [&](std::size_t begin, std::size_t end) {
    int* const start = &blocks.found[begin * pairs_a_block];
    int* to = start;
    for (std::size_t block = begin; block < end; ++block) {
      if (longest + surplus < blocks.wake[block]) continue;
      const std::size_t from = block * pairs_a_block;
      const Slack slack = look_into(pairs, first.ahead.data(), second.ahead.data(), surplus, from,
                                    std::min(from + pairs_a_block, pairs.size()));
      blocks.wake[block] = since + slack.least - rounding * (since + longest + std::abs(slack.least));
      for (std::uint64_t left = slack.awake; left != 0; left &= left - 1)
        *to++ = static_cast<int>(from) + std::countr_zero(left);
    }
    blocks.count[begin / blocks_a_range] = static_cast<std::size_t>(to - start);
  });
  join(blocks, awake);
}

}  // namespace brio
