#pragma once
/// Loads, springs and initial velocities of a deck.

#include <span>

#include "src/deck/initial_state.hpp"
#include "src/deck/mesh.hpp"
#include "src/model/model.hpp"

namespace brio {

/// \throws BuildError where a set is not there, or a moment acts on what does not turn
void make_loads(const Deck& deck, std::span<const Mesh> meshes, Model& model);

/// Fastens springs to the nodes nearest to their ends, or to those of sets; what they store at the start is
/// energy of the start. \pre balances are set \throws BuildError where both ends are one mass, a node is
/// tied, or does not turn about an axis
void make_springs(const Deck& deck, std::span<const Mesh> meshes, Model& model);

/// Velocities of nodes, those of earlier results among them; a later condition takes the place of one before.
void set_initial_velocities(const Deck& deck, std::span<const Mesh> meshes, std::span<const PartState> states,
                            Model& model);

}  // namespace brio
