#pragma once
/// Pairs of features that are near each other: nodes and faces, edges and edges.
///
/// Every node has a box that contains its motion of some steps ahead (search margin, Verlet skin), in the
/// frame of the mean motion. Faces whose boxes overlap are paired, and so are beams and particles with faces.
/// A search is due when a node leaves its box at the end of a step, for the faces at such nodes only: until
/// then no pair is missing, and one fast fragment does not cause a search for all.
///
/// A pair of faces is opened when a lower bound of the distance of their features (feature_distance.hpp) may
/// come within contact in a step: then their features are paired, each with those that its face is the first
/// to have, so that none is paired twice. It is closed at a search, when it is far again. Excluded are pairs
/// that share a node, that belong to one rigid body, to one face (except its opposite sides), or that the
/// deck excludes. Pairs of one piece (the fold of a shell, the sides of one element) are listed too: they
/// keep two skins instead of their radii, which overlap in the mesh. Pairs that are new after a deletion may
/// be nearer than their radii: such a pair keeps two skins until its distance has once reached its radii.
///
/// Diagonals of flat faces are not paired, nor are sides between faces in one plane with edges that are not
/// longer than these are wide (flatness.hpp).

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "contact/features/flatness.hpp"
#include "contact/options.hpp"
#include "contact/pairs/active_pairs.hpp"
#include "contact/pairs/feature_boxes.hpp"
#include "contact/pairs/pair_list.hpp"
#include "contact/pairs/searched_depth.hpp"
#include "src/base/index.hpp"

namespace brio {

/// Boxes of faces, of beams and particles by their edges, or of debris: nodes without elements.
struct SearchedBoxes {
  FeatureBoxes box;
  std::vector<std::uint8_t> flag;  ///< of each, in a search: bits of Change
  std::vector<CaptureBox> before;  ///< of those that leave: the box that they had
  std::vector<int> leaving;        ///< ascending

  enum Change : std::uint8_t { leaves = 1, is_new = 2, bends = 4 };
  std::uint8_t flag_of(int i) const { return flag[index(i)]; }
  const CaptureBox& last_box(int i) const {
    return (flag_of(i) & leaves) != 0 ? before[index(i)] : box.of(i);
  }
  void begin_search(std::size_t count);
  void leave(int i, const CaptureBox& other);
};

class FeaturePairs {
 public:
  PairList face_face;             ///< faces whose boxes meet; twice the same: its opposite sides
  PairList round_face;            ///< edges that are beams or particles, and faces
  PairList node_face, edge_edge;  ///< features of pairs that are open; debris and faces; beams and particles
  SearchCounts counts;

  /// At the start of each step: whether a search is due, or edges are paired now that were not by lengths.
  bool begin_step(const SurfaceFeatures& features, const Surface& surface, const FeatureMotion& motion,
                  ThreadTeam& team);
  /// Whether some node's step ends outside of its box, a face bends more than it did, or there has been no
  /// search since `expire`.
  bool is_due(const SurfaceFeatures& features, const Surface& surface, const FeatureMotion& motion,
              ThreadTeam& team);
  /// The same after the solution of a step at whose start no search was due, or was made.
  bool is_due_after_solution(const SurfaceFeatures& features, const Surface& surface,
                             const FeatureMotion& motion, ThreadTeam& team);
  /// Before a search: constraints that stay in the list.
  void hold(std::span<const Contact> constraints) { flat_.hold(constraints); }
  /// Renew the pairs of faces that have left their boxes, or, if these are many, all; then the paths of the
  /// motion restart. \throws TooManyNear where there is no depth. \param depth to which features of different
  /// bodies are paired, at once; not empty: a face is flat for all pairs or none
  void find(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
            const ContactOptions& options, FeatureMotion& motion, ThreadTeam& team,
            const SearchedDepth& depth = {});
  /// Open the pairs of faces that may come near in this step, or within a surplus of its predicted motion.
  /// \throws TooManyNear
  void open_near(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                 const ContactOptions& options, FeatureMotion& motion, double surplus, ThreadTeam& team);
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
  const SurfaceFlatness& flatness() const { return flat_; }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(face_face, round_face, node_face, edge_edge, counts, face_blocks_, round_blocks_, reach_, flat_,
            faces_.box, rounds_.box, debris_.box, face_radius_, round_radius_, round_of_node_, debris_node_,
            changes_, kept_, searches_, most_pairs_, most_open_, met_at_rest_);
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
  static Scene scene_of(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                        const ContactOptions& options, const SearchedDepth& depth);

  bool is_inside(std::size_t slave, const FeatureMotion& motion, double steps) const;
  /// Length by which the box of a node exceeds its place.
  static double scale_of(std::size_t slave, const Scene& scene, const FeatureMotion& motion);
  void place(std::size_t slave, const Scene& scene, const FeatureMotion& motion);
  template <std::size_t Count>
  CaptureBox box_of(const std::array<int, Count>& nodes) const {
    CaptureBox box = empty_box;
    for (int node : nodes) box.include(reach_[index(node)]);
    return box;
  }
  CaptureBox face_box(const Scene& scene, int face) const;
  CaptureBox round_box(const Scene& scene, int edge) const;
  CaptureBox debris_box(const Scene& scene, int slave) const;
  void measure_radii(const Scene& scene);
  void list_rounds_of_nodes(const Scene& scene);
  void list_debris(const Scene& scene);

  bool collect_leaving(const Scene& scene, const FeatureMotion& motion, ThreadTeam& team);
  void mark_changes(const Scene& scene);
  void close_up();
  void watch_paired_edges(const Scene& scene, FeatureMotion& motion);
  void start_over(const Scene& scene, FeatureMotion& motion, ThreadTeam& team);
  void lay_boxes_of_leaving(const Scene& scene, const FeatureMotion& motion);
  void add_pairs(const Scene& scene, FeatureMotion& motion, ThreadTeam& team);
  /// PairRecord::one_piece
  std::uint8_t one_piece_of_faces(const Scene& scene, int first, int second) const;
  std::uint8_t one_piece_of_round(const Scene& scene, int edge, int face) const;

  template <class Kind>
  void open_kind(const Scene& scene, const Kind& kind, PairBlocks& blocks, double surplus,
                 FeatureMotion& motion, ThreadTeam& team);
  void open_all(const Scene& scene, FeatureMotion& motion);
  void open(const Scene& scene, Parents parents, std::size_t pair, FeatureMotion& motion);
  /// Whether the boxes of a pair part, or it has changed.
  static bool parts(const SearchedBoxes& a, int i, const SearchedBoxes& b, int j);
  template <class Kind>
  void drop_of_kind(const Scene& scene, const Kind& kind, const SearchedBoxes& firsts, ThreadTeam& team);
  void drop_pairs(const Scene& scene, const FeatureMotion& motion, ThreadTeam& team);
  void add_edges(const Scene& scene, FeatureMotion& motion, const PairRecord& record, int parent, int e,
                 int other);
  void pair_edges(const Scene& scene, FeatureMotion& motion, const PairRecord& pair);
  void add_hidden(const Scene& scene, FeatureMotion& motion);
  static bool owns_opposite_sides(const Scene& scene, int face);
  Spacing node_face_spacing(const Scene& scene, int slave, int face) const;
  Spacing edge_edge_spacing(const Scene& scene, int first, int second) const;
  bool boxes_meet(const Scene& scene, int slave, int face) const;
  bool boxes_meet(const Scene& scene, const EdgeFeature& a, const EdgeFeature& b) const;

  PairBlocks face_blocks_, round_blocks_;  ///< of pairs of faces, and of beams and particles with faces
  std::vector<CaptureBox> reach_;          ///< of each slave node: where it may be until the next search
  SurfaceFlatness flat_;
  SearchedBoxes faces_, rounds_, debris_;
  std::vector<std::uint8_t> node_flag_;             ///< as those of the faces at each slave node
  std::vector<double> face_radius_, round_radius_;  ///< largest of the features of each
  std::vector<int> round_of_node_;                  ///< of each slave node: its first beam or particle; -1
  std::vector<int> debris_node_;                    ///< slaves, ascending

  /// Features that are new, have changed, or are no more.
  struct Young {
    std::vector<int> node, face, edge, grown;
    bool all = false;  ///< before the first search
    bool empty() const { return node.empty() && face.empty() && edge.empty() && !all; }
    void clear() {
      for (std::vector<int>* list : {&node, &face, &edge, &grown}) list->clear();
      all = false;
    }
    void sort() {
      for (std::vector<int>* list : {&node, &face, &edge, &grown}) std::sort(list->begin(), list->end());
    }
    /// Once they are sorted.
    static bool is_in(const std::vector<int>& list, int i) {
      return std::binary_search(list.begin(), list.end(), i);
    }
    /// Whether an edge, or a node of it.
    bool contains(const SurfaceFeatures& features, int edge) const;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(node, face, edge, grown, all);
    }
  } changes_;  ///< since the last search
  /// Pairs of features taken out in a search: those that wait and, if it followed a change, those with radii.
  struct KeptPairs {
    std::vector<std::uint64_t> radii, waiting;  ///< ascending
    void add(const PairRecord& pair, const Young& young);
    void sort();
    Spacing spacing_of_new(int a, int b, bool is_young) const;
    void clear() {
      radii.clear();
      waiting.clear();
    }
    template <class Archive>
    void serialize(Archive& archive) {
      archive(radii, waiting);
    }
  };
  /// Of the last search, until pairs are opened again.
  struct Kept {
    KeptPairs node_face, edge_edge;
    Young young;  ///< ascending
    void clear() {
      node_face.clear();
      edge_edge.clear();
      young.clear();
    }
    template <class Archive>
    void serialize(Archive& archive) {
      archive(node_face, edge_edge, young);
    }
  } kept_;
  std::vector<int> awake_;  ///< working space, as what follows
  std::vector<std::size_t> near_;
  std::vector<CaptureBox> query_;
  std::vector<std::uint8_t> paired_;  ///< of each edge: whether it is, or is a beam or particle
  enum class PairFate : std::uint8_t { stays, bends, closes, leaves };
  std::array<std::vector<PairFate>, 2> fate_;  ///< in a search, of each pair, by Parents
  PairFate fate_of(int parent) const { return fate_[index(parents_of(parent))][place_of_parent(parent)]; }
  std::vector<std::uint64_t> bending_;  ///< edges that are paired in pairs with faces that bend
  std::uint64_t searches_ = 0;
  std::uint64_t most_pairs_ = 0;   ///< of `counts`, in this search
  std::uint64_t most_open_ = 0;    ///< pairs of features until the next search
  std::uint64_t met_at_rest_ = 0;  ///< boxes
};

/// Distance beyond touching at which constraints are formed, over the smallest edge.
inline constexpr double proximity_band = 0.02;

}  // namespace brio
