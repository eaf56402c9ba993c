#pragma once
/// Pairs of features that may come near each other before the next search: nodes and faces, edges and edges.
///
/// Every node has a box that holds its motion of some steps ahead, in the frame of the mean motion; features
/// whose boxes meet are paired. A search is due when the end of a node's step leaves its box: until then no
/// pair is missing. Left out are pairs that share a node, that are parts of one rigid body, of one face, or
/// that the deck keeps from touching. Pairs of one piece (the fold of a shell, the sides of one element) are
/// listed too: not their radii, which overlap as drawn, but two skins are kept between them.

#include <cstdint>
#include <vector>

#include "contact/detection/feature_motion.hpp"
#include "contact/detection/features.hpp"
#include "contact/global_search.hpp"
#include "contact/options.hpp"

namespace brio {

/// One list of pairs, struct of arrays. The first feature is a node or an edge, the second a face or an edge.
struct PairList {
  std::vector<int> first, second;
  std::vector<float> direction[3];   ///< from the second to the first; zero: not known
  std::vector<double> wake;          ///< sum of both paths at which the pair has to be looked at
  std::vector<std::uint8_t> spaced;  ///< 1: their radii are kept apart; 0: two skins, as they are one piece

  std::size_t size() const { return first.size(); }
  void clear();
  void add(int a, int b, bool keep_distance);
  Eigen::Vector3d direction_of(std::size_t pair) const {
    return {direction[0][pair], direction[1][pair], direction[2][pair]};
  }
  void set_direction(std::size_t pair, const Eigen::Vector3d& d) {
    for (int axis = 0; axis < 3; ++axis) direction[axis][pair] = static_cast<float>(d[axis]);
  }
};

class FeaturePairs {
 public:
  explicit FeaturePairs(SearchStrategy strategy = SearchStrategy::automatic) : search_(strategy) {}

  PairList node_face;
  PairList edge_edge;
  SearchCounts counts;

  /// Whether some node's step ends outside of its box, or there has been no search since `expire`.
  bool is_due(const Surface& surface, const FeatureMotion& motion) const;
  /// Search again; the paths of the motion restart.
  void find(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
            const ContactOptions& options, FeatureMotion& motion, ThreadTeam& team);
  void expire() { box_.clear(); }

 private:
  void find_node_face(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                      ThreadTeam& team);
  void find_edge_edge(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                      ThreadTeam& team);

  CaptureBox box_of(const Surface& surface, const Face& face) const;
  CaptureBox box_of(const EdgeFeature& edge) const;

  std::vector<CaptureBox> box_;  ///< of each slave node: where it may be until the next search
  std::vector<CaptureBox> first_box_, second_box_;
  GlobalSearch search_;
  CandidatePairs found_;
};

/// Distance beyond touching at which constraints are formed, over the smallest edge.
inline constexpr double proximity_band = 0.02;

}  // namespace brio
