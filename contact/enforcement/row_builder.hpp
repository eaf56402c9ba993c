#pragma once
/// Rows of contacts, each from its own contact alone: what they do to translations and rotations of nodes and
/// of rigid bodies. Tied nodes (ties.hpp) are no unknowns: they are expanded into the corners of their main
/// face, over chains of ties and with their arms.
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
#include "contact/enforcement/nodes_at_walls.hpp"
#include "contact/features/features.hpp"
#include "contact/features/rigid_motion.hpp"
#include "contact/pair.hpp"
#include "contact/surface/surface.hpp"
#include "contact/ties/ties.hpp"
#include "src/base/index.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// Input of rows: positions at the beginning of the step, predicted velocities.
struct RowSources {
  const Surface& surface;
  const SurfaceFeatures& features;
  const Nodes& nodes;
  const Ties& ties;
  std::span<const RigidMotion> bodies;
};

/// Owner of an unknown velocity.
struct BlockOwner {
  enum class Kind : std::uint8_t { node, rotation_of_node, body, rotation_of_body };
  Kind kind = Kind::node;
  int index = 0;  ///< global node, or rigid body
};

/// All that could be unknown, numbered: translations of nodes, translation and rotation of each body,
/// rotations of nodes.
class Unknowns {
 public:
  Unknowns(std::size_t nodes, std::size_t bodies)
      : nodes_(static_cast<int>(nodes)), bodies_(static_cast<int>(bodies)) {}

  int node(int n) const { return n; }
  int body(int b) const { return nodes_ + 2 * b; }  ///< translation; the rotation follows
  int rotation(int n) const { return nodes_ + 2 * bodies_ + n; }
  std::size_t size(bool have_rotations) const { return index(rotation(have_rotations ? nodes_ : 0)); }
  BlockOwner owner(int unknown) const {
    using Kind = BlockOwner::Kind;
    if (unknown < nodes_) return {Kind::node, unknown};
    if (unknown >= rotation(0)) return {Kind::rotation_of_node, unknown - rotation(0)};
    const int of_bodies = unknown - nodes_;
    return {of_bodies % 2 == 0 ? Kind::body : Kind::rotation_of_body, of_bodies / 2};
  }

 private:
  int nodes_, bodies_;
};
inline Unknowns unknowns_of(const RowSources& sources) {
  return {sources.nodes.size(), sources.bodies.size()};
}

/// Some of the rows of a step, whose entries name unknowns in place of blocks.
struct RowPiece {
  ConstraintRows rows;

  /// A node of a side with its share of the motion of the contact point.
  struct TiltedNode {
    int node;
    double weight;
    Vector3d tilt;
  };
  /// A face that may take a share of the couple of a side, with its mean tangents.
  struct TiltedFace {
    const Face* face;
    double share;
    Vector3d along, across;
  };
  std::vector<TiltedNode> tilted;                ///< working space
  std::array<std::vector<TiltedFace>, 2> faces;  ///< working space: of either side
};

/// One row per contact, with the impulses of the contact, in place of those of the piece.
void build_rows(RowPiece& piece, const RowSources& sources, std::span<const Contact> contacts);
/// One row per contact with a wall, likewise.
void build_rows(RowPiece& piece, const RowSources& sources, std::span<const ContactWall> walls,
                std::span<const NodeAtWall> touches);

}  // namespace brio
