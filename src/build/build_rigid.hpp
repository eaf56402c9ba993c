#pragma once
/// Rigid bodies of a deck.

#include <span>
#include <vector>

#include "src/deck/mesh.hpp"
#include "src/model/model.hpp"

namespace brio {

/// Bodies of the rigid parts, at rest, without prescribed motion; the nodes of the parts are known.
/// \throws BuildError
void make_rigid_bodies(const Deck& deck, std::span<const Mesh> meshes, Model& model);

/// Take over positions of nodes that were moved to make the contact gap; mass and inertia stay those of the
/// mesh.
void measure_arms(Model& model);

/// Bodies whose nodes are all among `nodes` (ascending), which lose them.
/// \throws BuildError where some nodes of a body are named and others not: it moves as a whole.
std::vector<std::size_t> take_rigid(std::vector<int>& nodes, const NodeSelection& where, const Model& model);

/// Give the bodies their initial velocities.
void start_rigid_bodies(const Deck& deck, std::span<const Mesh> meshes, Model& model);

}  // namespace brio
