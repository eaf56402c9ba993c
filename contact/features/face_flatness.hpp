#pragma once
/// Flat faces: their diagonals are no separate features.
///
/// An edge that crosses a flat polygon crosses its sides or corners, or has a node that crosses the face. A
/// face counts as flat where it is convex and its hull is thinner than a tenth of the skin, or for what keeps
/// its radius, than 0.03 of that.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "src/base/index.hpp"

namespace brio {

/// What a face is flat for: pairs that keep two skins, and so all; pairs that keep their radii; none.
enum class Flatness : std::uint8_t { all, radii, none };

/// Thickness of the hull of a face below which it is flat.
double flat_thickness(const SurfaceFeatures& features, std::size_t face, Flatness flatness);

/// How far every corner of a quadrilateral may move until its hull, between both diagonals, is thicker than
/// that, and until it is not convex; negative: it is.
struct FlatSlack {
  double thin, convex;
  double least() const { return std::min(thin, convex); }
};
FlatSlack flat_slack(const std::array<Eigen::Vector3d, 4>& at, double thickness);

class FaceFlatness {
 public:
  /// No face is flat.
  void forget(std::size_t faces);
  /// All faces anew, over the present step.
  void measure(const SurfaceFeatures& features, const FeatureMotion& motion);
  /// The surface has changed. \param changed faces that are not flat until they are measured
  void change(std::size_t faces, std::span<const int> changed);
  /// Whether a face is no longer as flat as it was at the end of the step.
  bool any_bends(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team);
  bool bends(const SurfaceFeatures& features, int face, const FeatureMotion& motion);
  /// Whether that has to be asked.
  bool may_bend(const SurfaceFeatures& features, int face, const FeatureMotion& motion) const;
  /// Take over what faces have become that bend more. \param mark that the flags of such faces get
  void take_over(const SurfaceFeatures& features, const FeatureMotion& motion, std::uint8_t mark,
                 std::vector<std::uint8_t>& flags, ThreadTeam& team);

  /// Whether an edge is paired, with what keeps their radii.
  bool pairs(const EdgeFeature& edge, bool radii) const {
    return !edge.is_diagonal() || !is_flat(edge.face[0], radii);
  }
  /// Thickness below which the hull of a face stays while its diagonals are not paired, with what keeps their
  /// radii; 0: they are.
  double thickness_of_flat(const SurfaceFeatures& features, int face, bool radii) const {
    const auto f = index(face);
    return is_flat(face, radii) ? flat_thickness(features, f, flat_[f]) : 0;
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(flat_, until_);
  }

 private:
  /// Path of a face until which its hull surely is as thin, and until which it surely is convex.
  struct Until {
    double thin = 0, convex = 0;
  };
  bool is_flat(int face, bool radii) const {
    const Flatness flatness = flat_[index(face)];
    return flatness == Flatness::all || (flatness == Flatness::radii && radii);
  }
  static bool may_reach(double path, const SurfaceFeatures& features, std::size_t face,
                        const FeatureMotion& motion);

  std::vector<Flatness> flat_;
  std::vector<Until> until_;
};

}  // namespace brio
