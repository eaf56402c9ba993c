#pragma once
/// Active pairs: those that may come within their radii and the band in this step, by the bounds of their
/// motion.
///
/// An inactive pair has a motion bound: the path that its features may travel before it has to be
/// reactivated. Pairs are grouped in blocks. The least remaining path in a block, added to the longest paths
/// of the pairs of a relation, is a bound that their longest predicted path must reach before any pair of
/// that relation in the block can become active: until then the block costs one comparison for each of its
/// few relations. The bound is exact: no pair's path grows by more than the longest of its relation. Active
/// pairs of the block are examined one by one until they are inactive.

#include <array>
#include <cstdint>
#include <vector>

#include "contact/features/feature_motion.hpp"
#include "contact/pairs/pair_list.hpp"

namespace brio {

/// State of a block of pairs, with what a pass reads of each of them side by side: half of what records hold.
struct alignas(64) PairBlock {
  std::uint64_t version = ~std::uint64_t{0};  ///< of the list, from which pairs were taken over
  std::uint32_t active = 0;                   ///< bit i: pair i of the block was active in the last step
  std::int8_t relations = 0;                  ///< -1: too many
  bool inactive = false;                      ///< whether all others are inactive
  std::array<int, 12> relation{};
  std::array<double, 12> wake{};  ///< longest predicted path of the relation at which the block is examined
  std::array<int, PairList::block_size> first{}, second{}, relation_of{};  ///< of each pair
};

/// Of all blocks of one list of pairs, and working space.
struct PairBlocks {
  std::vector<PairBlock> block;
  std::uint64_t restarts = 0;      ///< of the motion for which this was found
  std::vector<int> found;          ///< by ranges
  std::vector<std::size_t> count;  ///< of each range

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(block, restarts);
  }
};

/// The active pairs, ascending: those whose predicted paths and a surplus reach their motion bounds (`wake`).
void select_active_pairs(PairBlocks& blocks, const PairList& pairs, const PathAndAhead& first,
                         const PathAndAhead& second, const FeatureMotion& motion, double surplus,
                         ThreadTeam& team, std::vector<int>& active);

}  // namespace brio
