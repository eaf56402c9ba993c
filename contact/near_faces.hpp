#pragma once
/// Which of a slave node's candidates are near enough in a step for the detailed check: faces that sweep over
/// a place within reach of the node's path.
///
/// A pair that is not near sleeps: its clearance, the path on which it cannot become near, is stored, and the
/// pair is not looked at until node and face may have travelled that far (travel.hpp), the look-ahead of the
/// present step included. A node whose pairs all sleep costs one comparison. A search wakes all; a deletion
/// those nodes that it gave new faces or another radius. What is found to be near never depends on who
/// sleeps.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/candidates.hpp"
#include "contact/closest_point.hpp"
#include "contact/surface.hpp"
#include "contact/travel.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// The space that a side of a hexahedron and what it influences sweep over within the step: a box, and a slab
/// along the normal.
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

/// The faces near one slave node, the closest first.
struct NearFaces {
  std::vector<NearFace> face;

  /// A side of a hexahedron that is at least so far away.
  struct Side {
    double least_distance;
    double reach;  ///< farther away it matters only to nodes inside of its body
    int face;
  };
  std::vector<Side> side;  ///< working space
};

/// The faces that are candidates, as they move in one step.
struct SweptFaces {
  double dt = 0;
  Eigen::Vector3d frame;  ///< velocity of the frame in which capture boxes move least
  bool may_sleep = true;  ///< off only to show that sleep changes nothing
  std::size_t woken = 0;  ///< slave nodes whose pairs were all woken at the beginning of the step

  /// Once a step, when candidates are up to date.
  void begin_step(const Surface& surface, const Candidates& candidates, const ContactOptions& options,
                  const Nodes& nodes, const Travel& travel, ThreadTeam& team);

  /// Whether nothing can be near a slave node.
  bool sleeps(const Travel& travel, int slave) const {
    return travel.so_far(slave) + travel.ahead(slave) < wake_of_slave_[static_cast<std::size_t>(slave)];
  }

  /// On what path at least a slave node and candidate k of its list cannot become near.
  double clearance(const Travel& travel, const Candidates& candidates, int slave, std::size_t k) const {
    const auto face = static_cast<std::size_t>(candidates.faces_of.of(slave)[k]);
    return wake_[static_cast<std::size_t>(candidates.faces_of.first[static_cast<std::size_t>(slave)]) + k] -
           travel.so_far(slave, motion_[face].path);
  }

  /// Replace `near` by the faces near a slave node. Of closed bodies that the node is outside of, those that
  /// it cannot reach within the step are left out, but for the closest of each body and where everything is
  /// asked for. Changes what belongs to this slave only.
  void find(const Surface& surface, const Candidates& candidates, const ContactOptions& options,
            const Nodes& nodes, const Travel& travel, int slave, bool everything, NearFaces& near);

 private:
  friend class Lookout;

  void wake(const Candidates& candidates, int slave);
  void wake_all(const Surface& surface, const Candidates& candidates);
  void wake_renewed(const Surface& surface, const Candidates& candidates);
  void add_faces(const Surface& surface, const Candidates& candidates);
  void follow(const Surface& surface, const Travel& travel, ThreadTeam& team);

  /// Of the corners of a face, the longest.
  struct Motion {
    double path;
    double ahead;
  };

  std::vector<SweptFace> solid_;  ///< by face; of those that are candidates and sides of hexahedra
  std::vector<int> solids_;       ///< these faces
  std::vector<Motion> motion_;    ///< by face; of those that are candidates
  std::vector<int> faces_;        ///< these faces
  std::vector<double> wake_;      ///< of each candidate pair: travel at which it may be near
  std::vector<double> wake_of_slave_;
  std::size_t faces_known_ = 0;  ///< of Candidates::face, taken over so far
  std::uint64_t search_ = 0;     ///< number of the search that the pairs are from
};

}  // namespace brio
