#pragma once
/// Deck and meshes to a model.

#include <span>

#include "src/base/breakdown.hpp"
#include "src/deck/initial_state.hpp"
#include "src/deck/mesh.hpp"
#include "src/model/model.hpp"

namespace brio {

/// \param meshes one a part of the deck, in its order, placed
/// \param states of parts that begin with that of an earlier result
/// \throws BuildError for what only shows when the scene is put together: elements without volume, sets
/// without nodes,
///         initial overlap that is too large.
Model build(const Deck& deck, std::span<const Mesh> meshes, int threads = 1,
            std::span<const PartState> states = {});

/// Whether the deck lets a part touch others, or itself.
bool is_in_contact(const Deck& deck, const std::string& part);

/// Nodes of the model that a selection names, ascending.
std::vector<int> select_nodes(const NodeSelection& where, const Deck& deck, std::span<const Mesh> meshes,
                              const Model& model);

}  // namespace brio
