#pragma once
/// Stages of a time step that correct velocities where bodies meet: contact and rigid walls.

#include "src/model/model.hpp"

namespace brio {

/// Contact of all surfaces, after all other forces have changed velocities. \throws Breakdown where it cannot
/// be resolved: too many candidates, or rigid bodies of prescribed motion driven into each other
Contribution resolve_contact(Model& model, ThreadTeam& team);

/// Rigid walls, after contact.
Contribution stop_at_walls(Model& model);

}  // namespace brio
