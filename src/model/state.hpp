#pragma once
/// The state of a run: all that changes from step to step and that later steps depend on. The rest of a
/// Model follows from the input deck.
///
/// A run that is saved between two steps and restored into a model built anew from the same deck goes on
/// with the same bits as one that was not interrupted, for any number of threads of either.

#include <cstdint>
#include <istream>
#include <ostream>

#include "src/base/state_archive.hpp"
#include "src/model/model.hpp"

namespace brio {

/// Write the state. \pre velocities are updated, positions are not: between the two halves of a step.
void save_state(const Model& model, std::ostream& out);

/// Read a state into a model built from the same deck by the same program. \param size bytes of the state
/// \throws StateError where it is not one of this model, or ends early; the model is then of no use.
void restore_state(Model& model, std::istream& in, std::uint64_t size);

}  // namespace brio
