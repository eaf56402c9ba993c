#pragma once
/// No node passes through the hull of a face and no edge through an edge within the motion of a step: what
/// would is found here, so that it can be solved for, until nothing is found.
///
/// A pair is certainly apart where a direction separates it at the start and at the end of the step, since
/// heights are linear in time: the direction that it had, else that of the closest points at the start, at
/// the end, or their mean. What no such direction separates is looked at by the velocity checks, which miss
/// nothing (velocity_check.hpp, edge_check.hpp). Edges that are points are kept from coming closer than a
/// share of their radii.

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

/// A pair that would touch within the step.
struct Hit {
  PairKind kind = PairKind::node_face;
  std::size_t pair = 0;
  double time = 0;                ///< share of the step
  Contact at_start;               ///< constraint along the closest points at the start; no normal: none
  std::optional<Contact> at_hit;  ///< along the direction in which they meet
};

struct CrossingGuard {
  std::vector<Hit> hits;  ///< of the last look, in the order of pairs
  struct Range {
    std::vector<Hit> hits;
    std::uint64_t certified = 0, renewed = 0, checked = 0;
  };
  std::vector<Range> range;  ///< working space of the ranges that threads take
  std::uint64_t certified = 0, renewed = 0, checked = 0, found = 0;  ///< sums over steps
};

/// Distance that constraints of hits leave, over the smallest edge.
inline constexpr double separation_share = 1e-3;

/// Replace guard.hits by those among the pairs that are not surely apart. Directions of pairs are renewed.
/// The same bits for any number of threads.
void find_hits(CrossingGuard& guard, const Proximity& proximity, const SurfaceFeatures& features,
               const Surface& surface, const ContactOptions& options, FeaturePairs& pairs,
               const FeatureMotion& motion, ThreadTeam& team);

}  // namespace brio
