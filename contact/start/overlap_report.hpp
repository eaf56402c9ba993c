#pragma once
/// What is known of initial overlaps, by pairs of parts.

#include <array>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "contact/features/features.hpp"
#include "contact/start/initial_gap.hpp"
#include "contact/start/retraction.hpp"
#include "contact/start/sided_pairs.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// Tolerance of a missing gap, over the scale: rounding.
inline constexpr double resolved_share = 1e-9;

/// By how much the radii of a pair overlap, without their skins.
inline double overlap(const SidedPair& pair) { return -pair.contact.gap - pair.skin; }

class OverlapReport {
 public:
  OverlapReport(const SurfaceFeatures& features, const Surface& surface)
      : features_(features), surface_(surface) {}

  void add(const TouchingPair& pair);
  void add(const SidedPair& pair);
  /// How far nodes were moved. \param start position of each slave node before
  void add_motion(const Nodes& nodes, std::span<const Vector3d> start);
  bool empty() const { return entry_.empty(); }
  std::vector<InitialOverlap> take() { return std::move(entry_); }

 private:
  std::size_t entry_of(const std::array<int, 2>& parts);
  int part_of(int slave) const;

  const SurfaceFeatures& features_;
  const Surface& surface_;
  std::vector<InitialOverlap> entry_;
  std::map<std::array<int, 2>, std::size_t> number_;  ///< of two parts, in `entry_`
  std::vector<std::set<int>> near_;                   ///< nodes of each entry
};

}  // namespace brio
