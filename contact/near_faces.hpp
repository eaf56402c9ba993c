#pragma once
/// Which of a slave node's candidates are near enough in a step for the detailed check: faces that sweep over
/// a place within reach of the node's path.

#include <span>
#include <vector>

#include "contact/candidates.hpp"
#include "contact/closest_point.hpp"
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

/// A face near one slave node.
struct NearFace {
  int face;
  double distance;
  ClosestPoint closest;
  bool inside = false;  ///< of the closest face of a closed body: the node is inside that body
};

/// The faces that are candidates, as they move in one step.
struct SweptFaces {
  double dt = 0;
  Eigen::Vector3d frame;           ///< velocity of the frame in which capture boxes move least
  std::vector<SweptFace> solid;    ///< by face; of those that are candidates and sides of hexahedra
  std::vector<ShellExtent> shell;  ///< by face; of those that are candidates and shells
};

void sweep(SweptFaces& swept, const Surface& surface, const Candidates& candidates,
           const ContactOptions& options, const Nodes& nodes, const Spread& velocities, double dt,
           ThreadTeam& team);

/// Replace `near` by the faces near a slave node, the closest first. Faces of closed bodies that the node is
/// well outside of are left out, but where everything is asked for.
void find_near_faces(const SweptFaces& swept, const Surface& surface, const Candidates& candidates,
                     const ContactOptions& options, const Nodes& nodes, int slave, bool everything,
                     std::vector<NearFace>& near);

}  // namespace brio
