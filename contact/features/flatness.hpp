#pragma once
/// Flat faces and flat sides: edges that are no separate features.
///
/// A segment that crosses a flat polygon crosses its rim, or has an end that crosses the polygon. So
/// diagonals of flat faces are not paired; nor is a side at which two faces lie in one plane paired with
/// edges that are not longer than these faces are wide: the ends of such an edge are nodes in contact with
/// these faces or their neighbours, and over its length the surface bends by little more than at the side.
///
/// A face counts as flat where it is convex and its hull is thinner than a quarter of the skin, or for what
/// keeps its radius, than 0.03 of that; a side, where its faces lie on both sides of it and the hull of both
/// is so thin. Pairs keep twice as much as their least distance (crossing_check.hpp).

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/features/edge_lengths.hpp"
#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "contact/pair.hpp"
#include "src/base/index.hpp"

namespace brio {

/// Thickness of the hull up to which shapes are flat: over the skin, and for pairs that keep their radii,
/// over the radius of the face if that is more.
inline constexpr double flat_share_of_skin = 0.25, flat_share_of_radius = 0.03;

/// What a shape is flat for: pairs that keep two skins, and so all; pairs that keep their radii; none.
enum class Flatness : std::uint8_t { all, radii, none };

/// Thickness of the hull of faces with that radius below which they are flat.
double flat_thickness(const SurfaceFeatures& features, double radius, Flatness flatness);

/// Of a step.
enum class Moment : std::uint8_t { start, end };
/// Whether a flat shape hides one of two edges from the other.
struct FlatnessQuery {
  bool radii = false;  ///< that is what they keep
  Moment moment = Moment::start;
};

/// What is known of shapes of one kind.
struct FlatShapes {
  std::vector<Flatness> flat;
  std::vector<double> until;  ///< path of a shape until which it surely is as flat
  std::vector<int> list;      ///< of those that are flat, none twice

  /// Working space: of the list those that may bend in this step as predicted, by ranges, how many of each,
  /// and from which place on the list has grown since.
  std::vector<int> at_risk;
  std::vector<std::size_t> risks;
  std::size_t seen = 0;

  void forget(std::size_t count);
  void change(std::size_t count, std::span<const int> changed);
  /// No longer those that are not flat.
  void close_up();
  /// For all of them, so that steps allocate nothing.
  void make_room();
  bool is_flat(int i, bool radii) const {
    const Flatness flatness = flat[index(i)];
    return flatness == Flatness::all || (flatness == Flatness::radii && radii);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(flat, until, list);
  }
};

/// Faces that may come near others, and their sides; others count as not flat.
class SurfaceFlatness {
 public:
  /// No face is watched. \param finds_flat whether any will be found flat
  void forget(const SurfaceFeatures& features, bool finds_flat);
  /// Lengths of all edges, at the start of the step.
  void measure(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team) {
    lengths_.measure(features, motion, team);
  }
  /// Of each step, at its start. \returns whether edges are paired now that were not, by their lengths
  bool follow_lengths(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team) {
    return lengths_.follow(features, motion, team);
  }
  /// The surface has changed. \param faces, edges that are not flat until they are watched anew
  void change(const SurfaceFeatures& features, const FeatureMotion& motion, std::span<const int> faces,
              std::span<const int> edges);
  /// Before faces are watched: no shape of these edges will be found flat, as a pair that is a constraint is
  /// in the list until it parts. \param constraints of the last step, or of this one
  void hold(std::span<const Contact> constraints);
  /// A face and its sides, as they are over the present step.
  void watch(const SurfaceFeatures& features, const FeatureMotion& motion, int face);

  /// Whether a shape is no longer as flat as it was at the end of the step, as predicted.
  bool any_bends(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team);
  /// The same after a solution.
  bool any_bends_by_solution(const SurfaceFeatures& features, const Surface& surface,
                             const FeatureMotion& motion, ThreadTeam& team);
  /// Take over what shapes have become that bend more. \param mark that the flags of their faces get
  void take_over(const SurfaceFeatures& features, const FeatureMotion& motion, std::uint8_t mark,
                 std::vector<std::uint8_t>& flags, ThreadTeam& team);

  /// Whether two edges are paired. \param radii as what keeps them
  bool pairs(const SurfaceFeatures& features, int a, int b, bool radii) const {
    return are_of_one_face(features, a, b) ||
           (!hides(features, a, b, radii) && !hides(features, b, a, radii));
  }
  /// Whether two edges of a pair in the list are features of their own, whenever that was searched for: no
  /// flat shape hides either.
  bool are_features(const SurfaceFeatures& features, const FeatureMotion& motion, int a, int b,
                    const FlatnessQuery& query) const {
    return are_of_one_face(features, a, b) ||
           (!is_hidden(features, motion, a, b, query) && !is_hidden(features, motion, b, a, query));
  }
  /// Thickness below which the hull of a face is at the start of the step, so that edges beside it are
  /// constraints in place of its diagonals; 0: it is not flat. \param is_constraint the edge, in the step
  /// before
  double thickness_of_flat(const SurfaceFeatures& features, const FeatureMotion& motion, int face, bool radii,
                           bool is_constraint) const;

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(faces_, sides_, is_watched_, finds_flat_, side_node_, held_, lengths_);
  }

 private:
  /// Opposite sides, which a face that collapses keeps apart.
  static bool are_of_one_face(const SurfaceFeatures& features, int a, int b) {
    return features.edge[index(a)].shares_face(features.edge[index(b)]);
  }
  bool hides(const SurfaceFeatures& features, int flat, int other, bool radii) const {
    const EdgeFeature& edge = features.edge[index(flat)];
    if (edge.is_diagonal()) return faces_.is_flat(edge.face[0], radii);
    return sides_.is_flat(flat, radii) && lengths_.spans(flat, other);
  }
  bool is_held(const EdgeFeature& edge) const;
  bool is_hidden(const SurfaceFeatures& features, const FeatureMotion& motion, int flat, int other,
                 const FlatnessQuery& query) const;

  EdgeLengths lengths_;
  FlatShapes faces_, sides_;              ///< sides by edge; of diagonals and beams nothing
  std::vector<std::uint8_t> is_watched_;  ///< each face
  bool finds_flat_ = false;
  std::vector<std::array<int, 2>> held_;       ///< EdgeFeature::node, ascending
  std::vector<std::array<int, 6>> side_node_;  ///< of each side: its ends, then the others of either face
};

}  // namespace brio
