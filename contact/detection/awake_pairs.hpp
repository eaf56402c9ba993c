#pragma once
/// Which pairs are awake: those that may come within their radii and the band in this step, by their paths.
///
/// Pairs sleep in blocks. What a block's least sleepy pair has left, put on top of the longest paths of the
/// pairs of a relation, is a sum that their longest look ahead must reach before any pair of that relation in
/// the block can wake: until then the block costs one comparison for each of its few relations. It is exact:
/// no pair's path grows by more than the longest of its relation. Pairs of the block that are awake are
/// looked at by themselves until they sleep as the others do.

#include <array>
#include <cstdint>
#include <vector>

#include "contact/features/feature_motion.hpp"
#include "contact/pairs/feature_pairs.hpp"

namespace brio {

/// What is known of a block of pairs.
struct alignas(64) PairBlock {
  std::uint64_t version = 0;  ///< of the list, for which the relations were found
  std::uint32_t awake = 0;    ///< bit i: pair i of the block was awake in the last step
  std::int8_t relations = 0;  ///< -1: too many
  bool sleeps = false;        ///< all others
  std::array<int, 12> relation{};
  std::array<double, 12> wake{};  ///< longest look ahead of the relation at which it is looked into
};

/// Of all blocks of one list of pairs, and working space.
struct PairBlocks {
  std::vector<PairBlock> block;
  std::uint64_t restarts = 0;      ///< of the motion that this was found for
  std::vector<int> found;          ///< by ranges
  std::vector<std::size_t> count;  ///< of each range
};

/// The pairs, ascending, but for those whose looks ahead and a surplus do not reach their wakes.
void select_awake_pairs(PairBlocks& blocks, const PairList& pairs, const PathAndAhead& first,
                        const PathAndAhead& second, const FeatureMotion& motion, double surplus,
                        ThreadTeam& team, std::vector<int>& awake);

}  // namespace brio
