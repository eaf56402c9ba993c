#include "contact/held_contact.hpp"

#include <algorithm>

#include "contact/face_geometry.hpp"
#include "contact/scene.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

std::size_t number_of(const Contact& contact, const HeldMotion& motion) {
  return static_cast<std::size_t>(&contact - motion.mixed.contacts.data());
}

const RigidMotion& at(std::span<const RigidMotion> body, int index) {
  return body[static_cast<std::size_t>(index)];
}

ContactMotion& motion_of(int entry, const HeldMotion& motion) {
  return entry >= 0 ? motion.mixed.node[static_cast<std::size_t>(entry)]
                    : motion.outside[static_cast<std::size_t>(~entry)];
}

/// Nodes with motion of their own and their weights, each once.
class Collection {
 public:
  Collection(HeldContacts& held, const Surface& surface, const Ties& ties)
      : held_(held), surface_(surface), ties_(ties), begin_(held.entry.size()) {}

  void add(int global_node, double weight) {
    if (weight == 0) return;
    if (!ties_.holds(global_node)) return add_free(global_node, weight);
    const Tie& tie =
        ties_.node[static_cast<std::size_t>(ties_.of_node[static_cast<std::size_t>(global_node)])].tie;
    for (std::size_t k = 0; k < 4; ++k) add(tie.corner[k], weight * tie.weight[k]);
  }

 private:
  void add_free(int global_node, double weight) {
    const int slave = surface_.slave(global_node);
    const int entry = slave >= 0 ? slave : ~outside(global_node);
    for (std::size_t i = begin_; i < held_.entry.size(); ++i)
      if (held_.entry[i] == entry) {
        held_.weight[i] += weight;
        return;
      }
    held_.entry.push_back(entry);
    held_.weight.push_back(weight);
  }

  int outside(int global_node) {
    const auto found = std::find(held_.outside.begin(), held_.outside.end(), global_node);
    const auto place = found - held_.outside.begin();
    if (found == held_.outside.end()) held_.outside.push_back(global_node);
    return static_cast<int>(place);
  }

  HeldContacts& held_;
  const Surface& surface_;
  const Ties& ties_;
  std::size_t begin_;
};

void set(ContactMotion& motion, const Nodes& nodes, int global_node) {
  const auto node = static_cast<std::size_t>(global_node);
  for (int axis = 0; axis < 3; ++axis) {
    motion.velocity[axis] = nodes.record[node].velocity[axis];
    motion.inverse_mass[axis] = nodes.free_inverse_mass(node, axis);
  }
}

}  // namespace

Vector3d relative_velocity(const Contact& contact, const HeldMotion& motion) {
  const std::size_t c = number_of(contact, motion);
  const std::span<const int> entries = motion.held.entries_of(c);
  if (entries.empty()) return relative_velocity(contact, motion.mixed);
  const double* weight = motion.held.weight.data() + motion.held.first[c];
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < entries.size(); ++i)
    sum += weight[i] * Vector3d(motion_of(entries[i], motion).velocity);
  const RigidTouch& touch = motion.mixed.touch[c];
  if (touch.node_body >= 0) sum += at(motion.mixed.body, touch.node_body).velocity_at(touch.node_arm);
  if (touch.face_body >= 0) sum -= at(motion.mixed.body, touch.face_body).velocity_at(touch.face_arm);
  return sum;
}

void apply(const Contact& contact, const Vector3d& impulse, const HeldMotion& motion) {
  const std::size_t c = number_of(contact, motion);
  const std::span<const int> entries = motion.held.entries_of(c);
  if (entries.empty()) return apply(contact, impulse, motion.mixed);
  const double* weight = motion.held.weight.data() + motion.held.first[c];
  for (std::size_t i = 0; i < entries.size(); ++i) {
    ContactMotion& node = motion_of(entries[i], motion);
    for (int axis = 0; axis < 3; ++axis)
      node.velocity[axis] += weight[i] * node.inverse_mass[axis] * impulse[axis];
  }
  const RigidTouch& touch = motion.mixed.touch[c];
  if (touch.node_body >= 0)
    motion.mixed.body[static_cast<std::size_t>(touch.node_body)].push(impulse, touch.node_arm);
  if (touch.face_body >= 0)
    motion.mixed.body[static_cast<std::size_t>(touch.face_body)].push(-impulse, touch.face_arm);
}

double effective_mass(const Contact& contact, const Vector3d& direction, const HeldMotion& motion) {
  const std::size_t c = number_of(contact, motion);
  const std::span<const int> entries = motion.held.entries_of(c);
  if (entries.empty()) return effective_mass(contact, direction, motion.mixed);
  const double* weight = motion.held.weight.data() + motion.held.first[c];
  double inverse = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const ContactMotion& node = motion_of(entries[i], motion);
    double share = 0;
    for (int axis = 0; axis < 3; ++axis) share += direction[axis] * direction[axis] * node.inverse_mass[axis];
    inverse += weight[i] * weight[i] * share;
  }
  const RigidTouch& touch = motion.mixed.touch[c];
  if (touch.node_body >= 0)
    inverse += at(motion.mixed.body, touch.node_body).inverse_mass_along(direction, touch.node_arm);
  if (touch.face_body >= 0)
    inverse += at(motion.mixed.body, touch.face_body).inverse_mass_along(direction, touch.face_arm);
  return inverse > 0 ? 1 / inverse : 0;
}

void find_held(HeldContacts& held, const Surface& surface, const Ties& ties,
               std::span<const Contact> contacts, SlaveSet& in_contact) {
  held.first.assign(1, 0);
  held.entry.clear();
  held.weight.clear();
  held.outside.clear();
  for (const Contact& contact : contacts) {
    const auto global = [&](std::size_t k) {
      return surface.node[static_cast<std::size_t>(contact.node[k])];
    };
    bool any = false;
    for (std::size_t k = 0; k < 5; ++k) any = any || (contact.weight[k] != 0 && ties.holds(global(k)));
    if (any) {
      Collection collection(held, surface, ties);
      for (std::size_t k = 0; k < 5; ++k)
        if (surface.rigid_body(global(k)) < 0) collection.add(global(k), contact.weight[k]);
    }
    for (std::size_t i = held.first.back(); i < held.entry.size(); ++i)
      if (held.entry[i] >= 0) in_contact.insert(held.entry[i]);
    held.first.push_back(held.entry.size());
  }
}

void load_outside(HeldContacts& held, const Nodes& nodes) {
  held.outside_motion.resize(held.outside.size());
  for (std::size_t i = 0; i < held.outside.size(); ++i) set(held.outside_motion[i], nodes, held.outside[i]);
}

void store_outside(const HeldContacts& held, Nodes& nodes) {
  for (std::size_t i = 0; i < held.outside.size(); ++i) {
    double* v = nodes.record[static_cast<std::size_t>(held.outside[i])].velocity;
    for (int axis = 0; axis < 3; ++axis) v[axis] = held.outside_motion[i].velocity[axis];
  }
}

namespace {

/// Impulses on their way from held nodes to those that hold them.
class Passage {
 public:
  Passage(ContactScene& scene, const Ties& ties, Nodes& nodes)
      : scene_(scene), ties_(ties), nodes_(nodes), way_(scene.held.way) {}

  void run(double dt) {
    for (const TiedNode& held : ties_.node) pass(held.tie);
    for (const TiedNode& held : ties_.node)
      for (int corner : held.tie.corner)
        if (!ties_.holds(corner)) receive(corner);
    carry_velocities(ties_, nodes_, dt);
    take_over();
  }

 private:
  PassedImpulse& at(int node) { return way_[static_cast<std::size_t>(node)]; }

  Vector3d given(int node) const {
    const int slave = scene_.surface.slave(node);
    if (slave < 0) return Vector3d::Zero();
    const auto s = static_cast<std::size_t>(slave);
    return scene_.normal_impulse[s] + scene_.friction_impulse[s];
  }

  void pass(const Tie& tie) {
    const Vector3d own = given(tie.node);
    const PassedImpulse on = at(tie.node);
    at(tie.node) = {};
    const Vector3d whole = on.whole + own;
    const Vector3d by_weight = on.by_weight + own;
    if (whole.isZero(0) && on.moment.isZero(0)) return;
    const std::array<Vector3d, 4> share = spread(tie, corners_of(tie, nodes_), whole);
    const Vector3d moment = tie.turning ? Vector3d(on.moment + tie.arm.cross(whole)) : Vector3d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      PassedImpulse& corner = at(tie.corner[k]);
      corner.whole += share[k];
      corner.by_weight += tie.weight[k] * by_weight;
      corner.moment += tie.weight[k] * moment;
    }
  }

  void receive(int entry) {
    const auto node = static_cast<std::size_t>(entry);
    const PassedImpulse on = at(entry);
    if (on.whole.isZero(0) && on.by_weight.isZero(0) && on.moment.isZero(0)) return;
    at(entry) = {};
    Vector3d reaction = Vector3d::Zero();
    Vector3d couple = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const double free = nodes_.free_inverse_mass(node, axis);
      nodes_.record[node].velocity[axis] += free * (on.whole[axis] - on.by_weight[axis]);
      if (free == 0) reaction[axis] = -on.whole[axis];
      if (!nodes_.has_rotations()) continue;
      double* rate = nodes_.angular_velocity[node].component;
      if (nodes_.prescribed.empty() || (nodes_.prescribed[node] >> (axis + 3) & 1) == 0)
        rate[axis] += rate[3] * on.moment[axis];
      else
        couple[axis] = -on.moment[axis];
    }
    ContactStep& step = scene_.step;
    if (!reaction.isZero(0)) {
      step.support_work_before += reaction.dot(Vector3d(nodes_.velocity_before[node].component));
      step.support_work_after += reaction.dot(velocity(nodes_, entry));
      step.support_impulse += reaction;
      step.support_moment += position(nodes_, entry).cross(reaction);
    }
    if (!couple.isZero(0)) {
      step.support_work_before += couple.dot(Vector3d(nodes_.angular_velocity_before[node].component));
      step.support_work_after += couple.dot(Vector3d(nodes_.angular_velocity[node].component));
      step.support_moment += couple;
    }
  }

  // The books of contact look at the motion of what was pushed.
  void take_over() {
    const auto take = [&](int node) {
      if (const int slave = scene_.surface.slave(node); slave >= 0)
        for (int axis = 0; axis < 3; ++axis)
          scene_.motion[static_cast<std::size_t>(slave)].velocity[axis] =
              nodes_.record[static_cast<std::size_t>(node)].velocity[axis];
    };
    for (const TiedNode& held : ties_.node) {
      take(held.tie.node);
      for (int corner : held.tie.corner) take(corner);
    }
  }

  ContactScene& scene_;
  const Ties& ties_;
  Nodes& nodes_;
  std::vector<PassedImpulse>& way_;
};

}  // namespace

void pass_on(ContactScene& scene, const Ties& ties, Nodes& nodes, double dt) {
  Passage(scene, ties, nodes).run(dt);
}

}  // namespace brio
