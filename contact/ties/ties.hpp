#pragma once
/// Tied contact: nodes constrained to faces of other parts (tie.hpp) by condensation. A tied node has no
/// degrees of freedom. Its mass is on the corners of its face of the main surface, its force is transferred
/// to them in every time step, and its velocity and position follow from theirs. This needs no iteration,
/// cannot drift, and gives the same bits for any number of threads.
///
/// Mass is distributed to the corners by their weights (lumped). With positive weights and no gap it is never
/// less than in the condensed mass matrix, so that the stable time step of the elements remains valid; where
/// arms add more, `step_share` reduces it by a bound of their effect.

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "contact/ties/tie.hpp"
#include "src/base/index.hpp"
#include "src/base/nodes.hpp"

namespace brio {

struct TiedNode {
  Tie tie;
  double mass = 0;                      ///< carried by the corners
  double inertia = 0;                   ///< rotational, likewise; of nodes with the rotation of their face
  int face_part = 0;                    ///< of the deck
  int element = 0;                      ///< of that part's mesh, with the main face
  int connection = 0;                   ///< index in Ties::found
  bool released = false;                ///< to be released
  Vector3d last_velocity = Vector3d{};  ///< at the half step before, where the tie can fail

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(tie, mass, inertia, face_part, element, connection, released, last_velocity);
  }
};

/// Result of one connection.
struct TiedParts {
  std::string nodes, surface;
  std::string place;  ///< in the deck
  int count = 0;
  double largest_gap = 0;  ///< of a node from the surface
  /// Tension and shear of a node at which its tie fails; infinite: never.
  double normal_force = std::numeric_limits<double>::infinity();
  double shear_force = std::numeric_limits<double>::infinity();

  bool can_fail() const { return std::isfinite(normal_force) || std::isfinite(shear_force); }
};

/// All ties; empty without ties in the deck.
struct Ties {
  std::vector<TiedNode> node;    ///< tied nodes before the nodes of their main faces
  std::vector<TiedNode> joined;  ///< nodes that belong to a rigid body, on one of its faces at the start
  std::vector<int> of_node;      ///< of each node of the model: its place in `node`, or -1
  std::vector<TiedParts> found;
  std::vector<double> moved_mass;             ///< of each node of the model: mass carried by its corners
  std::vector<int> concerned;                 ///< tied nodes and corners, ascending
  std::vector<double> own_mass, own_inertia;  ///< of these, without ties
  std::vector<double> bound, coupling;        ///< working space, of these
  std::vector<Vector3d> wall_impulse,
      wall_friction;          ///< impulses of a wall on each tied node in this step
  double step_share = 1;      ///< ratio to the stable time step of the elements
  std::int64_t released = 0;  ///< nodes, since the start
  std::int64_t failed = 0;    ///< of these: by force
  double last_step = 0;       ///< time step before the last one, where ties can fail

  bool empty() const { return node.empty(); }
  bool is_tied(int global_node) const { return !of_node.empty() && of_node[index(global_node)] >= 0; }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(node, of_node, moved_mass, concerned, own_mass, own_inertia, step_share, released, failed,
            last_step);
  }
};

/// Positions of the corners of a tie.
FaceVertices corners_of(const Tie& tie, const Nodes& nodes);

/// Fill Ties::of_node.
void number(Ties& ties, std::size_t node_count);

/// Put tied nodes exactly at their position, move masses to the corners, and find `step_share`.
void condense(Ties& ties, Nodes& nodes);

/// Kinetic energy and momentum, about the origin.
struct NodeMotion {
  double energy = 0;
  Vector3d linear{};
  Vector3d angular{};
};

/// Release the marked nodes: they get their mass back from the corners and keep their velocity.
/// \returns the kinetic energy lost by that, for the energy balance.
NodeMotion release(Ties& ties, Nodes& nodes);

/// Force of a tied node on its face: what acts on the node, less its inertia in the last time step.
/// \param mean_step time in which its velocity changed from the last one; 0: it did not
Vector3d force_on_face(const TiedNode& tied, double mean_step, const Nodes& nodes);

/// Mark ties whose force reaches that of their connection. \param step the last time step; 0: there was none
/// \returns their number
std::int64_t mark_failed(Ties& ties, double step, const Nodes& nodes);

/// Transfer forces and moments of tied nodes to the corners, in a fixed order.
void gather_forces(const Ties& ties, Nodes& nodes);

/// Velocity of one tied node from those of its corners.
Vector3d tied_velocity(const Tie& tie, const Nodes& nodes, double step);

/// Velocities of tied nodes, such that they are at their position after the step.
void carry_velocities(const Ties& ties, Nodes& nodes, double step);

/// Positions of tied nodes, after all nodes have moved over the step.
void place(Ties& ties, Nodes& nodes, double step);

}  // namespace brio
