#pragma once
/// Nodes of the surface at rigid walls. Each is a constraint row, so that the impulses of walls and contacts
/// are found together.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/enforcement/impulse_work.hpp"
#include "contact/features/feature_motion.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// A plane that nodes cannot pass, at the start of a step.
struct ContactWall {
  Vector3d point, normal;  ///< the normal of unit length, into the free side
  Vector3d velocity;
  double friction = 0;  ///< Coulomb's coefficient
};

/// A node in contact with a wall, and its impulses.
struct NodeAtWall {
  int wall = 0;
  int slave = 0;
  double impulse = 0;
  Vector3d friction{0, 0, 0};
};

struct NodesAtWalls {
  std::vector<NodeAtWall> touch;      ///< of this step, first the predicted ones, by wall and slave
  std::vector<NodeAtWall> last;       ///< of the step before, by wall and slave
  std::vector<ImpulseOnWall> push;    ///< on each wall, in this step; empty: none
  std::vector<std::uint8_t> touches;  ///< of each wall and slave: whether it is listed

  /// Replace the touches by those of nodes that may reach a wall in this step, with impulses as they were.
  /// \param band height below which nodes are listed whatever their motion
  void find(std::span<const ContactWall> walls, const Surface& surface, const FeatureMotion& motion,
            double dt, double band, double step_ratio);
  /// Append nodes that end the step behind a wall by more than a tolerance and are not listed.
  /// \returns whether there are any
  bool find_missed(std::span<const ContactWall> walls, const Surface& surface, const FeatureMotion& motion,
                   double dt, double tolerance);

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(touch);
  }
};

/// After a solution, of which each row has a residual: rows at walls, one by one, so that their nodes end the
/// step in front. Impulses only grow.
void project_wall_rows(ConstraintRows& rows, std::span<VelocityBlock> blocks);

}  // namespace brio
