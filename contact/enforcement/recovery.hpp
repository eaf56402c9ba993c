#pragma once
/// What relative velocity a row asks for: how what is missing of a gap is recovered.

#include <span>
#include <vector>

#include "contact/options.hpp"
#include "contact/pair.hpp"
#include "contact/surface/slave_set.hpp"

namespace brio {

/// How overlap is recovered in a step.
struct Recovery {
  double share = 0.1;  ///< of a deep overlap that a step may remove, ...
  double deep = 0;     ///< ... and from which depth on; of shallower ones the less the shallower they are
  double cap = 0;      ///< most that a step removes
  double sunk = 0;     ///< depth that what is under load may keep
};
/// As the options say. \param gap that surfaces without thickness keep. \param deep_share of the smallest
/// edge: from there on an overlap is deep.
Recovery recovery_of(const ContactOptions& options, double smallest_edge, double gap,
                     double deep_share = 0.1);

/// Least normal relative velocity over a step: a gap may close, no more; an overlap is opened a little.
/// Shallow overlaps are opened the slower the shallower they are: where impulses lag behind what iterations
/// have yet to find, opening in proportion to depth integrates the overlap, which feeds slow vibrations of
/// what rests. A contact under load is opened the slower the more it carries beyond what a node gains by its
/// recovery: it would otherwise be opened with any force, and so give energy to what is pressed together; one
/// that has carried nothing is not opened, since what it will carry is not known.
/// \param impulse carried over from the step before. \param mass effective mass along the normal; 0
/// where nothing can move. \param returned velocity at which its load may open it (`LoadedNodes`).
double target_velocity(const Recovery& recovery, double gap, double impulse, double mass, double returned,
                       double dt);

/// Work that contacts under load have taken of the motion of nodes, and that opening them may return.
///
/// What iterations leave undone lets loaded contacts close by a little in every step, until nothing is left
/// of their gap. They are opened again, by no more work than they have taken: impulse and work of a contact
/// belong by half to each of its sides, and there to the nodes by their weights, since a solution may give
/// the load to any of several constraints between the same nodes; and all contacts together return no more
/// than all have taken. Nothing is known of nodes that carried nothing in the last step, and an impact, which
/// takes what a plastic one does, returns nothing.
class LoadedNodes {
 public:
  /// Room for so many slave nodes; what is known of the first stays.
  void resize(std::size_t slaves);
  /// Of a contact that carries, or is overlapped. \param work of its normal impulse on motion in the step.
  void add(const Contact& contact, double work);
  /// After the contacts of a step.
  void end_step();
  /// Velocities at which loads may open contacts, each beyond `sunk`. \param contacts with the impulses of
  /// the step before. \returns valid until the next call
  std::span<const double> opening_velocities(std::span<const Contact> contacts, const Recovery& recovery,
                                             double dt);
  /// Of all contacts; less what was not returned before they parted.
  double taken() const { return taken_; }

 private:
  struct Node {
    double taken = 0;    ///< work, since the node is loaded
    double impulse = 0;  ///< of the last step
    double work_of_step = 0, impulse_of_step = 0;
  };
  /// Returns all that was taken by a step under the load of the last one.
  double velocity_returning_all(const Contact& contact) const;

  std::vector<Node> node_;
  SlaveSet loaded_, of_step_;
  std::vector<double> velocity_;
  double taken_ = 0;
};

}  // namespace brio
