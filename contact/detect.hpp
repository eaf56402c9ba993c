#pragma once
/// From candidates to contacts: the detailed check.
///
/// Geometry is that of the beginning of the step (so that the impulses keep angular momentum), velocities are
/// the predicted ones. A node may have several contacts with one body, in distinct directions: one for each
/// place of the body that is locally the closest. Which side of a closed body a node is on is told by the
/// pseudo-normal at the closest place of the whole body, so that a face the node is outside of has a veto
/// over all those behind it.

#include <span>
#include <vector>

#include "contact/candidates.hpp"
#include "contact/near_faces.hpp"
#include "contact/pair.hpp"
#include "contact/surface.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// What the detailed check reads.
struct Scenery {
  const Surface& surface;
  const Candidates& candidates;
  const ContactOptions& options;
  const Nodes& nodes;
  const Travel& travel;
  std::span<const Contact> last;  ///< contacts of the last step, by slave
  SweptFaces& swept;
};

/// Contacts of consecutive slave nodes, found by one task.
struct DetectionPiece {
  std::vector<Contact> contact;
  NearFaces near;
};

struct Detection {
  SweptFaces swept;
  std::vector<DetectionPiece> piece;
};

/// Replace `contacts` by those of this step, ordered by slave node.
void detect(Detection& detection, const Surface& surface, const Candidates& candidates,
            const ContactOptions& options, const Nodes& nodes, const Travel& travel,
            std::span<const Contact> last, ThreadTeam& team, std::vector<Contact>& contacts);

}  // namespace brio
