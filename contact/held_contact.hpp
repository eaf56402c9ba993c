#pragma once
/// Contacts that touch held nodes (ties.hpp). Such a node has no mass of its own: what pushes it pushes the
/// corners that hold it, by their weights, so that the solver sees the masses there. What an impulse on an
/// arm adds to the corners is passed on after the solution.

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "contact/pair.hpp"
#include "contact/rigid_contact.hpp"
#include "contact/slave_set.hpp"
#include "contact/solve.hpp"
#include "contact/surface.hpp"
#include "contact/ties.hpp"
#include "src/base/nodes.hpp"

namespace brio {

struct ContactScene;

/// An impulse on its way from held nodes to those that hold them.
struct PassedImpulse {
  Eigen::Vector3d whole = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_weight = Eigen::Vector3d::Zero();  ///< what the solver has applied already
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

/// Kept between steps only to save its memory; empty in scenes without ties.
struct HeldContacts {
  /// Of each contact the nodes with motion of their own that stand for its deformable nodes, where any of
  /// these is held; none where not. Places in the solver's motion; ~k: the k-th node outside of the surface.
  std::vector<std::size_t> first;
  std::vector<int> entry;
  std::vector<double> weight;

  std::vector<int> outside;  ///< global nodes that hold something but are not on the surface
  std::vector<ContactMotion> outside_motion;

  std::vector<PassedImpulse> way;  ///< of each node of the model; all 0 between steps

  std::span<const int> entries_of(std::size_t contact) const {
    return {entry.data() + first[contact], first[contact + 1] - first[contact]};
  }
};

/// Motion of nodes with those that hold others, and of rigid bodies, as the solver sees it.
struct HeldMotion {
  MixedMotion mixed;
  const HeldContacts& held;
  std::span<ContactMotion> outside;
};

Eigen::Vector3d relative_velocity(const Contact& contact, const HeldMotion& motion);
void apply(const Contact& contact, const Eigen::Vector3d& impulse, const HeldMotion& motion);
double effective_mass(const Contact& contact, const Eigen::Vector3d& direction, const HeldMotion& motion);

/// Find what stands for held nodes in each contact, and add it to the nodes in contact.
void find_held(HeldContacts& held, const Surface& surface, const Ties& ties,
               std::span<const Contact> contacts, SlaveSet& in_contact);

/// Motion of holding nodes outside of the surface, from and to the nodes.
void load_outside(HeldContacts& held, const Nodes& nodes);
void store_outside(const HeldContacts& held, Nodes& nodes);

/// Impulses on held nodes on to what holds them: what the solver has left out because of arms changes
/// velocities, what falls on prescribed components is booked as the supports'. Held nodes move with their
/// faces again.
void pass_on(ContactScene& scene, const Ties& ties, Nodes& nodes, double dt);

}  // namespace brio
