#pragma once
/// Contacts that touch rigid bodies. The nodes of a rigid body have no mass of their own; an impulse on one
/// of them goes to the body. Of a contact with a rigid side both impulses act at one point: at the node where
/// the face is rigid, else where the node meets the face; so momentum and angular momentum are kept to
/// rounding.

#include <span>
#include <vector>

#include "contact/pair.hpp"
#include "contact/rigid_motion.hpp"
#include "contact/solve.hpp"
#include "contact/surface.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// What is rigid in one contact: the body of the node and of the face, or -1, and where on them the impulse
/// acts.
struct RigidTouch {
  int node_body = -1;
  int face_body = -1;
  Eigen::Vector3d node_arm = Eigen::Vector3d::Zero();
  Eigen::Vector3d face_arm = Eigen::Vector3d::Zero();
};

/// Motion of nodes and rigid bodies as the solver sees it.
struct MixedMotion {
  std::span<const Contact> contacts;
  std::span<const RigidTouch> touch;  ///< one a contact
  std::span<ContactMotion> node;      ///< of each slave node
  std::span<RigidMotion> body;

  const RigidTouch& touch_of(const Contact& contact) const {
    return touch[static_cast<std::size_t>(&contact - contacts.data())];
  }
};

Eigen::Vector3d relative_velocity(const Contact& contact, const MixedMotion& motion);
void apply(const Contact& contact, const Eigen::Vector3d& impulse, const MixedMotion& motion);
double effective_mass(const Contact& contact, const Eigen::Vector3d& direction, const MixedMotion& motion);

/// What contacts did to rigid bodies and to their supports; J.v with velocities before and after the step.
struct RigidWork {
  double normal_before = 0;
  double normal_after = 0;
  double friction_before = 0;
  double friction_after = 0;
  double support_before = 0;
  double support_after = 0;
  Eigen::Vector3d support_impulse = Eigen::Vector3d::Zero();
  Eigen::Vector3d support_moment = Eigen::Vector3d::Zero();  ///< about the origin
};

/// Kept between steps only to save its memory; empty in scenes without rigid bodies.
struct RigidContacts {
  std::vector<RigidTouch> touch;

  /// Find what is rigid in each contact.
  void find(const Surface& surface, const Nodes& nodes, std::span<const Contact> contacts,
            std::span<const RigidMotion> body);
  RigidWork work(std::span<const Contact> contacts, std::span<const RigidMotion> body) const;
};

}  // namespace brio
