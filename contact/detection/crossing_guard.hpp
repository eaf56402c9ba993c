#pragma once
/// Continuous collision detection: no node passes through the hull of a face and no edge through an edge
/// within the motion of a time step. Pairs that would are found here and become constraints, until none is
/// found.
///
/// A pair is disjoint if a plane separates it at the start and at the end of the step, since heights are
/// linear in time: the direction stored with the pair, else that of the closest points at the start, at the
/// end, or their mean. Pairs without such a separating plane are examined by the velocity checks, which have
/// no false negatives (velocity_check.hpp, edge_check.hpp). Every pair keeps a least distance, edges that
/// are points a fraction of the sum of their radii (crossing_check.hpp).

#include <cstdint>
#include <optional>
#include <vector>

#include "contact/detection/proximity.hpp"
#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "contact/options.hpp"
#include "contact/pair.hpp"
#include "contact/pairs/feature_pairs.hpp"

namespace brio {

enum class PairKind : std::uint8_t { node_face, edge_edge };

/// A pair that would come into contact within the step.
struct Hit {
  PairKind kind = PairKind::node_face;
  std::size_t pair = 0;
  double time = 0;                ///< fraction of the step
  Contact at_start;               ///< constraint along the closest points at the start; no normal: none
  std::optional<Contact> at_hit;  ///< along the direction of first contact
};

struct CrossingGuard {
  std::vector<Hit> hits;  ///< of the last check, by features
  struct Range {
    std::vector<Hit> hits;
    std::uint64_t certified = 0, renewed = 0, checked = 0;
  };
  std::vector<Range> range;  ///< working space of ranges of pairs, one task each
  std::uint64_t certified = 0, renewed = 0, checked = 0, found = 0;  ///< sums over steps

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(certified, renewed, checked, found);
  }
};

/// Distance that constraints of hits leave, over the smallest edge.
inline constexpr double separation_share = 1e-3;

/// Replace guard.hits by those of the active pairs. Directions of pairs are renewed.
/// The same bits for any number of threads.
void find_hits(CrossingGuard& guard, const Proximity& proximity, const SurfaceFeatures& features,
               const Surface& surface, const ContactOptions& options, FeaturePairs& pairs,
               const FeatureMotion& motion, std::span<const Contact> constraints, ThreadTeam& team);

}  // namespace brio
