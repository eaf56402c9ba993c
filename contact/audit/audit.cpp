#include "contact/audit/audit.hpp"

#include "contact/audit/audit_surface.hpp"
#include "contact/audit/crossings.hpp"
#include "contact/audit/inside.hpp"
#include "contact/audit/node_proximity.hpp"
#include "contact/audit/segment_proximity.hpp"

namespace brio {

Audit& Audit::operator+=(const Audit& other) {
  crossings += other.crossings;
  deep_crossings += other.deep_crossings;
  too_close += other.too_close;
  swallowed += other.swallowed;
  deepest_crossing.keep_deeper(other.deepest_crossing);
  deepest_too_close.keep_deeper(other.deepest_too_close);
  return *this;
}

Audit audit(const ContactScene& scene, const Nodes& nodes, ThreadTeam& team) {
  const AuditedSurface surface(scene.surface, nodes);
  const Crossings crossings = find_crossings(surface, team);
  Audit found = crossings.found;
  found.swallowed = count_swallowed(surface, crossings, team);
  found += find_nodes_too_close(scene, surface, team);
  found += find_segments_too_close(scene, surface, team);
  return found;
}

}  // namespace brio
