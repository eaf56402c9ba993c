#pragma once
/// Contact detection: every pair of features at a local minimum of distance, nearer than their radii and a
/// band that covers the approach of the step, is a constraint along its closest points.
///
/// No inside is needed: since nothing crosses, features stay on their side. The minimum is local on the union
/// of the surfaces: at the closest points, every neighbouring feature is farther from the other one. If a
/// node is closest to an edge or a corner of a face, the adjacent faces must face away; two edges form a
/// constraint if the closest points are inside both and the faces at both face away. So a node or an edge
/// that slides over inner edges of a flat surface has no contact with them. In self-contact of a shell,
/// neighbours that are one piece with the other side are ignored, and so are those of a node: towards a fold
/// each is nearer than the one before.

#include <span>
#include <vector>

#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "contact/options.hpp"
#include "contact/pair.hpp"
#include "contact/pairs/active_pairs.hpp"
#include "contact/pairs/feature_pairs.hpp"
#include "contact/surface/slave_set.hpp"

namespace brio {

/// A candidate constraint.
struct FoundContact {
  Contact contact;
  std::array<int, 2> support{};  ///< features that contain the closest points, so that none is counted twice
  bool in_plane = false;         ///< the foot is at the rim of a face, below the node in its plane
};

/// Working data of detection in a step.
struct Proximity {
  /// Active pairs of this step, ascending; once constraints are found, those of them that may cross within
  /// the limits of the motion.
  std::vector<int> node_face, edge_edge;
  std::uint64_t looked_at = 0;       ///< active pairs, summed over steps
  std::uint64_t closest_points = 0;  ///< sum over steps of closest points computed

  PairBlocks node_face_blocks, edge_edge_blocks;
  struct Range {
    std::vector<FoundContact> found;
    std::size_t closest_points = 0;
  };
  std::vector<Range> range;                ///< working space of ranges of pairs, one task each
  std::vector<const FoundContact*> found;  ///< of all ranges
  std::vector<int> last_found, before;     ///< of a node or edge the last of them, and of each the one before
  SlaveSet features{0};                    ///< nodes or edges that have found any
  struct Chosen {
    std::vector<const FoundContact*> found, contacts;
    std::size_t begin = 0;  ///< of their places among all
  };
  std::vector<Chosen> chosen;  ///< working space of ranges of nodes or edges, one task each

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(looked_at, closest_points, node_face_blocks, edge_edge_blocks);
  }
};

/// Open pairs of faces that may come near, and list the active pairs: those that may come within their radii
/// in this step, by their motion bounds.
void select_active(Proximity& proximity, const SurfaceFeatures& features, const Surface& surface,
                   const Lists& excluded, const ContactOptions& options, FeaturePairs& pairs,
                   FeatureMotion& motion, ThreadTeam& team);

/// Replace `contacts` by the constraints of this step, those of nodes and faces by node, then those of edges.
/// Directions and motion bounds of the pairs are renewed. Active pairs that are not near are dropped: they
/// are farther apart than twice their predicted motion, their radii and the band, which is more than what the
/// limits of the motion allow. The same bits for any number of threads. \param
/// excluded pairs of nodes and faces that are one piece \param last constraints of the step before
void find_proximities(Proximity& proximity, const SurfaceFeatures& features, const Surface& surface,
                      const Lists& excluded, const ContactOptions& options, FeaturePairs& pairs,
                      const FeatureMotion& motion, ThreadTeam& team, std::span<const Contact> last,
                      std::vector<Contact>& contacts);

/// Of all pairs: how far the solution may move a node beyond twice its predicted displacement before inactive
/// pairs have to be examined again.
double allowed_surplus(const SurfaceFeatures& features);

}  // namespace brio
