#pragma once
/// The same deck with fewer elements, for a coarse run.

#include "src/deck/deck.hpp"

namespace brio {

/// \param factor by which elements become longer, along every direction, as near as whole numbers of elements
/// allow; one element stays one.
Deck coarser(const Deck& deck, double factor);

}  // namespace brio
