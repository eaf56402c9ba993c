#pragma once
/// Lengths of edges, and widths of the narrower face across sides, as they are now and then measured: what is
/// not longer than a side is wide is not paired with it where it is flat (flatness.hpp).
///
/// They are measured at fixed numbers of steps and when edges come to be, never when pairs are searched for,
/// so that results do not depend on that.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "src/base/index.hpp"
#include "src/base/parallel.hpp"

namespace brio {

class EdgeLengths {
 public:
  /// Of all edges, at the start of the step.
  void measure(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team);
  /// The surface has changed: of those edges, which are new or have changed.
  void change(const SurfaceFeatures& features, const FeatureMotion& motion, std::span<const int> edges);
  /// Of a step: now and then lengths are measured again. \returns whether any edge has become longer, or any
  /// side narrower, than what is kept
  bool follow(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team);
  /// Edges of which it has told so, until the next step.
  std::span<const int> strained() const { return strained_; }

  bool is_measured() const { return !length_.empty(); }
  /// Whether an edge is no longer than a side is wide.
  bool spans(int side, int edge) const { return length_[index(edge)] <= longest * width_[index(side)]; }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(length_, width_, steps_);
  }

 private:
  /// With what is measured now and then, edges are up to 1.1 times as long as sides are wide.
  static constexpr float longest = 1.05F, most_change = 1.02F;
  static constexpr std::uint64_t steps_between = 128;
  static constexpr std::size_t edges_a_range = 1024;

  void make_room(std::size_t edges);

  std::vector<float> length_;  ///< of each edge
  std::vector<float> width_;   ///< of sides with two faces; 0: of others
  std::vector<int> strained_;
  std::vector<std::vector<int>> strained_of_range_;
  std::uint64_t steps_ = 0;
};

}  // namespace brio
