#pragma once

#include "src/deck/deck.hpp"
#include "src/model/model.hpp"

namespace brio {

/// What the deck wants in the history beside what is always there: probes, motion of rigid bodies, forces.
/// \throws BuildError
void prepare_history(const Deck& deck, Model& model);

}  // namespace brio
