#pragma once
/// Which pairs are awake: those that may come within their radii and the band in this step, by their paths.
///
/// Pairs sleep in blocks. What a block's least sleepy pair has left, put on top of twice the longest path of
/// any feature, is a sum that the longest look ahead must reach before any pair of the block can wake: until
/// then the block costs one comparison. It is exact: no feature's path grows by more than the longest.

#include <cstdint>
#include <vector>

#include "contact/detection/feature_motion.hpp"
#include "contact/detection/feature_pairs.hpp"

namespace brio {

/// What is known of blocks of one list of pairs, and working space.
struct PairBlocks {
  std::vector<double> wake;  ///< of each block: twice the longest look ahead at which it is looked into
  std::uint64_t changes = 0, restarts = 0;  ///< of pairs and motion that this was found for
  std::vector<int> found;                   ///< by ranges
  std::vector<std::size_t> count;           ///< of each range
};

/// The pairs, ascending, but for those whose looks ahead and a surplus do not reach their wakes.
void select_awake_pairs(PairBlocks& blocks, const PairList& pairs, const FeatureWays& first,
                        const FeatureWays& second, const FeatureMotion& motion, double surplus,
                        ThreadTeam& team, std::vector<int>& awake);

}  // namespace brio
