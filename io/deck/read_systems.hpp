#pragma once
/// Coordinate systems that conditions and loads name.

#include "io/deck/condition_words.hpp"
#include "io/deck/read_fields.hpp"

namespace brio {

/// Words for components along the axes of the `system` that an entry names, or along the global ones.
/// \throws DeckError if no system is called so.
const ComponentWords& component_words_of(const YamlNode& entry, const KnownNames& known);

/// \throws DeckError unless the load can be along the axes of the system of that name.
void check_system(const YamlNode& name, const KnownNames& known, const Load& load);

}  // namespace brio
