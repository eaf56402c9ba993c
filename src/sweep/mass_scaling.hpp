#pragma once
/// Mass that small elements get so that they do not set the step. It comes with the velocity of its node:
/// what that brings in energy and momentum counts as work and impulse of supports, or, at the start, as
/// there from the start.

#include <span>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/sweep/erosion.hpp"
#include "src/sweep/schedule.hpp"

namespace brio {

struct AddedMass {
  MassScaling settings;
  double elements = 0;        ///< mass of all elements at the start
  std::vector<double> added;  ///< one a part

  double total() const;
  double share() const { return total() / elements; }
};

/// Prepares the blocks. \throws BuildError where a part cannot have its mass scaled.
AddedMass make_mass_scaling(const TimeSection& time, const Deck& deck, std::span<Block> blocks,
                            std::span<const PartInModel> parts);

/// Hands the nodes what the last sweep gave their elements, in the order of the tasks.
/// \param at_start whether the run has not begun
/// \throws Breakdown where more has been added than the deck accepts.
void hand_out(AddedMass& mass, const SweepSchedule& schedule, std::span<const SweepResult> results,
              std::span<const Block> blocks, std::span<const PartInModel> parts, Nodes& nodes,
              EnergyBalance& energy, MomentumBalance& momentum, bool at_start);

}  // namespace brio
