#pragma once
/// The audit: every node is compared with every face, every line with every line, by other means than
/// detection uses, and what should have been stopped and was not is counted. It shares with detection the
/// surface, the touching distance and the excluded pairs, nothing else; no search, no history.

#include "contact/scene.hpp"

namespace brio {

/// Missed contacts. A penetration counts when it is deeper than a tenth of the smaller of the face's shortest
/// edge and, where shells meet, the touching distance.
struct BruteForceAudit {
  int inside_solids = 0;     ///< nodes that lie too deep inside a closed body, their own folded body included
  int shells_too_close = 0;  ///< nodes nearer to the middle surface of a shell than their thickness allows
  int shells_pierced = 0;    ///< edges and beams that cross the middle surface of a shell
  int lines_crossed = 0;     ///< pairs of lines that lie in one another
  double deepest = 0;        ///< of the penetrations that count
  int deepest_node = -1;     ///< global number

  BruteForceAudit& operator+=(const BruteForceAudit& other);
  int missed() const { return inside_solids + shells_too_close + shells_pierced + lines_crossed; }
};

/// Cost grows with the square of the size of the surface.
BruteForceAudit brute_force_audit(const ContactScene& scene, const Nodes& nodes, ThreadTeam& team);

}  // namespace brio
