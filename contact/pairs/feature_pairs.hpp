#pragma once
/// Pairs of features that may come near each other before the next search: nodes and faces, edges and edges.
///
/// Every node has a box that contains its motion of some steps ahead (search margin, Verlet skin), in the
/// frame of the mean motion; features whose boxes overlap are paired. A search is due when a node leaves its
/// box at the end of a step, for the features at such nodes only: until then no pair is missing, and one fast
/// fragment does not cause a search for all. Excluded are pairs that share a node, that belong to one rigid
/// body, to one face (except its opposite sides), or that the deck excludes. Pairs of one piece (the fold of
/// a shell, the sides of one element) are listed too: they keep two skins instead of their radii, which
/// overlap in the mesh. Pairs that are new after a deletion may be nearer than their radii: such a pair keeps
/// two skins until its distance has once reached its radii.
///
/// Diagonals of flat faces are not paired (face_flatness.hpp).

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contact/features/face_flatness.hpp"
#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "contact/options.hpp"
#include "contact/pairs/feature_boxes.hpp"
#include "contact/pairs/pair_list.hpp"
#include "contact/pairs/searched_depth.hpp"

namespace brio {

class FeaturePairs {
 public:
  PairList node_face;
  PairList edge_edge;
  SearchCounts counts;

  /// Whether some node's step ends outside of its box, a face bends more than it did, or there has been no
  /// search since `expire`.
  bool is_due(const SurfaceFeatures& features, const Surface& surface, const FeatureMotion& motion,
              ThreadTeam& team);
  /// The same after the solution of a step at whose start no search was due, or was made.
  bool is_due_after_solution(const SurfaceFeatures& features, const Surface& surface,
                             const FeatureMotion& motion, ThreadTeam& team);
  /// Renew the pairs of features that have left their boxes, or, if these are many, all; then the paths of
  /// the motion restart. \throws TooManyNear where there is no depth. \param depth to which features of
  /// different bodies are paired; not empty: a face is flat for all pairs or none
  void find(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
            const ContactOptions& options, FeatureMotion& motion, ThreadTeam& team,
            const SearchedDepth& depth = {});
  /// The surface has changed: features were added, and the listed ones have changed or were deleted. Nodes
  /// stand for all features at them. \param grown nodes whose radii have grown
  void change(std::span<const int> nodes, std::span<const int> faces, std::span<const int> edges,
              std::span<const int> grown);
  /// Faces of the last search that may be in boxes laid where the last step has taken the nodes; dead ones
  /// too. \returns numbers of box and face
  std::vector<std::pair<std::size_t, int>> find_faces(std::vector<CaptureBox> boxes,
                                                      const FeatureMotion& motion, ThreadTeam& team);
  /// Faces that have joined or died since that search.
  std::span<const int> faces_since_search() const { return changes_.face; }
  /// As many boxes meet at rest as in the last search of `other`, which had a depth.
  void take_rest_of(const FeaturePairs& other) { met_at_rest_ = other.met_at_rest_; }
  /// The next search is for all features.
  void expire() { reach_.clear(); }
  std::uint64_t searches() const { return searches_; }
  const FaceFlatness& flatness() const { return flat_; }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(node_face, edge_edge, counts, reach_, flat_, node_box_, face_box_, edge_box_, node_, face_, edge_,
            node_leaves_, face_leaves_, edge_leaves_, changes_, changed_, searches_, most_pairs_,
            met_at_rest_);
  }

 private:
  struct Scene {
    const SurfaceFeatures& features;
    const Surface& surface;
    const Lists& excluded;
    double margin;  ///< of boxes of nodes, over the scale of the node
    double band;    ///< half of it for either feature
    bool edges;     ///< whether there is edge-edge contact
    SearchedDepth depth;
  };

  bool is_inside(std::size_t slave, const FeatureMotion& motion, double steps) const;
  /// Length by which the box of a node exceeds its place.
  static double scale_of(std::size_t slave, const Scene& scene, const FeatureMotion& motion);
  void place(std::size_t slave, const Scene& scene, const FeatureMotion& motion);
  CaptureBox box_of(const Surface& surface, const Face& face) const;
  CaptureBox box_of(const EdgeFeature& edge) const;
  CaptureBox node_box(const Scene& scene, std::size_t slave) const;
  CaptureBox face_box(const Scene& scene, std::size_t face) const;
  CaptureBox edge_box(const Scene& scene, std::size_t edge) const;

  void take_in_changes(const Scene& scene);
  void forget_changes();
  bool collect_leaving(const Scene& scene, const FeatureMotion& motion);
  void remember(std::vector<std::uint64_t>& kept, int a, int b, Spacing spacing) const;
  Spacing spacing_of_new(const std::vector<std::uint64_t>& kept, int a, int b, bool only_skins) const;
  void find_all(const Scene& scene, FeatureMotion& motion, ThreadTeam& team);
  void find_leaving(const Scene& scene, FeatureMotion& motion, ThreadTeam& team);
  void drop_dead(const Scene& scene);
  Spacing node_face_spacing(const Scene& scene, int slave, int face) const;
  Spacing edge_edge_spacing(const Scene& scene, int first, int second) const;
  void add_node_face(const Scene& scene, MotionGroups& groups, int slave, int face, Spacing spacing);
  void add_edge_edge(const Scene& scene, MotionGroups& groups, int first, int second, Spacing spacing);

  std::vector<CaptureBox> reach_;  ///< of each slave node: where it may be until the next search
  FaceFlatness flat_;
  FeatureBoxes node_box_, face_box_, edge_box_;
  std::vector<int> node_, face_, edge_;  ///< features that have left their boxes, ascending
  std::vector<std::uint8_t> node_leaves_, face_leaves_, edge_leaves_;
  std::vector<CaptureBox> query_;

  struct Changes {
    std::vector<int> node, face, edge, grown;
    bool before_first_search = false;
    bool empty() const { return node.empty() && face.empty() && edge.empty() && !before_first_search; }
    template <class Archive>
    void serialize(Archive& archive) {
      archive(node, face, edge, grown, before_first_search);
    }
  } changes_;             ///< since the last search
  bool changed_ = false;  ///< whether this search follows a change
  /// Pairs taken out in this search, ascending: those with radii where it follows a change, else those that
  /// wait.
  std::vector<std::uint64_t> kept_node_face_, kept_edge_edge_;
  std::uint64_t searches_ = 0;
  std::uint64_t most_pairs_ = 0;   ///< of `counts`, in this search
  std::uint64_t met_at_rest_ = 0;  ///< boxes
};

/// Distance beyond touching at which constraints are formed, over the smallest edge.
inline constexpr double proximity_band = 0.02;

}  // namespace brio
