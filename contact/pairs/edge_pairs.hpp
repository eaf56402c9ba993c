#pragma once
/// Which edges are paired, and which of them are of one piece.

#include "contact/features/features.hpp"

namespace brio {

/// Not edges that share a node or a face, that are parts of one rigid body, or that the deck or a tie keeps
/// from touching; nodes meet beams alone, particles beams and particles of other bodies.
bool may_be_paired(const Surface& surface, const EdgeFeature& a, const EdgeFeature& b);

/// Whether a node of one is excluded from contact with a face of the other; beams: drawn within the tightest
/// fold of each other. \param excluded of each slave node: its excluded faces
bool are_of_one_piece(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                      const EdgeFeature& a, const EdgeFeature& b);

}  // namespace brio
