#pragma once
/// Erosion of contact surfaces: their elements are deleted. Only scenes that were made erodible carry this;
/// the work of a deletion is proportional to what is deleted.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contact/surface/exclusion.hpp"
#include "contact/surface/surface_topology.hpp"

namespace brio {

struct ContactScene;

struct ContactErosion {
  SurfaceTopology topology;
  ErodingExclusion exclusion;
  SurfaceChange change;        ///< by the last deletion
  std::uint64_t search = 0;    ///< number of the last search when numbers were retired
  bool keeps_numbers = false;  ///< numbers of faces are not taken over: initial overlaps are excluded by them

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(topology, search);
  }
};

/// Prepare a scene, made from these parts, for deletions.
void make_erodible(ContactScene& scene, std::span<const SurfacePart> parts, const Nodes& nodes);

/// Delete elements, in any order, between two steps: contacts of their faces end, newly exposed sides and
/// their nodes are in contact from the next call of `resolve` on, and all other contacts continue.
void erode(ContactScene& scene, std::span<const SurfaceElement> deleted);

}  // namespace brio
