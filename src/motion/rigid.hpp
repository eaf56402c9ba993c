#pragma once
/// Each rigid body has six degrees of freedom, free or prescribed. Its nodes are massless nodes of the model;
/// their positions and velocities follow from the body, and impulses on them act on the body. Among them are
/// nodes of elements that are joined to it: their mass is the body's, and so are the forces of their
/// elements.
///
/// In each time step the linear momentum M V and the angular momentum L about the centre first receive the
/// impulses of loads, supports, contact and walls at the present attitude. Then the centre moves by V dt, and
/// the attitude rotates as that of a free body with this L: the midpoint rule for Euler's equations, with the
/// Cayley transform of the mean rate, conserves L and the energy L.I^-1.L/2 to rounding for any time step
/// (Lewis and Simo 1994; Simo and Wong 1991).

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/features/rigid_motion.hpp"
#include "elements/base/quaternion.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"
#include "src/base/tensor.hpp"
#include "src/deck/mass_properties.hpp"
#include "src/motion/constraints.hpp"
#include "src/motion/loads.hpp"
#include "src/motion/motion.hpp"

namespace brio {

/// One prescribed component of a body's motion along the axes of its supports, which stay as they are:
/// translations of its centre, rotations about it by the components of the angular velocity.
struct PrescribedRigid {
  MotionKind kind = MotionKind::velocity;
  int axis = 0;  ///< 0..2 translations, 3..5 rotations
  Curve curve;
  std::string place{};  ///< in the deck
  int condition = -1;   ///< its number in the deck
};

/// A node of a body in contact with a wall in the present time step.
struct WallTouch {
  int node = 0;
  Vector3d arm{};
  double normal_mass = 0;
  double target = 0;   ///< least velocity away from the wall
  double impulse = 0;  ///< along the wall's normal; never negative
  Vector3d friction{};
};

struct RigidBody {
  std::size_t part = 0;
  std::vector<int> node;          ///< of the model
  std::vector<Vector3d> arm;      ///< from the centre to each node, in the initial attitude
  std::vector<int> connectivity;  ///< nodes of the model, in the order of the part's mesh
  int nodes_per_element = 8;
  double thickness = 0;                ///< of shells
  std::vector<std::size_t> joint;      ///< places in `node` of those that belong to elements as well
  std::vector<Vector3d> joint_before;  ///< their positions before the step; working space

  MassProperties own;  ///< without joined nodes, at the start
  double mass = 0;
  Tensor<double> inertia{};  ///< about the centre, in the initial attitude
  std::vector<PrescribedRigid> given;
  Tensor<double> axes = identity<double>();  ///< rows: of the components in `given`

  Vector3d centre{};
  Quaternion<double> attitude = no_rotation;
  Vector3d angular_momentum{};  ///< about the centre, at the last half step
  Vector3d force{};             ///< of loads, in this step
  Vector3d moment{};
  Vector3d weight{};              ///< gravity as a part of the force
  Vector3d torque{};              ///< of loads on the body itself, as a part of the moment
  std::vector<WallTouch> touch;   ///< at the wall under consideration
  Vector3d support = Vector3d{};  ///< linear impulse of its supports, but in contact, in this step

  bool is_given(int axis) const;

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(centre, attitude, angular_momentum, force, moment, weight, torque);
  }
};

struct RigidBodies {
  std::vector<RigidBody> body;
  std::vector<RigidMotion> motion;  ///< of each body

  bool empty() const { return body.empty(); }
  bool has_joints() const {
    return std::any_of(body.begin(), body.end(), [](const RigidBody& one) { return !one.joint.empty(); });
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(body, motion);
  }
};

/// Start with a velocity of the centre and an angular velocity.
void start(RigidBody& body, RigidMotion& motion, const Vector3d& velocity, const Vector3d& angular_velocity);

/// Kinetic energy of all bodies.
KineticEnergy kinetic_energy(const RigidBodies& bodies);
/// Adds the momentum of all bodies.
void add_momentum(const RigidBodies& bodies, Momentum& sum);

/// Forces and moments on the bodies: of gravity, of moments on the bodies, and what stands in nodes.force.
/// \param by_nodes whether anything acts on their nodes
void gather_forces(RigidBodies& bodies, std::span<const ActiveLoad> loads, double time, bool by_nodes,
                   const Nodes& nodes);
/// Power of loads on the bodies themselves, gravity and moments, with their present velocities; other loads
/// act on nodes and are known by them.
double load_power(const RigidBodies& bodies);
/// Force and moment about the origin of the same loads.
Impulse load_resultant(const RigidBodies& bodies);

/// Apply the impulses of loads and set the prescribed components. \return the reaction of supports.
Reaction accelerate(RigidBodies& bodies, const StepTimes& times);
/// Add the impulses of contact or walls to the momenta and clear them.
void add_contact_impulses(RigidBodies& bodies);
/// Velocities of all nodes of the bodies, from those of the bodies; of joined nodes the angular ones too.
void carry_velocities(const RigidBodies& bodies, Nodes& nodes, ThreadTeam& team);

/// Move and turn the bodies over the step and put their nodes where they belong. \return what the supports of
/// prescribed rotations did on the way; all of it in `after`. Velocities of joined nodes are those of their
/// displacement in the step, so that elements strain by nothing else.
/// \throws Breakdown where a body turns too far in one step.
Reaction move(RigidBodies& bodies, double step, Nodes& nodes, ThreadTeam& team);

/// Stops the nodes of a body at a wall, but those in contact. \return of the wall, and of supports of
/// prescribed components
Contribution stop_at(const WallInRun& wall, const StepTimes& times, NodesInContact in_contact,
                     RigidBody& body, RigidMotion& motion, const Nodes& nodes);
/// Of the lowest node of the body above the wall as it stands at the start.
double height_above(const WallInRun& wall, const RigidBody& body, const Nodes& nodes);

}  // namespace brio
