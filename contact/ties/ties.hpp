#pragma once
/// Nodes held by faces of other parts for the whole run (tie.hpp: where), by condensation: such a
/// node has no motion of its own. Its mass is on the corners of its face, its force goes there every step,
/// and its velocity and position follow from theirs. This needs no iteration, leaves nothing that could
/// drift, and gives the same bits for any number of threads.
///
/// Mass goes to the corners by their weights (lumped). With positive weights and no gap that is never less
/// than what the condensed mass matrix would have, so that the stable step of the elements remains one; where
/// arms add more, `step_share` takes the step down by what they can add.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "contact/ties/tie.hpp"
#include "src/base/nodes.hpp"

namespace brio {

struct TiedNode {
  Tie tie;
  double mass = 0;        ///< that the corners carry for it
  double inertia = 0;     ///< rotational, likewise; of nodes that turn with their face
  int face_part = 0;      ///< of the deck
  int element = 0;        ///< of that part's mesh, whose face holds the node
  int connection = 0;     ///< index in Ties::found
  bool released = false;  ///< to be let go
};

/// What became of one connection.
struct TiedParts {
  std::string nodes, surface;
  std::string place;  ///< in the deck
  int count = 0;
  double largest_gap = 0;  ///< of a node from the surface
};

/// Empty where a deck ties nothing.
struct Ties {
  std::vector<TiedNode> node;  ///< those that are held before those that hold them
  std::vector<int> of_node;    ///< of each node of the model: its place in `node`, or -1
  std::vector<TiedParts> found;
  std::vector<double> moved_mass;             ///< of each node of the model: what its corners carry for it
  std::vector<int> concerned;                 ///< held nodes and corners, ascending
  std::vector<double> own_mass, own_inertia;  ///< of these, without ties
  std::vector<double> bound, coupling;        ///< working space, of these
  std::vector<Eigen::Vector3d> wall_push, wall_rub;  ///< what a wall gives each held node in this step
  double step_share = 1;                             ///< of the elements' stable step
  std::int64_t released = 0;                         ///< nodes, since the start

  bool empty() const { return node.empty(); }
  bool holds(int global_node) const {
    return !of_node.empty() && of_node[static_cast<std::size_t>(global_node)] >= 0;
  }
};

/// Positions of the corners of a tie.
FaceVertices corners_of(const Tie& tie, const Nodes& nodes);

/// Fill Ties::of_node.
void number(Ties& ties, std::size_t node_count);

/// Put held nodes exactly where they are held, move masses to the corners, and find the step's share.
void condense(Ties& ties, Nodes& nodes);

/// Energy and momentum of motion, about the origin.
struct NodeMotion {
  double energy = 0;
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

/// Let the nodes go that are marked: they take their mass back from the corners and keep their velocity.
/// \returns the kinetic energy lost by that, for the energy balance.
NodeMotion release(Ties& ties, Nodes& nodes);

/// Forces and moments of held nodes to the corners, in a fixed order.
void gather_forces(const Ties& ties, Nodes& nodes);

/// Velocity of one held node by those of its corners.
Eigen::Vector3d held_velocity(const Tie& tie, const Nodes& nodes, double step);

/// Velocities of held nodes, such that moving by them over the step keeps them where they are held.
void carry_velocities(const Ties& ties, Nodes& nodes, double step);

/// Positions of held nodes, after all nodes have moved over the step.
void place(Ties& ties, Nodes& nodes, double step);

}  // namespace brio
