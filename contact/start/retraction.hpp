#pragma once
/// Solids with coincident faces: the faces are set back by the skin, each along its own normal, so that their
/// distance is two skins. No side has to be known, and no force: a seam between two floors opens below a
/// block that stands on its edge as it does elsewhere, whatever is prescribed of its nodes.

#include <array>
#include <vector>

#include "contact/features/features.hpp"
#include "contact/pairs/feature_pairs.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// Features of solids of two bodies that were nearer than two skins.
struct TouchingPair {
  std::array<int, 2> part{};
  int slave = 0;     ///< a node of the first
  double depth = 0;  ///< by which it lies in the second
};

/// Move nodes inward by what is missing of two skins: faces that touch, and of a node or an edge that touches
/// those of its faces that look against the other side; with them what lies in their planes. Of two bodies
/// the freer one makes all of the room, so that floors which are supported stay flush; of two that are rigid,
/// supported or free each half. Tied nodes stay.
/// \param pairs contain all that are nearer than two skins
/// \returns what was touching, in the order of pairs
std::vector<TouchingPair> retract_touching_faces(const SurfaceFeatures& features, const Surface& surface,
                                                 const FeaturePairs& pairs, Nodes& nodes);

}  // namespace brio
