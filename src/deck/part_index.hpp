#pragma once
/// Parts by their names.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/breakdown.hpp"
#include "src/deck/deck.hpp"

namespace brio {

/// \throws BuildError where no part has the name.
std::size_t part_index(const std::string& name, const Deck& deck);

/// The part of that name, or the parts whose meshes are of the mesh file of that name; empty where there are
/// none.
std::vector<std::size_t> parts_called(std::string_view name, const Deck& deck);

/// What is thrown. \param place in the deck
BuildError no_part(const std::string& name, const std::string& place = {});

/// The law of a part; null where the deck has none of that name.
const Material* material_of(const Deck& deck, const Part& part);

}  // namespace brio
