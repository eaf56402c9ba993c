#pragma once
/// What the contacts of a step come to: impulses, work, reactions and counts.

#include <cstddef>
#include <span>

#include "contact/features/rigid_motion.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

struct ContactScene;

/// From the rows of a step that is solved: impulses of contacts, of slave nodes, of bodies and on walls, work
/// and counts of the step, what is kept for the next one, and the totals. \param walls number of rigid walls
void account_step(ContactScene& scene, Nodes& nodes, std::span<RigidMotion> bodies, std::size_t walls,
                  ThreadTeam& team);

}  // namespace brio
