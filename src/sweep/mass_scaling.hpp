#pragma once
/// Mass scaling: mass added to small elements, so that they do not set the stable time step. Added mass has
/// the velocity of its node: its energy and momentum count as work and impulse of supports, or, at the start,
/// as initial ones.

#include <span>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/domains/schedule.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/sweep/erosion.hpp"

namespace brio {

struct AddedMass {
  MassScaling settings;
  double elements = 0;        ///< initial mass of all elements
  std::vector<double> added;  ///< one a part

  double total() const;
  double share() const { return total() / elements; }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(added);
  }
};

/// Prepares the blocks. \throws BuildError where a part cannot have its mass scaled.
AddedMass make_mass_scaling(const TimeSection& time, const Deck& deck, std::span<Block> blocks,
                            std::span<const PartInModel> parts);

/// Adds to the nodes the mass that the last sweep added to their elements, in the order of the tasks.
/// \param at_start whether the run has not begun
/// \return the kinetic energy and momentum of the mass: from outside, or there from the start
/// \throws Breakdown where more has been added than the deck accepts.
Contribution hand_out(AddedMass& mass, const SweepSchedule& schedule, std::span<const SweepResult> results,
                      std::span<const Block> blocks, std::span<const PartInModel> parts, Nodes& nodes,
                      bool at_start);

}  // namespace brio
