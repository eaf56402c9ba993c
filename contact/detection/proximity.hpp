#pragma once
/// The rule of contact: every pair of features at a local minimum of their distance, nearer than their radii
/// and a band that covers the approach of the step, is a constraint along its closest points.
///
/// There are no sides: since nothing crosses, the side is where the features are. A local minimum on the
/// union of the surfaces: at the closest points, every neighbouring feature lies farther from the other one.
/// Where a node is closest to an edge or a corner of a face, the faces beside it must look away; two edges
/// form a constraint where both are closest inside of them and the faces at both look away. So a node or an
/// edge that slides over inner edges of a flat surface meets nothing there.
/// Of a shell that meets itself, neighbours that are one piece with the other side do not count, nor those of
/// a node: towards a fold each is nearer than the one before.

#include <span>
#include <vector>

#include "contact/detection/awake_pairs.hpp"
#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "contact/options.hpp"
#include "contact/pair.hpp"
#include "contact/pairs/feature_pairs.hpp"

namespace brio {

/// A constraint on its way.
struct FoundContact {
  Contact contact;
  std::array<int, 2> support{};  ///< what the closest points lie on, so that none is counted twice
  bool in_plane = false;         ///< the foot is at the rim of a face, below the node in its plane
};

/// What is looked at in a step.
struct Proximity {
  std::vector<int> node_face, edge_edge;  ///< pairs that are not surely apart in this step, ascending
  std::uint64_t looked_at = 0;            ///< sum over steps of pairs
  std::uint64_t closest_points = 0;       ///< sum over steps of closest points computed

  PairBlocks node_face_blocks, edge_edge_blocks;
  struct Range {
    std::vector<FoundContact> found;
    std::size_t closest_points = 0;
  };
  std::vector<Range> range;                ///< working space of the ranges that threads take
  std::vector<const FoundContact*> found;  ///< of all ranges
};

/// Pairs that may come within their radii in this step, by their paths.
void select_awake(Proximity& proximity, const SurfaceFeatures& features, const FeaturePairs& pairs,
                  const FeatureMotion& motion, ThreadTeam& team);

/// Replace `contacts` by the constraints of this step, those of nodes and faces by node, then those of edges.
/// Directions and wakes of the pairs are renewed. The same bits for any number of threads. \param excluded
/// pairs of nodes and faces that are one piece
void find_proximities(Proximity& proximity, const SurfaceFeatures& features, const Surface& surface,
                      const Lists& excluded, const ContactOptions& options, FeaturePairs& pairs,
                      const FeatureMotion& motion, ThreadTeam& team, std::vector<Contact>& contacts);

/// Of all pairs: how far the solution may move a node beyond twice its predicted step before pairs that were
/// surely apart have to be looked at again.
double allowed_surplus(const SurfaceFeatures& features);

}  // namespace brio
