#pragma once
/// Parts by their names.

#include <cstddef>
#include <string>

#include "src/deck.hpp"

namespace brio {

/// \throws BuildError where no part has the name.
std::size_t part_index(const std::string& name, const Deck& deck);

/// The law of a part; null where the deck has none of that name.
const Material* material_of(const Deck& deck, const Part& part);

}  // namespace brio
