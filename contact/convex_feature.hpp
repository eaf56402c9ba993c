#pragma once
/// The way out of a closed body where its faces meet at a convex edge or vertex.
///
/// A node is clear of such a body when it is above one of the faces *or* above another. Which of them it is
/// closest to means nothing there: a block that slides from one floor to the next meets the side of the
/// second floor 1e-9 below its edge, a cube that lies flush on another is as close to that one's sides as to
/// its top. So the contact is put on the face that the motion asks the least correction for. Faces compete
/// that
/// - the node has not been behind for longer than a hair at the beginning of the step (no deeper than the
///   least deep of them), and
/// - the node's own surface opposes: a cube set flush on another has no face that looks at the other's side.
/// Beside the body by more than a hair there is nothing to separate.

#include <array>
#include <optional>
#include <span>

#include "contact/face_geometry.hpp"
#include "contact/pair.hpp"

namespace brio {

/// What impulses not yet converged leave, over the edge of a face: within it above and beside are the same.
inline constexpr double hair_share = 1e-3;

/// A node near a face of a closed body to which it does not belong.
struct NodeAtFeature {
  const Surface& surface;
  const Nodes& nodes;
  std::span<const Contact> history;  ///< contacts of the node in the last step
  double dt;
  int slave;
  int face;
  const ClosestPoint& closest;  ///< of the face
  double edge;                  ///< length that a hair is a share of
  double reach;                 ///< distance at which node and face touch
};

/// Where a contact is put, if one is needed: a node beside the body by more than a hair needs none.
struct Separation {
  int face = 0;
  std::array<double, 4> weights{};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double gap = 0;
  bool needed = false;
};

/// \returns nothing where no convex feature is near: the face may be judged alone. \param direct  unit vector
/// from the closest point to the node, where it is farther away than a hair, else zero
std::optional<Separation> separate_at_feature(const NodeAtFeature& query, const Eigen::Vector3d& direct);

/// Whether a node that meets the face at `weights` during the step passes it by within a hair, above a face
/// next to it or beside the body.
bool passes_by(const NodeAtFeature& query, const std::array<double, 4>& weights);

}  // namespace brio
