#pragma once
/// Rows of contacts, and the unknowns that they name: translations and rotations of nodes and of rigid
/// bodies. Held nodes (ties.hpp) are no unknowns: what pushes them is expanded to the corners that hold them,
/// over chains of ties and with their arms.
///
/// Without friction both impulses of a row act along the line through the closest points. Friction acts at
/// one point of that line on both sides, so that linear and angular momentum are kept to rounding. Where it
/// lies says what can take the couple of a side that it stands off from:
///   rigid body                    the body, at any distance
///   shell, beam                   the rotations of its nodes
///   solid                         the tilt of the faces at the closest point, more of those that look along
///                                 the normal; none of them is preferred, so mirror images are treated alike
///   particle                      nothing: the point lies on it
/// Between sides of the same kind the point divides the distance as their radii do; a node of a solid
/// touches where it is. Two particles, and what has neither rotations nor faces, do not rub.

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

/// What the velocity of a block is of.
struct BlockOwner {
  enum class Kind : std::uint8_t { node, rotation_of_node, body, rotation_of_body };
  Kind kind = Kind::node;
  int index = 0;  ///< global node, or rigid body
};

/// Allocates nothing once as many rows have been seen.
struct ContactRows {
  ConstraintRows rows;  ///< one a contact
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
  std::vector<TiltedNode> tilted;   ///< working space
  std::vector<int> faces;           ///< working space
  std::vector<double> share;        ///< working space
  std::vector<std::uint8_t> taken;  ///< working space

  /// Forget rows and blocks.
  void clear();
};

/// What rows are made from. Positions are those at the beginning of the step, velocities those predicted.
struct RowSources {
  const Surface& surface;
  const SurfaceFeatures& features;
  const Nodes& nodes;
  const Ties& ties;
  std::span<const RigidMotion> bodies;
};

/// Append one row a contact, with the impulses that the contact carries.
void add_rows(ContactRows& rows, const RowSources& sources, std::span<const Contact> contacts);

/// Append one row a touch of a wall.
void add_rows(ContactRows& rows, const RowSources& sources, std::span<const ContactWall> walls,
              std::span<const NodeAtWall> touches);

}  // namespace brio
