#pragma once
/// Overlap recovery: the target relative velocity of a constraint row.

#include <span>
#include <vector>

#include "contact/options.hpp"
#include "contact/pair.hpp"
#include "contact/surface/slave_set.hpp"

namespace brio {

/// Parameters of overlap recovery in a time step.
struct Recovery {
  double share = 0.1;  ///< fraction of a deep overlap removed in a step, ...
  double deep = 0;     ///< ... from this depth on; of smaller ones proportionally less
  double cap = 0;      ///< largest overlap removed in a step
  double sunk = 0;     ///< depth allowed under load
};
/// As the options say. \param gap that surfaces without thickness keep. \param of_step share of the longest
/// time step: overlaps are opened at velocities that do not grow where elements that collapse shorten it.
Recovery recovery_of(const ContactOptions& options, double smallest_edge, double gap, double of_step = 1);

/// Least normal relative velocity over a step: a gap may close, no more; an overlap is opened slowly. Small
/// overlaps are opened more slowly: while iterations are unfinished, opening in proportion to depth
/// integrates the overlap, which excites slow vibrations of bodies at rest. A contact under load is opened
/// more slowly, the more its impulse exceeds that of the recovery: otherwise it would be opened with any
/// force and add energy to compressed bodies. A contact without an impulse so far is not opened, since its
/// load is unknown. \param impulse carried over from the step before. \param mass effective mass along the
/// normal; 0 where nothing can move. \param returned velocity at which its load may open it (`LoadedNodes`).
double target_velocity(const Recovery& recovery, double gap, double impulse, double mass, double returned,
                       double dt);

/// Energy dissipated by contacts under load, which opening them may return.
///
/// Unfinished iterations let loaded contacts close a little in every step, until their gap is gone. They are
/// opened again, with no more work than they have dissipated: impulse and work of a contact are assigned by
/// half to each of its sides, and there to the nodes by their weights, since a solution may assign the load
/// to any of several constraints between the same nodes; all contacts together return no more than all have
/// dissipated. For nodes without load in the last step nothing is stored, and the energy of an impact, which
/// is plastic, is not returned.
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

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(node_, loaded_, of_step_, taken_);
  }

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
