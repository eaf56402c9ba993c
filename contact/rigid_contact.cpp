#include "contact/rigid_contact.hpp"

#include "contact/face_geometry.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

const RigidMotion& at(std::span<const RigidMotion> body, int index) {
  return body[static_cast<std::size_t>(index)];
}

ContactMotion& node_of(const Contact& contact, std::size_t k, const MixedMotion& motion) {
  return motion.node[static_cast<std::size_t>(contact.node[k])];
}

Vector3d node_share(const Contact& contact, std::size_t k, const MixedMotion& motion) {
  return contact.weight[k] * Vector3d(node_of(contact, k, motion).velocity);
}

void push_node(const Contact& contact, std::size_t k, const Vector3d& impulse, const MixedMotion& motion) {
  ContactMotion& node = node_of(contact, k, motion);
  for (int axis = 0; axis < 3; ++axis)
    node.velocity[axis] += contact.weight[k] * node.inverse_mass[axis] * impulse[axis];
}

double node_inverse_mass(const Contact& contact, std::size_t k, const Vector3d& direction,
                         const MixedMotion& motion) {
  double share = 0;
  for (int axis = 0; axis < 3; ++axis)
    share += direction[axis] * direction[axis] * node_of(contact, k, motion).inverse_mass[axis];
  return contact.weight[k] * contact.weight[k] * share;
}

}  // namespace

Vector3d relative_velocity(const Contact& contact, const MixedMotion& motion) {
  const RigidTouch& touch = motion.touch_of(contact);
  const auto own = static_cast<std::size_t>(contact.own);
  Vector3d sum = Vector3d::Zero();
  if (touch.node_body >= 0) {
    sum = at(motion.body, touch.node_body).velocity_at(touch.node_arm);
  } else {
    for (std::size_t k = 0; k < own; ++k) sum += node_share(contact, k, motion);
  }
  if (touch.face_body >= 0) return sum - at(motion.body, touch.face_body).velocity_at(touch.face_arm);
  for (std::size_t k = own; k < 5; ++k) sum += node_share(contact, k, motion);
  return sum;
}

void apply(const Contact& contact, const Vector3d& impulse, const MixedMotion& motion) {
  const RigidTouch& touch = motion.touch_of(contact);
  const auto own = static_cast<std::size_t>(contact.own);
  if (touch.node_body >= 0) {
    motion.body[static_cast<std::size_t>(touch.node_body)].push(impulse, touch.node_arm);
  } else {
    for (std::size_t k = 0; k < own; ++k) push_node(contact, k, impulse, motion);
  }
  if (touch.face_body >= 0) {
    motion.body[static_cast<std::size_t>(touch.face_body)].push(-impulse, touch.face_arm);
    return;
  }
  for (std::size_t k = own; k < 5; ++k) push_node(contact, k, impulse, motion);
}

double effective_mass(const Contact& contact, const Vector3d& direction, const MixedMotion& motion) {
  const RigidTouch& touch = motion.touch_of(contact);
  const auto own = static_cast<std::size_t>(contact.own);
  double inverse = 0;
  if (touch.node_body >= 0) {
    inverse = at(motion.body, touch.node_body).inverse_mass_along(direction, touch.node_arm);
  } else {
    for (std::size_t k = 0; k < own; ++k) inverse += node_inverse_mass(contact, k, direction, motion);
  }
  if (touch.face_body >= 0) {
    inverse += at(motion.body, touch.face_body).inverse_mass_along(direction, touch.face_arm);
  } else {
    for (std::size_t k = own; k < 5; ++k) inverse += node_inverse_mass(contact, k, direction, motion);
  }
  return inverse > 0 ? 1 / inverse : 0;
}

void RigidContacts::find(const Surface& surface, const Nodes& nodes, std::span<const Contact> contacts,
                         std::span<const RigidMotion> body) {
  touch.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const auto own = static_cast<std::size_t>(contact.own);
    const auto point_of = [&](std::size_t begin, std::size_t end) {
      Vector3d sum = Vector3d::Zero();
      for (std::size_t k = begin; k < end; ++k)
        sum += contact.weight[k] * position(nodes, surface.node[static_cast<std::size_t>(contact.node[k])]);
      return sum;
    };
    RigidTouch& found = touch[i];
    found.node_body = surface.rigid_body(surface.node[static_cast<std::size_t>(contact.node[0])]);
    found.face_body = surface.rigid_body(surface.node[static_cast<std::size_t>(contact.node[own])]);
    if (found.node_body < 0 && found.face_body < 0) continue;
    const Vector3d point = found.face_body < 0 ? Vector3d(-point_of(own, 5)) : point_of(0, own);
    if (found.node_body >= 0) found.node_arm = point - at(body, found.node_body).centre;
    if (found.face_body >= 0) found.face_arm = point - at(body, found.face_body).centre;
  }
}

RigidWork RigidContacts::work(std::span<const Contact> contacts, std::span<const RigidMotion> body) const {
  RigidWork sum;
  const auto add = [&](int index, const Vector3d& arm, const Vector3d& normal, const Vector3d& friction) {
    if (index < 0) return;
    const RigidMotion& own = at(body, index);
    const Vector3d before = own.velocity_before_at(arm);
    const Vector3d after = own.velocity_at(arm);
    sum.normal_before += normal.dot(before);
    sum.normal_after += normal.dot(after);
    sum.friction_before += friction.dot(before);
    sum.friction_after += friction.dot(after);
  };
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].impulse == 0) continue;
    const Vector3d normal = contacts[i].impulse * contacts[i].normal;
    add(touch[i].node_body, touch[i].node_arm, normal, contacts[i].friction);
    add(touch[i].face_body, touch[i].face_arm, -normal, -contacts[i].friction);
  }
  for (const RigidMotion& own : body) {
    const RigidSupport support = support_against(own, own.impulse, own.moment);
    sum.support_before += support.work_before;
    sum.support_after += support.work_after;
    sum.support_impulse += support.impulse;
    sum.support_moment += support.moment + own.centre.cross(support.impulse);
  }
  return sum;
}

}  // namespace brio
