#pragma once
/// Overlaps with rigid walls that a mesh begins with. As in contact (contact/start/initial_gap.hpp), small
/// ones are removed before the first step by moving nodes, so that they cost neither strain nor energy: what
/// is formed from the mesh must be formed afterwards.

#include <span>
#include <vector>

#include "src/deck/mesh.hpp"
#include "src/model/model.hpp"

namespace brio {

/// Puts nodes that begin behind a wall onto it, by the shortest way that their prescribed components leave;
/// nodes of rigid parts stay. \param limit largest way, over the shortest distance of two nodes of an element
/// \returns one entry for each part and wall that overlap
/// \throws BuildError at the place of the wall, naming part, node and depth, where a node lies deeper or
/// cannot be moved
std::vector<InitialOverlap> remove_overlap_with_walls(std::span<const Mesh> meshes, double limit,
                                                      Model& model);

/// \throws BuildError where a node lies behind a wall nevertheless: others have moved it there.
void expect_nothing_behind_walls(std::span<const Mesh> meshes, Model& model);

}  // namespace brio
