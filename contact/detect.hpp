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
#include "contact/closest_point.hpp"
#include "contact/pair.hpp"
#include "contact/shell_extent.hpp"
#include "contact/surface.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// The space that a face and what it influences sweep over within the step: a box, and a slab along the
/// normal.
struct SweptFace {
  CaptureBox box;
  Eigen::Vector3d normal;
  double lower;
  double upper;
  double upper_outside;  ///< as far as nodes outside of a closed body matter
};

/// What the detailed check reads.
struct Scenery {
  const Surface& surface;
  const Candidates& candidates;
  const ContactOptions& options;
  const Nodes& nodes;
  double dt;
  Eigen::Vector3d frame;               ///< velocity of the frame in which capture boxes move least
  std::span<const Contact> last;       ///< contacts of the last step, by slave
  std::span<const SweptFace> swept;    ///< of the sides of hexahedra that are candidates
  std::span<const ShellExtent> shell;  ///< of the shells that are candidates
};

/// A face near one slave node.
struct NearFace {
  int face;
  double distance;
  ClosestPoint closest;
  bool inside = false;  ///< of the closest face of a closed body: the node is inside that body
};

/// Contacts of consecutive slave nodes, found by one task.
struct DetectionPiece {
  std::vector<Contact> contact;
  std::vector<NearFace> near;
};

struct Detection {
  std::vector<SweptFace> swept;
  std::vector<ShellExtent> shell;
  std::vector<DetectionPiece> piece;
};

/// Replace `contacts` by those of this step, ordered by slave node.
void detect(Detection& detection, const Surface& surface, const Candidates& candidates,
            const ContactOptions& options, const Nodes& nodes, const Spread& velocities, double dt,
            std::span<const Contact> last, ThreadTeam& team, std::vector<Contact>& contacts);

}  // namespace brio
