#pragma once
/// Discrete springs and dashpots between two points: nodes of parts that deform, points of rigid bodies, or
/// points that stay in place. Tension is positive.
///
///   spring    F(e) of the elongation e = |x_to - x_from| - length, at the positions of the step;
///   dashpot   c de/dt, with the rate as the mean of those before and after the time step.
///
/// Both act along the line between the ends, so that they conserve linear and angular momentum. They have no
/// mass: with the elements' highest frequency w_e, the frequency of a vibration of nodes and springs is at
/// most sqrt(w_e^2 + w_s^2), w_s^2 the bound of `bound_step`, and the central difference method is stable for
/// dt^2 (w_e^2 + w_s^2) + 2 dt d <= 4, d the same bound for the dashpots.
///
/// A torsional spring is the same in rotations: its elongation is the angle by which `to` has turned about
/// the axis against `from`, summed over the steps, its force is a moment, opposite on both ends, and its
/// direction is the axis, which turns with `from`.

#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "elements/base/quaternion.hpp"
#include "src/base/tensor.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/motion/rigid.hpp"

namespace brio {

/// What the end of a spring is fastened to.
struct SpringAnchor {
  int node = -1;         ///< of the model; -1: a point that stays in place
  int body = -1;         ///< rigid body of the node; -1: a part that deforms
  Vector3d point{};      ///< if it stays in place
  std::size_t mass = 0;  ///< index in Springs::mass; of a node or a body
  /// Of a body at the last step, where the spring is torsional.
  Quaternion<double> attitude = no_rotation;
};

/// Elongation and force, of springs that are not linear; or angle and moment.
using ForceTable = std::vector<std::array<double, 2>>;

struct SpringInRun {
  std::string name;
  std::array<SpringAnchor, 2> end;
  bool is_torsional = false;  ///< then angle and moment stand in place of elongation and force
  double length = 0;
  double stiffness = 0;  ///< of a table: its steepest slope upwards
  ForceTable table{};    ///< empty: linear
  double damping = 0;
  double strength = std::numeric_limits<double>::infinity();
  // in the present step
  double elongation = 0;
  double force = 0;    ///< of the spring
  double dashpot = 0;  ///< force of the dashpot
  double energy = 0;   ///< stored
  bool is_broken = false;
  /// Unit vector between the ends, 0 where they meet; or the axis.
  Vector3d direction{};

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(elongation, force, dashpot, energy, is_broken, direction, end[0].attitude, end[1].attitude);
  }
};

/// A node or a rigid body with all that pulls on it.
struct AnchoredMass {
  int node = -1, body = -1;
  double arm = 0;  ///< largest distance of an anchor from the centre of the body
  double stiffness = 0, damping = 0;
  double torsional_stiffness = 0, torsional_damping = 0;
};

/// What one name of the deck stands for: one spring, or those between two sets.
struct SpringSet {
  std::string name;
  std::size_t first = 0, count = 1;  ///< of Springs::spring
  bool is_torsional = false;
  bool joins_sets = false;
  double shortest = 0, longest = 0;  ///< distance of two ends at the start
};

struct Springs {
  std::vector<SpringInRun> spring;
  std::vector<AnchoredMass> mass;
  std::vector<SpringSet> set;  ///< one an entry of the deck
  int critical = -1;           ///< spring that alone allows a smaller time step than all elements; -1: none

  bool empty() const { return spring.empty(); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(spring, critical);
  }
};

/// Force of a spring without its dashpot, and the energy that it stores from elongation 0 on.
double force_at(const SpringInRun& spring, double elongation);
double energy_at(const SpringInRun& spring, double elongation);

/// Takes over the positions of nodes, without forces. \return energy stored at the start
double start(Springs& springs, const Nodes& nodes);

/// Adds the forces of the springs to nodes.force, and moments to nodes.moment; springs beyond their strength,
/// and those of a node that was removed, break. \param last_step by which nodes and bodies have moved
Contribution stretch(Springs& springs, double last_step, const RigidBodies& bodies, Nodes& nodes);

/// Adds the moments of torsional springs to bodies, on which the forces of nodes stand.
void turn_bodies(const Springs& springs, RigidBodies& bodies);

/// The stable time step with springs and dashpots. \param of_elements without them; may be infinite
double bound_step(Springs& springs, double of_elements, const RigidBodies& bodies, const Nodes& nodes);

/// Adds the forces of the dashpots to nodes and bodies, on which all other forces stand.
/// \param mean_step time between the velocities before and after
Contribution pull_dashpots(Springs& springs, double mean_step, RigidBodies& bodies, Nodes& nodes);

/// Work of the dashpots with the velocities at the end of the step.
Contribution dashpots_done(const Springs& springs, double mean_step, const RigidBodies& bodies,
                           const Nodes& nodes);

/// spring.NAME.elongation, spring.NAME.force; of torsional springs spring.NAME.angle, spring.NAME.moment; of
/// those between sets spring.NAME.broken besides.
void add_columns(const Springs& springs, std::vector<std::string>& columns);
/// Force with that of the dashpot; 0 where broken. Of those between sets the mean elongation of those that
/// are not broken, and the sum of the forces.
void add_values(const Springs& springs, std::vector<double>& row);

}  // namespace brio
