#pragma once
/// The audit of lines: every line is compared with every other, and those that lie in one another are
/// counted. It shares with detection what lines there are and which of them may touch, nothing else.

#include "contact/scene.hpp"

namespace brio {

/// Crossings that were missed. One counts when it is deeper than a tenth of the sum of radii, or between
/// edges of solids of a tenth of the shorter one.
struct LineAudit {
  int crossed = 0;
  double deepest = 0;
  int deepest_node = -1;  ///< global number
};

/// Cost grows with the square of the number of lines.
LineAudit audit_lines(const ContactScene& scene, const Nodes& nodes, ThreadTeam& team);

}  // namespace brio
