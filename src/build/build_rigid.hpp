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

/// Makes nodes of elements nodes of the rigid bodies whose nodes they share, or whose surface they are tied
/// to.
void join_nodes(Model& model);

/// Gives the bodies the masses and moments of inertia of joined nodes, which keep none.
void join_masses(Model& model);

/// Leaves prescribed motions of joined nodes to the bodies, where those have the same.
/// \throws BuildError where they do not, or a node would belong to two bodies or be tied as well
void release_joined(Model& model);

/// Bodies whose nodes are all among `nodes` (ascending), which lose them. Nodes that elements share with a
/// body stay among them.
/// \throws BuildError where some other nodes of a body are named: it moves as a whole.
std::vector<std::size_t> take_rigid(std::vector<int>& nodes, const NodeSelection& where, const Model& model);

/// Give the bodies their initial velocities. \throws BuildError where joined nodes are given others
void start_rigid_bodies(const Deck& deck, std::span<const Mesh> meshes, Model& model);

}  // namespace brio
