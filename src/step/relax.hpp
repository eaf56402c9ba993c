#pragma once
/// Dynamic relaxation: a scene comes to rest before its run.

#include "src/model/model.hpp"

namespace brio {

/// Steps under the loads of time 0, from zero velocities and with supports and walls that stand, until the
/// scene is at rest. Kinetic damping (Cundall 1976): whenever the kinetic energy has passed a maximum, the
/// scene starts again from rest. At rest is a scene whose kinetic energy stays below tolerance^2 times the
/// internal energy for twice as many steps as the longest rise of the kinetic energy took: a mode that is
/// not at its equilibrium would show it by then.
///
/// After that the model is at time 0 and step 0, with its initial velocities, and with the internal energy of
/// the rest as part of the energy at the start.
/// \throws Breakdown where it does not come to rest, or an element breaks down.
void relax(const Relaxation& settings, Model& model, ThreadTeam& team);

}  // namespace brio
