#pragma once
/// Beams, particles and edges nearer to each other than thickness and radius allow.

#include "contact/audit/audit.hpp"
#include "contact/audit/audit_surface.hpp"

namespace brio {

/// Pairs whose distance falls short of the sum of radii by more than a tenth:
///
/// |                   | beam | particle          | free edge of shells | edge of solids | other edge of
/// shells | | ---               | ---  | ---               | ---                 | ---            | --- | |
/// beam              | x    | x                 | x                   | x              | of other bodies | |
/// particle          |      | of another body   | by its node         | by its node    | by its node | | free
/// edge         |      |                   | inside of both      | inside of both | by its node          |
///
/// Edges of solids have no radius; what crosses them crosses faces. Pairs that share a node, or a face of
/// one body, and pairs of one body that lie so by the mesh are left out.
Audit find_segments_too_close(const ContactScene& scene, const AuditedSurface& surface, ThreadTeam& team);

}  // namespace brio
