#pragma once
/// Constraints of a mesh at rest, in which surfaces may still coincide or overlap. Here, and only here, sides
/// are needed: afterwards nothing crosses, and the side is where the features are (proximity.hpp).
///
/// A node outside of a closed surface is constrained by the rule of distances. A node inside or on it is
/// examined at the position that it would have outside: along the way to the closest point, on the face along
/// the normals of those of its faces that the node's own neighbours do not reach behind. There the rule of
/// distances gives the directions, and the gap is that of the node at its position; so a node in a groove is
/// constrained by both of its sides, one at a corner by the corner alone. Two edges of solids overlap where
/// each is behind both faces of the other, and they cross; this is examined only between bodies of which no
/// node lies in the other, as edges that are far from the surface would seem to overlap deeper than it is.
/// Where edges coincide, the normals of their faces tell. Shells, beams and particles are on the side on
/// which they are.

#include <array>
#include <vector>

#include "contact/features/features.hpp"
#include "contact/options.hpp"
#include "contact/pair.hpp"
#include "contact/pairs/feature_pairs.hpp"
#include "src/base/nodes.hpp"

namespace brio {

struct SidedPair {
  double distance = 0;  ///< of the middle surfaces; negative: inside
  /// Gap: distance over the radii, or two skins; negative where that is missing. No normal: in one place.
  Contact contact;
  double skin = 0;       ///< what of the radii is skin
  double scale = 0;      ///< length that overlap is measured against: of an edge, or the touching thickness
  bool is_apart = true;  ///< the surfaces are on their sides, by more than rounding
  bool spaced = true;    ///< by their radii; else by two skins, as they are one piece
  std::array<int, 2> feature{};  ///< node and face, or two edges
  std::array<int, 2> part{};
  std::array<int, 2> support{};  ///< what the closest points lie on
};

/// Features nearer than this share of the smallest edge coincide.
inline constexpr double coincident_share = 1e-6;

/// Replace `found` by what of the pairs is nearer than its radii and the band, those of nodes and faces by
/// node, then those of edges, in an order that depends on the surface alone.
/// \param depth to which overlaps are searched; the pairs contain all that are as near
void find_sided_pairs(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes,
                      const FeaturePairs& pairs, const SearchedDepth& depth, double band,
                      std::vector<SidedPair>& found);

}  // namespace brio
