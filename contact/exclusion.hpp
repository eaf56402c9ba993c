#pragma once
/// Pairs that are never tested: they touch because they are one piece, not because they met.

#include <vector>

#include "contact/surface.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// The faces that each slave node is never tested against, ascending:
/// - faces it belongs to, and the other sides of their elements;
/// - for shells also the faces around it that can be reached along the shell within pi/2 of the contact
/// thickness
///   in the reference configuration. A shell of thickness t cannot be folded to a middle radius below t/2; on
///   that tightest fold points an arc s < pi/2 t apart have a chord t sin(s/t) < t without touching. The rule
///   follows from the thickness alone, so the same scene behaves alike on any mesh.
Lists excluded_faces(const Surface& surface, const Nodes& reference);

/// Whether the face is among the excluded ones of the slave.
bool is_excluded(const Lists& excluded, int slave, int face);

}  // namespace brio
