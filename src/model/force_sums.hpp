#pragma once
/// Forces that are written to the history: impulses since the last row.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "contact/impulse_log.hpp"
#include "src/base/nodes.hpp"
#include "src/deck/deck.hpp"
#include "src/motion/rigid.hpp"

namespace brio {

struct Model;

/// Reaction of one boundary condition.
struct ReactionSum {
  std::string name;
  Vector3d impulse{};
};

/// Internal force through a plane of a part: what its nodes ahead of the plane receive from its elements.
struct SectionSum {
  std::string name;
  std::vector<int> ahead;  ///< of the part, and of those that share nodes with it
  std::vector<int> cut;    ///< nodes of elements that the plane cuts
  Vector3d point{};        ///< from the mean of the cut elements' nodes
  Impulse force;           ///< of the present step, on what lies behind the plane
  Impulse impulse;         ///< moments about the point
};

/// Force on one part by another, and what of it is friction.
struct ContactSum {
  std::string name;
  std::size_t pair = 0;  ///< of the log of contact
  double sign = 1;
  Vector3d impulse{}, friction{};
};

/// Direction along which a boundary condition pushes a node, and by how much of an impulse on it: that times
/// the dual (src/motion/skew_supports.hpp).
struct SkewShare {
  int node = 0;
  int condition = -1;
  Vector3d direction{}, dual{};
};

struct ForceSums {
  double duration = 0;  ///< over which the impulses act
  std::vector<ReactionSum> reactions;
  std::vector<ContactSum> contacts;
  std::vector<SectionSum> sections;
  std::vector<int> reaction_of_condition;             ///< by number in the deck; -1: not written
  std::vector<std::array<int, 3>> condition_of_node;  ///< by axis; empty without contact; -1: free
  std::vector<std::array<int, 3>> condition_of_body;  ///< by its own axes
  std::vector<Tensor<double>> axes_of_body;
  std::vector<SkewShare> skew;  ///< translations, by node

  /// \param condition its number in the deck
  void add_reaction(int condition, const Vector3d& impulse);
  /// Of a node with supports along axes of its own.
  void add_skew_support(int node, const Vector3d& impulse);
  /// Components that are not prescribed are 0.
  void add_support_of_body(std::size_t body, const Vector3d& impulse);
  /// Reactions and forces of a step of contact.
  void add(const ImpulseLog& log);
  /// Of the row that was written; the next begins.
  void begin_interval();

  std::vector<double> impulses() const;
  /// As saved; where their number does not fit, the interval begins.
  void set_impulses(std::span<const double> saved);
};

/// \throws BuildError where a section cuts nothing, or names what is not there
ForceSums make_force_sums(const ForceOutput& wanted, const Deck& deck, const Model& model);
/// What contact must tell for them.
ImpulseLog make_impulse_log(const ForceOutput& wanted, const Deck& deck, const Model& model);

/// reaction.NAME_x ..., contact.A.B_x ..., contact.A.B.friction_x ..., section.NAME_x ..., section.NAME_mx
/// ...
void add_columns(const ForceSums& sums, std::vector<std::string>& columns);
/// Means over the interval.
void add_values(const ForceSums& sums, std::vector<double>& row);

/// Before the sweep: forces of loads, which stand on the nodes.
void note_loads(ForceSums& sums, const Nodes& nodes);
/// After the sweep: internal forces through the sections.
void measure_sections(ForceSums& sums, const Nodes& nodes);
/// Adds the impulses of sections. \param step over which the forces of the present time act
void begin_step(ForceSums& sums, double step);
/// Supports of nodes, but those in contact. \param linear their sum
void add_reactions(ForceSums& sums, const PrescribedNodes& given, const Vector3d& linear);
/// Supports of rigid bodies, but those in contact.
void add_reactions(ForceSums& sums, const RigidBodies& bodies);

}  // namespace brio
