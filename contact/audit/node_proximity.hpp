#pragma once
/// Nodes nearer to faces than thickness and radius allow.

#include "contact/audit/audit.hpp"
#include "contact/audit/audit_surface.hpp"

namespace brio {

/// Nodes of all kinds to shells, nodes with a radius (of shells, beams, particles) to sides of hexahedra of
/// other bodies as well. A distance counts when it falls short by more than a tenth of the touching distance,
/// or of the face's shortest edge where that is less.
Audit find_nodes_too_close(const ContactScene& scene, const AuditedSurface& surface, ThreadTeam& team);

}  // namespace brio
