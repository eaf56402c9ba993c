#pragma once
/// Constraint rows of contacts, and their unknowns: translations and rotations of nodes and of rigid bodies.
/// Tied nodes (ties.hpp) are no unknowns: they are expanded into the corners of their main face, over chains
/// of ties and with their arms.
///
/// Without friction both impulses of a row act along the line through the closest points. Friction acts at
/// one point of that line on both sides, so that linear and angular momentum are conserved to rounding. The
/// position of that point depends on what resists the couple of a side:
///   rigid body                    the body, at any distance
///   shell, beam                   the rotations of its nodes
///   solid                         the tilt of the faces at the closest point, weighted by alignment;
///                                 none is preferred, so mirror images are treated alike
///   particle                      nothing: the point lies on it
/// Between sides of the same kind the point divides the distance in the ratio of their radii; for a node of a
/// solid it is the node. Two particles, and sides without rotations and faces, have no friction.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/enforcement/constraint_row.hpp"
#include "contact/enforcement/impulse_work.hpp"
#include "contact/enforcement/nodes_at_walls.hpp"
#include "contact/features/features.hpp"
#include "contact/features/rigid_motion.hpp"
#include "contact/pair.hpp"
#include "contact/surface/surface.hpp"
#include "contact/ties/ties.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// Owner of the velocity of a block.
struct BlockOwner {
  enum class Kind : std::uint8_t { node, rotation_of_node, body, rotation_of_body };
  Kind kind = Kind::node;
  int index = 0;  ///< global node, or rigid body
};

/// Allocates nothing once as many rows have been seen.
struct ContactRows {
  ConstraintRows rows;  ///< one per contact
  std::vector<VelocityBlock> block;
  std::vector<BlockOwner> owner;        ///< of each block
  std::vector<Vector3<double>> before;  ///< velocities at the half step before
  std::vector<BlockPlace> place;        ///< of each block
  std::vector<int> block_of_node;       ///< of each global node; -1: no row names it
  std::vector<int> block_of_rotation;   ///< likewise
  std::vector<int> block_of_body;       ///< translation; the rotation follows
  std::vector<SymmetricTensor<double>> body_inertia;

  /// A node of a side with its share of the motion of the contact point.
  struct TiltedNode {
    int node;
    double weight;
    Vector3<double> tilt;
  };
  /// A face that may take a share of the couple of a side, with its mean tangents.
  struct TiltedFace {
    const Face* face;
    double share;
    Eigen::Vector3d along, across;
  };
  std::vector<TiltedNode> tilted;                ///< working space
  std::array<std::vector<TiltedFace>, 2> faces;  ///< working space: of either side
  std::vector<std::uint8_t> taken;               ///< working space

  /// Clear rows and blocks.
  void clear();
};

/// Input of rows: positions at the beginning of the step, predicted velocities.
struct RowSources {
  const Surface& surface;
  const SurfaceFeatures& features;
  const Nodes& nodes;
  const Ties& ties;
  std::span<const RigidMotion> bodies;
};

/// Append one row per contact, with the impulses of the contact.
void add_rows(ContactRows& rows, const RowSources& sources, std::span<const Contact> contacts);

/// Append one row per contact with a wall.
void add_rows(ContactRows& rows, const RowSources& sources, std::span<const ContactWall> walls,
              std::span<const NodeAtWall> touches);

}  // namespace brio
