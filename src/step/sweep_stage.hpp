#pragma once
/// Stages of a time step that concern elements: internal forces, mass scaling, deletion.

#include "src/model/model.hpp"

namespace brio {

/// Internal forces and the stable time step of all elements. \return the increments of their energies \throws
/// Breakdown for an inverted element or a value that is not a number
Contribution sweep_elements(Model& model, ThreadTeam& team);

/// Mass that the deck's mass scaling adds after the sweep. \throws Breakdown
Contribution add_mass(Model& model);

/// Deletes the elements listed by `model.sweep_results`, and updates loads, contact surfaces and chunks;
/// after the sweep, whose order of elements it changes, and before contact, whose surfaces it opens.
Contribution erode_elements(Model& model, ThreadTeam& team);

/// Releases tied nodes whose force is beyond that of their connection; after deletion.
Contribution fail_ties(Model& model);

/// Removes the nodes whose last element was deleted in the step before, where the deck asks for it.
Contribution remove_freed_nodes(Model& model);

}  // namespace brio
