#pragma once
/// Time steps of the central difference method.

#include <functional>

#include "src/base/breakdown.hpp"
#include "src/model/model.hpp"

namespace brio {

/// First half of a time step: stresses and forces at the present time, the next time step, and the velocities
/// over it, corrected by supports, contact and walls. After it the model is complete at its time: energy and
/// momentum balance are up to date and results may be written. \throws Breakdown for an inverted element, a
/// collapsed step, or an energy error beyond `energy_error_limit`.
void update_velocities(Model& model, double energy_error_limit, ThreadTeam& team);

/// Second half: positions, and the time.
void update_positions(Model& model, ThreadTeam& team);

/// Looks at a model that is complete at its time. \return whether to go on
using Observer = std::function<bool(Model&)>;

/// Time steps up to the end time or until the observer ends them. The observer sees every complete state,
/// that of entry included: a model as built gets its first velocities before. \throws Breakdown
void run(Model& model, double energy_error_limit, ThreadTeam& team, const Observer& observe);

/// Audits contact at the present positions if the deck asks for it (contact/audit/audit.hpp). Called where
/// fields are written.
void audit_contacts(Model& model, ThreadTeam& team);

}  // namespace brio
