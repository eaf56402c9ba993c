#pragma once
/// Deck and meshes to a model.

#include <span>

#include "src/base/breakdown.hpp"
#include "src/deck/coordinate_system.hpp"
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

/// Domains of a model, their chunks and ranges of nodes; part of `build`.
void cut_domains(Model& model, std::size_t least_elements = least_domain_elements);

/// Whether the deck lets a part touch others, or itself.
bool is_in_contact(const Deck& deck, const std::string& part);

/// Nodes of the model that a selection names, ascending.
std::vector<int> select_nodes(const NodeSelection& where, const Deck& deck, std::span<const Mesh> meshes,
                              const Model& model);

/// Prescribed motions and rigid walls. \throws BuildError
void constrain(const Deck& deck, std::span<const Mesh> meshes, Model& model);

/// Axes of a named coordinate system at each of some nodes; r and t are 0 for one on the axis of a
/// cylindrical system. \throws BuildError where no system is called so
std::vector<SystemAxes> axes_at_nodes(const Deck& deck, const std::string& name,
                                      const std::vector<int>& nodes, const std::string& place,
                                      const Model& model);
/// Those of a system whose axes are the same everywhere. \param what is along them \throws BuildError where
/// no rectangular one is called so
SystemAxes axes_everywhere(const Deck& deck, const std::string& name, const std::string& what,
                           const std::string& place);
/// \throws BuildError of a node without r and t.
[[noreturn]] void refuse_on_axis(const Model& model, std::size_t node, const std::string& system,
                                 const std::string& place);

/// What the deck wants in results beside what is always there: rotations of nodes; in the history probes,
/// motion of rigid bodies, forces. \throws BuildError
void prepare_output(const Deck& deck, Model& model);

}  // namespace brio
